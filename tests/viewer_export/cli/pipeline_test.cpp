// The whole way of the data through the built program: solve, render, export, audit, info.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/csv_file.h"
#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/solved_room.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Pipeline : public ::testing::Test {
 protected:
  Pipeline() { folder_.write("room.json", small_json_room()); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Runs and expects success; returns standard output.
  static std::string output_of(const std::vector<std::string>& arguments) {
    const ProgramRun run = run_reemit(arguments);
    EXPECT_EQ(run.exit_code, 0) << arguments.front() << ": " << run.err;
    return run.out;
  }

  TempFolder folder_;
};

TEST_F(Pipeline, SolveEndsWithOneLine) {
  const std::string out = output_of(
      {"solve", path("room.json"), "-o", path("room.h5"), "--zone-area", "0.05", "--packets", "20000"});
  EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 1) << out;
  for (const char* word : {"stopped", "packets", "rays", " s, ", "noise", "zones"})
    EXPECT_THAT(out, HasSubstr(word));
}

TEST_F(Pipeline, RoomsThatAreNotSolvedArePathTraced) {
  const std::string solution = path("room.h5");
  output_of({"solve", path("room.json"), "-o", solution, "--zone-area", "0.05", "--packets", "1000"});
  const std::vector<std::string> how{"--integrator", "path", "--spp", "8", "--seed", "3"};
  std::vector<std::string> of_room{"render", path("room.json"), "-o", path("of_room.hdr")};
  std::vector<std::string> of_solution{"render", solution, "-o", path("of_solution.hdr")};
  of_room.insert(of_room.end(), how.begin(), how.end());
  of_solution.insert(of_solution.end(), how.begin(), how.end());
  output_of(of_room);
  output_of(of_solution);
  EXPECT_EQ(read_bytes(path("of_room.hdr")), read_bytes(path("of_solution.hdr")))
      << "no zone has a say in path tracing";
  const ProgramRun gathered = run_reemit({"render", path("room.json"), "-o", path("x.png")});
  EXPECT_EQ(gathered.exit_code, 2);
  EXPECT_THAT(gathered.err, HasSubstr("only --integrator path makes stills of one that is not solved"));
  EXPECT_EQ(
      run_reemit({"render", path("room.json"), "-o", path("room.json"), "--integrator", "path"}).exit_code,
      2);
}

TEST_F(Pipeline, NamesThatAreNotUtf8GiveValidJson) {
  folder_.write("room.mtl", small_obj_materials());
  folder_.write("old.obj", replaced(small_obj_room(), "o walls",
                                    "o b\x8e"
                                    "c"));
  const std::string solution = path("old.h5");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"info", path("old.obj")},
        {"solve", path("old.obj"), "-o", solution, "--packets", "1000"},
        {"audit", solution}}) {
    std::vector<std::string> arguments = command;
    arguments.emplace_back("--json");
    EXPECT_TRUE(json::accept(output_of(arguments))) << command.front();
  }
}

TEST_F(Pipeline, SolveAsJsonIsOneDocument) {
  const json report = json::parse(output_of({"solve", path("room.json"), "-o", path("room.h5"), "--zone-area",
                                             "0.05", "--packets", "20000", "--seed", "5", "--json"}));
  EXPECT_GE(report["packets"].get<std::uint64_t>(), 20000U);
  EXPECT_GT(report["rays"].get<std::uint64_t>(), 20000U);
  EXPECT_GT(report["seconds"].get<double>(), 0);
  EXPECT_GT(report["error"].get<double>(), 0);
  EXPECT_GT(report["zones"].get<int>(), 100);
  EXPECT_EQ(report["seed"], 5);
  EXPECT_TRUE(report["balanced"].get<bool>());
  EXPECT_THAT(report["stopped"].get<std::string>(), HasSubstr("packet"));
  EXPECT_GT(report["peak_memory_bytes"].get<double>(), 1e6);
}

TEST_F(Pipeline, ErrorTargetIsReachedAndStated) {
  const json report = json::parse(output_of(
      {"solve", path("room.json"), "-o", path("room.h5"), "--zone-area", "0.1", "--error", "5%", "--json"}));
  EXPECT_LE(report["error"].get<double>(), 0.05);
  EXPECT_THAT(report["stopped"].get<std::string>(), HasSubstr("error"));
}

TEST_F(Pipeline, WithoutAStoppingRuleItSaysWhichOneItTakes) {
  const ProgramRun run =
      run_reemit({"solve", path("room.json"), "-o", path("room.h5"), "--zone-area", "0.2"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("--error 2%"));
}

TEST_F(Pipeline, DirectLightOfPacketsAndShadowRaysAgrees) {
  solve_small_room(folder_, "room.h5");
  const json direct = json::parse(output_of({"audit", path("room.h5"), "--direct", "--json"}))["direct"];
  EXPECT_TRUE(direct["agrees"].get<bool>());
  EXPECT_GT(direct["zones_compared"].get<int>(), 100);
  EXPECT_EQ(direct["zones_different"], 0);
  EXPECT_EQ(direct["surfaces"].size(), 7U);
  EXPECT_THAT(output_of({"audit", path("room.h5"), "--direct"}), HasSubstr("None of"));
}

TEST_F(Pipeline, RendersWithAllIntegrators) {
  solve_small_room(folder_, "room.h5");
  for (const char* integrator : {"gather", "path", "zones"}) {
    for (const char* extension : {".exr", ".hdr", ".png"}) {
      const std::string file = path(std::string(integrator) + extension);
      output_of({"render", path("room.h5"), "--camera", "front", "--integrator", integrator, "--spp", "2",
                 "--size", "10x8", "-o", file});
      EXPECT_GT(std::filesystem::file_size(file), 100U) << file;
    }
  }
}

TEST_F(Pipeline, SmoothsGatheredPicturesUnlessTold) {
  solve_small_room(folder_, "room.h5");
  const auto is_smoothed = [&](std::vector<std::string> options) {
    std::vector<std::string> command{"render", path("room.h5"),  "--camera", "front",
                                     "-o",     path("room.exr"), "--json"};
    command.insert(command.end(), options.begin(), options.end());
    return json::parse(output_of(command))["pictures"][0]["smoothed"].get<bool>();
  };
  EXPECT_TRUE(is_smoothed({}));
  EXPECT_FALSE(is_smoothed({"--smooth", "off"}));
  EXPECT_FALSE(is_smoothed({"--error", "20%"}));
  EXPECT_TRUE(is_smoothed({"--error", "20%", "--smooth", "on"}));
  EXPECT_FALSE(is_smoothed({"--integrator", "path"}));
  EXPECT_TRUE(is_smoothed({"--integrator", "path", "--smooth", "on"}));
  EXPECT_FALSE(is_smoothed({"--integrator", "zones"}));
}

TEST_F(Pipeline, SmoothingOfZonesIsRefused) {
  solve_small_room(folder_, "room.h5");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"render", path("room.h5"), "-o", path("room.png"), "--integrator", "zones"},
        {"export", path("room.h5"), "-o", path("room.ply"), "--values", "zones"}}) {
    std::vector<std::string> smoothed = command;
    smoothed.insert(smoothed.end(), {"--smooth", "on"});
    const ProgramRun run = run_reemit(smoothed);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("--smooth on"));
    EXPECT_FALSE(std::filesystem::exists(command[3]));
    EXPECT_EQ(run_reemit(command).exit_code, 0);
  }
}

TEST_F(Pipeline, RendersAllCamerasIntoAFolder) {
  solve_small_room(folder_, "room.h5");
  const json report = json::parse(output_of({"render", path("room.h5"), "--camera", "all", "--spp", "1",
                                             "--format", "png", "-o", path("pictures/"), "--json"}));
  ASSERT_EQ(report["pictures"].size(), 2U);
  EXPECT_EQ(report["pictures"][0]["camera"], "front");
  EXPECT_EQ(report["pictures"][0]["width_px"], 12);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "pictures/front.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "pictures/side.png"));
}

TEST_F(Pipeline, AllCamerasDoNotFitIntoOneFile) {
  solve_small_room(folder_, "room.h5");
  const ProgramRun run = run_reemit({"render", path("room.h5"), "--camera", "all", "-o", path("all.png")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("folder"));
}

TEST_F(Pipeline, UnknownCameraListsTheKnownOnes) {
  solve_small_room(folder_, "room.h5");
  const ProgramRun run = run_reemit({"render", path("room.h5"), "--camera", "back", "-o", path("back.png")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("front, side"));
}

TEST_F(Pipeline, RendersFromAFreeEyeAndWithoutCameras) {
  solve_small_room(folder_, "room.h5");
  output_of({"render", path("room.h5"), "--eye", "0.9,0.5,0.9", "--look-at", "0,0.2,0", "--fov", "60",
             "--size", "9x7", "--spp", "1", "-o", path("eye.png")});
  folder_.write("room.mgf", small_mgf_room());
  output_of({"solve", path("room.mgf"), "-o", path("mgf.h5"), "--zone-area", "0.05", "--packets", "5000"});
  const json report = json::parse(output_of({"render", path("mgf.h5"), "--size", "8x6", "--spp", "1",
                                             "--format", "exr", "-o", path("auto/"), "--json"}));
  ASSERT_GE(report["pictures"].size(), 2U);
  EXPECT_EQ(report["pictures"][0]["camera"], "auto-1");
}

TEST_F(Pipeline, ExportsAllFormats) {
  solve_small_room(folder_, "room.h5");
  for (const char* extension : {".ply", ".glb", ".csv"}) {
    output_of({"export", path("room.h5"), "-o", path(std::string("room") + extension), "--samples", "8"});
    EXPECT_GT(std::filesystem::file_size(path(std::string("room") + extension)), 1000U) << extension;
  }
}

TEST_F(Pipeline, SeveralExportsHoldTheValuesOfOneGathering) {
  solve_small_room(folder_, "room.h5");
  const json report =
      json::parse(output_of({"export", path("room.h5"), "-o", path("a.glb"), "-o", path("a.csv"), "--output",
                             path("a.ply"), "--samples", "8", "--json"}));
  EXPECT_EQ(report["files"], json::array({path("a.glb"), path("a.csv"), path("a.ply")}));
  output_of({"export", path("room.h5"), "-o", path("b.csv"), "--samples", "8"});
  EXPECT_EQ(read_bytes(folder_ / "a.csv"), read_bytes(folder_ / "b.csv"));
  for (const char* file : {"a.glb", "a.ply"})
    EXPECT_GT(std::filesystem::file_size(path(file)), 1000U) << file;
}

TEST_F(Pipeline, OneExportTwiceIsRefused) {
  solve_small_room(folder_, "room.h5");
  const ProgramRun run =
      run_reemit({"export", path("room.h5"), "-o", path("a.csv"), "-o", path("./a.csv"), "--samples", "8"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("given twice"));
  EXPECT_FALSE(std::filesystem::exists(path("a.csv")));
  const ProgramRun factors =
      run_reemit({"export", path("room.h5"), "-o", path("a.csv"), "-o", path("a.h5"), "--form-factors"});
  EXPECT_EQ(factors.exit_code, 2);
  EXPECT_THAT(factors.err, HasSubstr("--form-factors"));
}

TEST_F(Pipeline, ExportsSayWhatColoursCannotShow) {
  folder_.write(
      "room.json",
      replaced(replaced(small_json_room(), R"("white":)", R"("glass": {"mirror": 0.9}, "white":)"),
               R"({"name": "lamp")",
               R"({"name": "pane", "material": "glass", "quad": {"corner": [0.1, 0.1, 0.9], "u": [0.2, 0, 0],
                             "v": [0, 0.2, 0]}}, {"name": "lamp")"));
  solve_small_room(folder_, "room.h5");
  const ProgramRun colours = run_reemit({"export", path("room.h5"), "-o", path("a.glb"), "--samples", "8"});
  EXPECT_EQ(colours.exit_code, 0) << colours.err;
  EXPECT_THAT(colours.err, HasSubstr("1 surface(s) are mirrors"));
  const ProgramRun table = run_reemit({"export", path("room.h5"), "-o", path("a.csv"), "--samples", "8"});
  EXPECT_THAT(table.err, ::testing::Not(HasSubstr("mirrors")));
}

TEST_F(Pipeline, MeasuresGridsAndFilesOfPoints) {
  solve_small_room(folder_, "room.h5");
  folder_.write("sensors.txt", "0.5 0.5 0.5 0 0 1\n0.5 0.5 0.25 0 0 -1\n");
  const std::vector<std::string> points{"--grid", "0.1,0.1,0.5", "0.8,0,0",          "0,0.8,0",
                                        "4x3",    "--points",    path("sensors.txt")};
  std::vector<std::string> command{"measure", path("room.h5"), "--samples", "64", "--light-samples", "16"};
  command.insert(command.end(), points.begin(), points.end());
  EXPECT_THAT(output_of(command), HasSubstr("sensors"));
  command.insert(command.end(), {"-o", path("points.csv"), "--json"});
  const json report = json::parse(output_of(command));
  const std::vector<CsvRow> rows = csv_rows(folder_ / "points.csv");
  ASSERT_EQ(rows.size(), 14U);
  double mean = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(rows[i].at("set"), "grid");
    mean += std::stod(rows[i].at("illuminance")) / 12;
    const double photometric = 179 * (0.2126 * std::stod(rows[i].at("irradiance_r")) +
                                      0.7152 * std::stod(rows[i].at("irradiance_g")) +
                                      0.0722 * std::stod(rows[i].at("irradiance_b")));
    EXPECT_NEAR(std::stod(rows[i].at("illuminance")), photometric, 1e-4 * photometric);
  }
  EXPECT_NEAR(report["sets"][0]["mean_illuminance"], mean, 1e-4 * mean);
  EXPECT_EQ(rows[12].at("set"), "sensors");
  EXPECT_EQ(report["sets"][1]["points"], 2);
}

TEST_F(Pipeline, MeasuringRefusesWhatItCannotDo) {
  solve_small_room(folder_, "room.h5");
  const auto refusal = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"measure", path("room.h5")});
    const ProgramRun run = run_reemit(options);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    return run.err;
  };
  EXPECT_THAT(refusal({}), HasSubstr("no points"));
  EXPECT_THAT(refusal({"--grid", "0,0,0", "1,0,0", "0,1,0", "4"}), HasSubstr("--grid"));
  EXPECT_THAT(refusal({"--grid", "0,0,0", "1,0,0", "2,0,0", "4x4"}), HasSubstr("span no area"));
  EXPECT_THAT(refusal({"--grid", "0,0,0", "1,0,0", "0,1,0"}), HasSubstr("--grid"));
  EXPECT_THAT(refusal({"--points", path("nothing.txt")}), HasSubstr("nothing.txt"));
  EXPECT_THAT(refusal({"--grid", "0,0,0", "1,0,0", "0,1,0", "4x4", "-o", path("points.ply")}),
              HasSubstr(".csv"));
}

TEST_F(Pipeline, AnEyeOutsideOfTheRoomIsToldButRendered) {
  solve_small_room(folder_, "room.h5");
  const ProgramRun run = run_reemit({"render", path("room.h5"), "--eye", "0.5,0.5,5", "--look-at",
                                     "0.5,0.5,0", "--size", "9x7", "--spp", "1", "-o", path("eye.png")});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("warning: camera 'view': the eye is outside of the room"));
  EXPECT_TRUE(std::filesystem::exists(path("eye.png")));
}

TEST_F(Pipeline, PhotometricUnitsAreTheBandsTimesTheirEfficacy) {
  solve_small_room(folder_, "room.h5");
  output_of({"export", path("room.h5"), "-o", path("watts.csv"), "--values", "zones"});
  output_of({"export", path("room.h5"), "-o", path("lux.csv"), "--values", "zones", "--units", "lx"});
  const std::vector<CsvRow> watts = csv_rows(folder_ / "watts.csv");
  const std::vector<CsvRow> lux = csv_rows(folder_ / "lux.csv");
  ASSERT_EQ(watts.size(), lux.size());
  const auto photometric = [](const CsvRow& row, const std::string& name) {
    return 179 * (0.2126 * std::stod(row.at(name + "_r")) + 0.7152 * std::stod(row.at(name + "_g")) +
                  0.0722 * std::stod(row.at(name + "_b")));
  };
  for (std::size_t i = 0; i < lux.size(); ++i) {
    const double expected = photometric(watts[i], "irradiance");
    EXPECT_NEAR(std::stod(lux[i].at("illuminance")), expected, 1e-5 * expected);
    EXPECT_NEAR(std::stod(lux[i].at("luminance")), photometric(watts[i], "radiance"), 1e-4 * expected);
  }
  const ProgramRun refused = run_reemit({"export", path("room.h5"), "-o", path("x.ply"), "--units", "lx"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("for .csv"));
}

TEST_F(Pipeline, TheLogOfAKilledRunCanBeRead) {
  RunningProgram program(
      {"solve", path("room.json"), "-o", path("room.h5"), "--time", "60", "--log", path("run.jsonl")});
  const auto lines = [&] {
    std::istringstream text(read_bytes(folder_ / "run.jsonl"));
    std::vector<std::string> all;
    for (std::string line; std::getline(text, line);) all.push_back(line);
    return all;
  };
  for (int i = 0; i < 600 && lines().size() < 4; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().exit_code, -SIGKILL);
  const std::vector<std::string> all = lines();
  ASSERT_GE(all.size(), 4U);
  EXPECT_EQ(json::parse(all[0])["event"], "start");
  double seconds = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const json batch = json::parse(all[i]);
    EXPECT_EQ(batch["event"], "batch");
    EXPECT_EQ(batch["batches"].get<std::size_t>(), i);
    EXPECT_GT(batch["seconds"].get<double>(), seconds);
    EXPECT_EQ(batch["error"].is_null(), i < 2) << "known from two batches on";
    seconds = batch["seconds"].get<double>();
  }

  output_of(
      {"solve", path("room.json"), "-o", path("room.h5"), "--packets", "20000", "--log", path("run.jsonl")});
  EXPECT_EQ(json::parse(lines().back())["event"], "end") << "an old log is replaced";
  const ProgramRun refused = run_reemit(
      {"solve", path("room.json"), "-o", path("other.h5"), "--packets", "20000", "--log", path("room.h5")});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("no log of a run"));
}

TEST_F(Pipeline, ExportedIrradianceIsPhysical) {
  // No more light can arrive anywhere than the lamp's radiance all around: E <= pi L_e / (1 - rho), and the
  // walls see some of it.
  solve_small_room(folder_, "room.h5");
  output_of({"export", path("room.h5"), "-o", path("room.csv"), "--values", "zones"});
  double brightest = 0;
  for (const CsvRow& row : csv_rows(folder_ / "room.csv")) {
    const double irradiance = std::stod(row.at("irradiance_g"));
    ASSERT_TRUE(std::isfinite(irradiance));
    ASSERT_GE(irradiance, 0);
    EXPECT_LT(irradiance, 25 / (1 - 0.5));
    brightest = std::max(brightest, irradiance);
  }
  EXPECT_GT(brightest, 0.1);
}

TEST_F(Pipeline, AuditBalancesForBothMethods) {
  for (const char* method : {"shooting", "walk"}) {
    solve_small_room(folder_, "room.h5", {"--method", method});
    const json audit = json::parse(output_of({"audit", path("room.h5"), "--json"}));
    EXPECT_TRUE(audit["balanced"].get<bool>()) << method;
    ASSERT_EQ(audit["bands"].size(), 3U);
    const double emitted[] = {1.2, 1.0, 0.8};  // exitance 30, 25, 20 W/m2 over 0.04 m2
    for (std::size_t b = 0; b < 3; ++b) {
      const json& band = audit["bands"][b];
      EXPECT_EQ(band["balance_quanta"].get<std::int64_t>(), 0) << method;
      EXPECT_NEAR(band["emitted_W"].get<double>(), emitted[b], 1e-6) << method;
      EXPECT_EQ(band["escaped_W"].get<double>(), 0) << method << ": the room is closed";
    }
    EXPECT_THAT(output_of({"audit", path("room.h5")}), HasSubstr("balance exactly"));
  }
}

TEST_F(Pipeline, InfoOfARoom) {
  const json info = json::parse(output_of({"info", path("room.json"), "--json"}));
  EXPECT_EQ(info["kind"], "room");
  EXPECT_THAT(info["bands"], ElementsAre("r", "g", "b"));
  EXPECT_THAT(info["size_m"], ElementsAre(1, 1, 1));
  EXPECT_NEAR(info["area_m2"].get<double>(), 6.04, 1e-9);
  ASSERT_EQ(info["luminaires"].size(), 1U);
  EXPECT_NEAR(info["total_power_W"][0].get<double>(), 1.2, 1e-9);
  // 179 lm/W with the Rec.709 weights of luminance.
  EXPECT_NEAR(info["total_flux_lm"].get<double>(), 179 * (0.2126 * 1.2 + 0.7152 * 1.0 + 0.0722 * 0.8), 1e-6);
  EXPECT_EQ(info["cameras"].size(), 2U);
  EXPECT_THAT(output_of({"info", path("room.json")}), HasSubstr("1 x 1 x 1 m"));
}

TEST_F(Pipeline, InfoOfASolution) {
  solve_small_room(folder_, "room.h5", {"--seed", "77"});
  const json info = json::parse(output_of({"info", path("room.h5"), "--json"}));
  EXPECT_EQ(info["kind"], "solution");
  EXPECT_EQ(info["seed"], 77);
  EXPECT_EQ(info["room_status"], "unchanged");
  EXPECT_EQ(info["method"], "shooting");
  EXPECT_EQ(info["ready_for_views"], true);
  const std::string text = output_of({"info", path("room.h5")});
  EXPECT_THAT(text, HasSubstr("seed 77"));
  EXPECT_THAT(text, HasSubstr("views     begin at once"));
}

TEST_F(Pipeline, SeveralMgfFilesAreOneRoomForAllCommands) {
  std::filesystem::create_directory(folder_ / "moved");
  folder_.write("materials.mgf", "m paint =\nrd 0.5\nm lamp =\nsides 1\ned 1000\n");
  folder_.write("room.mgf",
                "v a =\np 0 0 0\nv b =\np 2 0 0\nv c =\np 2 2 0\nv d =\np 0 2 0\nm paint\nprism a b c d 2\n");
  folder_.write("lamps.mgf", "m lamp\nv e =\np 1 1 1\nsph e 0.2\n");
  const std::vector<std::string> files = {path("materials.mgf"), path("room.mgf"), path("lamps.mgf")};
  const json room = json::parse(output_of({"info", files[0], files[1], files[2], "--json"}));
  EXPECT_EQ(room["surfaces"].size(), 2U);
  output_of({"solve", files[0], files[1], files[2], "-o", path("room.h5"), "--packets", "2000", "--zone-area",
             "1", "--quiet"});
  EXPECT_EQ(json::parse(output_of({"info", path("room.h5"), "--json"}))["room_files"].size(), 3U);
  for (const char* name : {"room.mgf", "lamps.mgf"})
    std::filesystem::rename(folder_ / name, folder_ / ("moved/" + std::string(name)));
  const ProgramRun lost = run_reemit({"export", path("room.h5"), "-o", path("a.csv"), "--values", "zones"});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_THAT(lost.err, HasSubstr("--room"));
  output_of({"export", path("room.h5"), "-o", path("a.csv"), "--values", "zones", "--room", files[0],
             "--room", path("moved/room.mgf"), "--room", path("moved/lamps.mgf")});
  EXPECT_EQ(run_reemit({"info", path("room.h5"), files[0]}).exit_code, 2);
}

TEST_F(Pipeline, InfoTellsHowMuchLightMeetsWhichModel) {
  // A lamp over a sheet that lets 3/4 through to an equal floor: of 1 + 3/4 + what goes back up, so much.
  folder_.write(
      "sheet.mtl",
      "newmtl glass\nKd 0 0 0\nd 0.25\nillum 4\nNi 1\nnewmtl black\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe 1 "
      "1 1\n");
  folder_.write(
      "sheet.obj",
      "mtllib sheet.mtl\nv -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nv -9 -9 0.1\nv 9 -9 0.1\nv 9 9 0.1\n"
      "v -9 9 0.1\nv -9 -9 0.2\nv 9 -9 0.2\nv 9 9 0.2\nv -9 9 0.2\nusemtl black\nf 1 2 3 4\nusemtl "
      "glass\nf 5 6 7 8\nusemtl lamp\nf 12 11 10 9\n");
  const json room = json::parse(output_of({"info", path("sheet.obj"), "--json"}));
  EXPECT_NEAR(room["model_area_shares"]["clear sheet"].get<double>(), 1.0 / 3, 1e-9);
  EXPECT_NEAR(room["model_power_shares"]["clear sheet"].get<double>(), 1 / 1.75, 0.02);
  EXPECT_THAT(output_of({"info", path("sheet.obj")}), HasSubstr("% of the light that arrives"));
}

TEST_F(Pipeline, InfoTellsWhatIsRefusedAndWhatIsNotModelled) {
  folder_.write("glass.mtl",
                "newmtl glass\nKd 1 1 1\nd 0.1\nmap_bump b.png\nnewmtl mirror\nKd 1 1 1\nillum 5\n");
  const std::string obj =
      "mtllib glass.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nusemtl glass\nf 1 2 3\nusemtl mirror\n"
      "f 1 3 4\nusemtl gone\nf 4 3 2\nf 1 1 1\n";
  folder_.write("glass.obj", obj);
  const json room = json::parse(output_of({"info", path("glass.obj"), "--json"}));
  EXPECT_EQ(room["refused"],
            json::parse(R"({"count": 3, "kinds": {"faces": 1, "materials": 1, "statements": 1}})"));
  EXPECT_EQ(room["not_modelled"],
            json::parse(R"({"count": 2, "kinds": {"glass_and_mirrors_as_paint": 1, "other_maps": 1}})"));
  EXPECT_GT(room["model_area_shares"]["clear sheet"].get<double>(), 0.1);
  EXPECT_EQ(room["model_power_shares"]["clear sheet"], 0.0) << "there is no luminaire";
  EXPECT_THAT(output_of({"info", path("glass.obj")}),
              HasSubstr("not modelled  1 glass and mirrors as paint"));
  EXPECT_EQ(json::parse(output_of({"info", path("room.json"), "--json"}))["not_modelled"]["count"], 0);

  folder_.write("bad.obj", obj + "f 1 2 99\n");
  const ProgramRun refused = run_reemit({"info", path("bad.obj"), "--json"});
  EXPECT_EQ(refused.exit_code, 2);
  const json document = json::parse(refused.out);
  EXPECT_EQ(document["kind"], "refused");
  EXPECT_EQ(document["refused"]["count"], 1);
  EXPECT_THAT(document["error"].get<std::string>(), HasSubstr("bad.obj:14: index 99 is out of range"));
  EXPECT_EQ(document["advice"], "The file has 4 vertices.");
}

TEST_F(Pipeline, InfoGivesTheLightOfEverySurfaceAndMaterialWithItsError) {
  // Direct light by packets: shadow rays would bring zones what luminaires send out but for their noise.
  solve_small_room(folder_, "room.h5", {"--direct", "packets"});
  const json info = json::parse(output_of({"info", path("room.h5"), "--json"}));
  ASSERT_EQ(info["surfaces"].size(), 14U) << "both sides of six walls and the lamp";
  ASSERT_EQ(info["materials"].size(), 3U);
  double leaving = 0;
  double received = 0;
  for (const json& surface : info["surfaces"]) {
    const bool outside = surface["side"] == "back" && surface["name"] != "lamp";
    EXPECT_EQ(surface["counts"], !outside) << surface["name"];
    if (outside) continue;
    EXPECT_GT(surface["illuminance_lx"].get<double>(), 0);
    EXPECT_GT(surface["illuminance_stderr_lx"].get<double>(), 0);
    EXPECT_NEAR(surface["received_flux_lm"].get<double>(),
                surface["area_m2"].get<double>() * surface["illuminance_lx"].get<double>(), 1e-9);
    leaving += surface["leaving_flux_lm"].get<double>();
    received += surface["received_flux_lm"].get<double>();
  }
  // The room is closed: what leaves its surfaces arrives on them, but for the quanta on their way at the end.
  EXPECT_NEAR(received / leaving, 1, 1e-4);
  const json& lamp = info["surfaces"][12];
  EXPECT_EQ(lamp["name"], "lamp");
  EXPECT_NEAR(lamp["exitance_W_m2"][0].get<double>(), 30, 1e-9);
  EXPECT_NEAR(lamp["leaving_flux_lm"].get<double>(), info["luminaires"][0]["flux_lm"].get<double>(), 1e-6);
  EXPECT_THAT(output_of({"info", path("room.h5")}), HasSubstr("E [lx]"));

  std::filesystem::remove(folder_ / "room.json");
  const json without = json::parse(output_of({"info", path("room.h5"), "--json"}));
  EXPECT_NE(without["room_status"], "unchanged");
  EXPECT_EQ(without["luminaires"], info["luminaires"]) << "luminous surfaces are in the solution";
}

TEST_F(Pipeline, LightThatNoEyeSeesIsReportedInWatts) {
  folder_.write("heat.json", R"({"format": "reemit-room", "version": 1, "name": "heat",
    "bands": {"wavelengths_nm": [5000, 10000]},
    "materials": {"hot": {"reflectance": 0, "exitance": [1, 2]}, "cold": {"reflectance": 0}},
    "objects": [
      {"name": "source", "material": "hot", "quad": {"corner": [0, 0, 0], "u": [0, 1, 0], "v": [0, 0, 1]}},
      {"name": "plate", "material": "cold", "quad": {"corner": [1, 0, 0], "u": [0, 0, 1], "v": [0, 1, 0]}}]})");
  ASSERT_EQ(run_reemit({"solve", path("heat.json"), "-o", path("heat.h5"), "--packets", "20000"}).exit_code,
            0);
  const std::string info = output_of({"info", path("heat.h5")});
  EXPECT_THAT(info, HasSubstr("E 5000 [W/m2]"));
  EXPECT_THAT(info, HasSubstr("M 10000 [W/m2]"));
  EXPECT_THAT(info, Not(HasSubstr("[lx]")));
  const json surfaces = json::parse(output_of({"info", path("heat.h5"), "--json"}))["surfaces"];
  const auto plate = std::find_if(surfaces.begin(), surfaces.end(), [](const json& surface) {
    return surface["name"] == "plate" && surface["side"] == "front";
  });
  ASSERT_NE(plate, surfaces.end());
  EXPECT_NEAR((*plate)["irradiance_W_m2"][1].get<double>(), 2 * 0.199825, 0.02);
}

TEST_F(Pipeline, VerboseTellsWhatEachStepTookInTimeAndMemory) {
  const auto err_of = [&](const std::string& option) {
    return run_reemit({"solve", path("room.json"), "-o", path("v.h5"), "--packets", "1000", option}).err;
  };
  for (const char* step : {"reemit: reading room.json took", "meshing took", " zones took",
                           "saving v.h5 took", "memory so far at most "})
    EXPECT_THAT(err_of("--verbose"), HasSubstr(step));
  EXPECT_THAT(err_of("--quiet"), IsEmpty());
}

TEST_F(Pipeline, WarningsGoToStandardErrorAndQuietSilencesThem) {
  folder_.write("dark.json", replaced(small_json_room(), R"(, "exitance": [30, 25, 20])", ""));
  const std::vector<std::string> solve{"solve",         path("dark.json"), "-o",
                                       path("dark.h5"), "--packets",       "1000"};
  EXPECT_THAT(run_reemit(solve).err, HasSubstr("reemit: warning: "));
  std::vector<std::string> quiet = solve;
  quiet.emplace_back("--quiet");
  EXPECT_THAT(run_reemit(quiet).err, IsEmpty());
}

}  // namespace
}  // namespace reemit::test
