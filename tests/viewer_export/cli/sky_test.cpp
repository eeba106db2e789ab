// Skies from the command line to stills, lux and daylight factors.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/csv_file.h"
#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using Json = nlohmann::json;

/// The small OBJ room with a black lamp and without its ceiling: a court.
void write_court(const TempFolder& folder) {
  const std::string room = small_obj_room();
  folder.write("room.obj", room.substr(0, room.find("o ceiling")));
  folder.write("room.mtl", small_obj_materials());
}

ProgramRun solve(const TempFolder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"solve",     (folder / "room.obj").string(),
                                     "-o",        (folder / "room.h5").string(),
                                     "--zones",   "300",
                                     "--packets", "200000"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_reemit(arguments);
}

TEST(SkyOnTheCommandLine, is_kept_by_the_solution_and_reported_in_lux) {
  const TempFolder folder;
  write_court(folder);
  const ProgramRun solved = solve(folder, {"--sky", "overcast:10000lx,up=y"});
  ASSERT_EQ(solved.exit_code, 0) << solved.err;
  EXPECT_NE(solved.err.find("CIE overcast"), std::string::npos) << solved.err;
  const ProgramRun info = run_reemit({"info", (folder / "room.h5").string(), "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const Json summary = Json::parse(info.out);
  EXPECT_NEAR(summary.at("outside_sky_illuminance_lx").get<double>(), 10000, 1e-6);
  const Json& floor = summary.at("surfaces").at(0);
  const double lux = floor.at("illuminance_lx");
  EXPECT_GT(lux, 100);
  EXPECT_LT(lux, 10000);
  EXPECT_NEAR(floor.at("daylight_factor_percent").get<double>(), lux / 100, 1e-9 * lux);

  const ProgramRun exported = run_reemit(
      {"export", (folder / "room.h5").string(), "-o", (folder / "lux.csv").string(), "--units", "lx"});
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  const std::vector<CsvRow> rows = csv_rows(folder / "lux.csv");
  ASSERT_FALSE(rows.empty());
  for (const CsvRow& row : rows)
    EXPECT_NEAR(std::stod(row.at("daylight_factor_percent")), std::stod(row.at("illuminance")) / 100, 1e-3);

  const ProgramRun rendered =
      run_reemit({"render", (folder / "room.h5").string(), "--eye", "0.5,0.2,0.5", "--look-at", "0.5,1,0.51",
                  "--size", "16x12", "--spp", "4", "-o", (folder / "up.exr").string()});
  EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
  const ProgramRun audit = run_reemit({"audit", (folder / "room.h5").string()});
  EXPECT_EQ(audit.exit_code, 0) << audit.out << audit.err;
}

TEST(SkyOnTheCommandLine, goes_on_under_the_same_sky) {
  const TempFolder folder;
  write_court(folder);
  ASSERT_EQ(solve(folder, {"--sky", "uniform:5000lx"}).exit_code, 0);
  const std::string solution = (folder / "room.h5").string();
  EXPECT_EQ(run_reemit({"solve", "--resume", solution, "--packets", "400000"}).exit_code, 0);
  const ProgramRun other = run_reemit({"solve", "--resume", solution, "--sky", "uniform:6000lx"});
  EXPECT_EQ(other.exit_code, 2) << "a run has one sky from its first batch to its last";
}

TEST(SkyOnTheCommandLine, mistakes_leave_nothing_behind) {
  const TempFolder folder;
  write_court(folder);
  for (const char* sky :
       {"overcast:0lx", "overcast", "clear:10000lx", "fog:3lx", "image:nowhere.hdr", "overcast:10000"}) {
    const ProgramRun run = solve(folder, {"--sky", sky});
    EXPECT_EQ(run.exit_code, 2) << sky;
    EXPECT_NE(run.err.find(std::string(sky).starts_with("image") ? "nowhere.hdr" : "--sky"),
              std::string::npos)
        << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "room.h5")) << sky;
  }
  const ProgramRun night = solve(folder, {"--sun", "latitude=48,longitude=16,time=2024-12-21T22:00Z,lx=1"});
  EXPECT_EQ(night.exit_code, 2);
  EXPECT_NE(night.err.find("below the horizon"), std::string::npos) << night.err;
}

TEST(SkyOnTheCommandLine, the_matrix_method_has_none) {
  const TempFolder folder;
  write_court(folder);
  const ProgramRun run =
      run_reemit({"solve", (folder / "room.obj").string(), "-o", (folder / "room.h5").string(), "--method",
                  "matrix", "--zones", "100", "--sky", "overcast:10000lx"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("the matrix method has none"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "room.h5"));
}

}  // namespace
}  // namespace reemit::test
