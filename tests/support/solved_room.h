#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {

/// Solves room.json of the folder into `name` with few packets and large zones.
inline std::filesystem::path solve_small_room(const TempFolder& folder, const std::string& name,
                                              const std::vector<std::string>& more_arguments = {}) {
  std::vector<std::string> arguments{"solve",       (folder / "room.json").string(),
                                     "-o",          (folder / name).string(),
                                     "--zone-area", "0.05",
                                     "--packets",   "20000"};
  arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
  const ProgramRun run = run_reemit(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return folder / name;
}

}  // namespace reemit::test
