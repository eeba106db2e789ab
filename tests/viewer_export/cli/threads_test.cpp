// The same seed gives the same bytes on any number of threads.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/solved_room.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

std::string export_of(const TempFolder& folder, const std::string& solution, const std::string& values,
                      const std::string& threads) {
  const std::string file = (folder / ("threads-" + threads + ".csv")).string();
  std::vector<std::string> arguments{
      "export", (folder / solution).string(), "-o", file, "--values", values, "--threads", threads};
  if (values == "gather") arguments.insert(arguments.end(), {"--samples", "16"});
  const ProgramRun run = run_reemit(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return read_bytes(file);
}

TEST(Threads, DoNotChangeTheSolution) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  for (const std::string method : {"shooting", "walk"}) {
    for (const std::string sampling : {"sobol", "random"}) {
      solve_small_room(folder, "one.h5", {"--method", method, "--sampling", sampling, "--threads", "1"});
      solve_small_room(folder, "two.h5", {"--method", method, "--sampling", sampling, "--threads", "2"});
      const std::string one = export_of(folder, "one.h5", "zones", "1");
      EXPECT_GT(one.size(), 1000U);
      EXPECT_TRUE(one == export_of(folder, "two.h5", "zones", "1")) << method << ", " << sampling;
      EXPECT_EQ(run_reemit({"audit", (folder / "one.h5").string(), "--json"}).out,
                run_reemit({"audit", (folder / "two.h5").string(), "--json"}).out);
    }
  }
}

TEST(Threads, DoNotChangeTheGather) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  solve_small_room(folder, "room.h5");
  EXPECT_TRUE(export_of(folder, "room.h5", "gather", "1") == export_of(folder, "room.h5", "gather", "2"));
}

TEST(Threads, DoNotChangeWhatTheAuditOfDirectLightFinds) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  solve_small_room(folder, "room.h5");
  const auto found = [&](const std::string& threads) {
    const ProgramRun run =
        run_reemit({"audit", (folder / "room.h5").string(), "--direct", "--json", "--threads", threads});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
  };
  EXPECT_EQ(found("1"), found("2"));
}

TEST(Threads, AnotherSeedChangesTheSolution) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  solve_small_room(folder, "one.h5", {"--seed", "1"});
  solve_small_room(folder, "two.h5", {"--seed", "2"});
  EXPECT_FALSE(export_of(folder, "one.h5", "zones", "1") == export_of(folder, "two.h5", "zones", "1"));
}

}  // namespace
}  // namespace reemit::test
