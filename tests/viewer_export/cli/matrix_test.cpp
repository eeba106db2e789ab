// The matrix method and the form factors on the command line.
#include <cmath>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/csv_file.h"
#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

ProgramRun solve_matrix(const TempFolder& folder, const std::vector<std::string>& more = {}) {
  folder.write("room.json", small_json_room());
  std::vector<std::string> arguments{"solve",       (folder / "room.json").string(),
                                     "-o",          (folder / "room.h5").string(),
                                     "--method",    "matrix",
                                     "--zone-area", "0.05"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_reemit(arguments);
}

TEST(Matrix, SolutionServesAllOtherCommands) {
  const TempFolder folder;
  const ProgramRun run = solve_matrix(folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("linear system solved"));
  EXPECT_THAT(run.out, HasSubstr("row sums"));
  const std::string file = (folder / "room.h5").string();
  EXPECT_EQ(run_reemit({"audit", file}).exit_code, 0);
  EXPECT_THAT(run_reemit({"info", file}).out, HasSubstr("matrix"));
  EXPECT_EQ(run_reemit({"export", file, "-o", (folder / "room.ply").string(), "--samples", "16"}).exit_code,
            0);
  EXPECT_EQ(
      run_reemit({"render", file, "--camera", "front", "-o", (folder / "room.exr").string(), "--size", "8x8"})
          .exit_code,
      0);
}

TEST(Matrix, JsonReportsClosureAndPairs) {
  const TempFolder folder;
  const ProgramRun run = solve_matrix(folder, {"--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json report = Json::parse(run.out);
  EXPECT_EQ(report["method"], "matrix");
  EXPECT_EQ(report["balanced"], true);
  const Json& factors = report["form_factors"];
  EXPECT_EQ(factors["zones"], report["zones"]);
  EXPECT_EQ(factors["facing_pairs"].get<int>(),
            factors["open_pairs"].get<int>() + factors["walled_pairs"].get<int>() +
                factors["clear_pairs"].get<int>() + factors["hidden_pairs"].get<int>() +
                factors["sampled_pairs"].get<int>());
  EXPECT_GT(factors["sampled_pairs"], 0);
}

TEST(Matrix, StoppingRulesAreRefused) {
  for (const auto& [option, value] : {std::pair{"--error", "1%"}, {"--time", "5s"}, {"--packets", "1000"}}) {
    const TempFolder folder;
    const ProgramRun run = solve_matrix(folder, {option, value});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(option));
    EXPECT_THAT(folder.listing(), ElementsAre("room.json"));
  }
}

TEST(Matrix, InterruptLeavesNoSolution) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  RunningProgram program({"solve", (folder / "room.json").string(), "-o", (folder / "room.h5").string(),
                          "--method", "matrix", "--zone-area", "0.0016", "--verbose"});
  for (int i = 0; i < 600 && program.errors_so_far().find("solving") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  program.send(SIGINT);
  const ProgramRun run = program.wait();
  EXPECT_EQ(run.exit_code, 130) << run.err;
  EXPECT_THAT(run.err, HasSubstr("nothing was written"));
  EXPECT_THAT(folder.listing(), ElementsAre("room.json"));
}

TEST(Matrix, FormFactorsAreExportedFromAnySolution) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string solution = (folder / "room.h5").string();
  ASSERT_EQ(run_reemit({"solve", (folder / "room.json").string(), "-o", solution, "--packets", "2000",
                        "--zone-area", "0.1"})
                .exit_code,
            0);
  const ProgramRun csv =
      run_reemit({"export", "--form-factors", solution, "-o", (folder / "factors.csv").string(), "--json"});
  ASSERT_EQ(csv.exit_code, 0) << csv.err;
  const Json report = Json::parse(csv.out);
  std::map<std::string, double> sums;
  std::map<std::pair<std::string, std::string>, double> factor;
  for (const CsvRow& row : csv_rows(folder / "factors.csv")) {
    sums[row.at("zone_from")] += std::stod(row.at("factor"));
    factor[{row.at("zone_from"), row.at("zone_to")}] = std::stod(row.at("factor"));
    EXPECT_GE(std::stod(row.at("standard_error")), 0);
  }
  EXPECT_GT(factor.size(), 100U);
  for (const auto& [pair, value] : factor) EXPECT_TRUE(factor.contains({pair.second, pair.first}));
  double highest = 0;
  for (const auto& [zone, sum] : sums) highest = std::max(highest, sum);
  EXPECT_NEAR(highest, report["row_sums"]["highest"].get<double>(), 1e-12);
  EXPECT_NEAR(highest, 1, 0.02);

  const ProgramRun hdf5 =
      run_reemit({"export", "--form-factors", solution, "-o", (folder / "factors.h5").string()});
  EXPECT_EQ(hdf5.exit_code, 0) << hdf5.err;
  EXPECT_EQ(read_bytes(folder / "factors.h5").substr(1, 3), "HDF");
}

TEST(Matrix, FormFactorsDoNotReplaceASolution) {
  const TempFolder folder;
  ASSERT_EQ(solve_matrix(folder).exit_code, 0);
  const std::string solution = (folder / "room.h5").string();
  std::filesystem::copy_file(folder / "room.h5", folder / "other.h5");
  const std::string before = read_bytes(folder / "other.h5");
  const ProgramRun run =
      run_reemit({"export", "--form-factors", solution, "-o", (folder / "other.h5").string()});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("is a solution"));
  EXPECT_EQ(read_bytes(folder / "other.h5"), before);
  // Form factors themselves may be replaced.
  for (int time = 0; time < 2; ++time)
    EXPECT_EQ(
        run_reemit({"export", "--form-factors", solution, "-o", (folder / "factors.h5").string()}).exit_code,
        0);
}

// Zones that fit the light are cut unevenly, and sides that no light reaches share one.
TEST(Matrix, FormFactorsAreThoseOfTheZonesOfTheSolution) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string solution = (folder / "room.h5").string();
  const ProgramRun solve = run_reemit(
      {"solve", (folder / "room.json").string(), "-o", solution, "--packets", "2000", "--zones", "200"});
  ASSERT_EQ(solve.exit_code, 0) << solve.err;
  const Json info = Json::parse(run_reemit({"info", solution, "--json"}).out);
  const ProgramRun run =
      run_reemit({"export", "--form-factors", solution, "-o", (folder / "factors.csv").string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json report = Json::parse(run.out);
  EXPECT_EQ(report["zones"], info["zones"]);
}

TEST(Matrix, UnknownFormFactorFormatsAndVertexOptionsAreRefused) {
  const TempFolder folder;
  ASSERT_EQ(solve_matrix(folder).exit_code, 0);
  const std::string solution = (folder / "room.h5").string();
  const ProgramRun ply =
      run_reemit({"export", "--form-factors", solution, "-o", (folder / "factors.ply").string()});
  EXPECT_EQ(ply.exit_code, 2);
  EXPECT_THAT(ply.err, HasSubstr(".csv, .h5"));
  const ProgramRun samples = run_reemit(
      {"export", "--form-factors", solution, "-o", (folder / "factors.csv").string(), "--samples", "4"});
  EXPECT_EQ(samples.exit_code, 2);
  EXPECT_THAT(folder.listing(), ElementsAre("room.h5", "room.json"));
}

}  // namespace
}  // namespace reemit::test
