// That the power which the program says a luminaire has is the power that it sends.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using nlohmann::json;

class LuminairePower : public ::testing::Test {
 protected:
  json run(const std::vector<std::string>& arguments) const {
    const ProgramRun result = run_reemit(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out);
  }
  /// Power [W] that info says of a room, that audit has of its solution, that info says of it, and that it
  /// says once the room is gone.
  std::vector<double> powers(const std::string& lamp, const std::string& objects) const {
    const std::string text = R"({"format": "reemit-room", "version": 1,
 "materials": {"w": {"reflectance": 0.5}, "lamp": {)" +
                             lamp + R"(}},
 "objects": [{"material": "w", "box": {"min": [0, 0, 0], "max": [4, 3, 4], "inward": true}}, )" +
                             objects + "]}";
    const std::string room = folder_.write("room.json", text).string();
    const std::string solution = (folder_ / "room.h5").string();
    std::vector<double> powers{run({"info", room, "--json"})["total_power_W"][0]};
    run({"solve", room, "-o", solution, "--packets", "2000", "--json"});
    powers.push_back(run({"audit", solution, "--json"})["bands"][0]["emitted_W"]);
    powers.push_back(run({"info", solution, "--json"})["total_power_W"][0]);
    std::filesystem::remove(room);
    powers.push_back(run({"info", solution, "--json"})["total_power_W"][0]);
    return powers;
  }

  TempFolder folder_;
};

const std::string kPanel =
    R"({"material": "lamp", "quad": {"corner": [1, 2.9, 1], "u": [1, 0, 0], "v": [0, 0, 1]}})";

TEST_F(LuminairePower, GivenForAllIsSentWhateverMeshingLeavesOfThem) {
  const std::string standing = R"({"material": "lamp", "box": {"min": [3, 0, 3], "max": [3.5, 1, 3.5]}})";
  for (const double power : powers(R"("total_power": 7)", kPanel + ", " + kPanel + ", " + standing))
    EXPECT_NEAR(power, 7, 1e-9);
  for (const double power : powers(R"("total_power": 7, "opacity": 0.25)", kPanel))
    EXPECT_NEAR(power, 7, 1e-6);
}

TEST_F(LuminairePower, OfATextureIsThatOfItsPartOnTheLamp) {
  folder_.write("half.ppm", std::string("P6\n4 1\n255\n") + std::string(6, '\xff') + std::string(6, '\0'));
  const std::string lit_half = R"({"material": "lamp", "mesh": {
 "vertices": [[1, 2.9, 1], [2, 2.9, 1], [2, 2.9, 2], [1, 2.9, 2]], "faces": [[0, 1, 2, 3]],
 "texture_coordinates": [[0.125, 0], [0.375, 0], [0.375, 1], [0.125, 1]]}})";
  for (const double power : powers(R"("exitance": 10, "emission_texture": {"file": "half.ppm"})", lit_half))
    EXPECT_NEAR(power, 10, 1e-6) << "not half of it, the mean of the image";
}

}  // namespace
}  // namespace reemit::test
