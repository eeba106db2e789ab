// A floor of checks as an image and as faces: light on every zone, at every vertex and in every block of a
// still is the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/progressive_solver.h"
#include "tests/support/mean_test.h"
#include "tests/support/never.h"
#include "tests/support/pixmap.h"
#include "viewer_export/still/render_still.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit {
namespace {

using test::MeanTest;

constexpr int kChecksAlong = 4;
constexpr int kStillWidth = 32;  // [px] of the still
constexpr int kStillHeight = 24;
constexpr int kStillBlock = 8;
constexpr int kSolves = 32;
/// Single places: Student's t with 62 degrees of freedom is beyond 6 standard errors once in 9 million, and
/// there are some hundred places. Sums over places: 5, as MeanTest has it.
constexpr double kMostPlaceErrors = 6;

bool is_light(int i, int j) {
  return (i + j) % 2 == 0;
}

/// Where light is looked at: what (zone, wall, vertex, block), place and way [mm, 1/1000].
using LightPlace = std::tuple<char, long, long, long, long, long, long>;

LightPlace place_of(char what, const Vec3& at, const Vec3& normal) {
  const auto k = [](double value) { return std::lround(1000 * value); };
  return {what, k(at.x()), k(at.y()), k(at.z()), k(normal.x()), k(normal.y()), k(normal.z())};
}

/// Means over runs by place, and of their sums over each kind.
struct CheckeredLight {
  std::map<LightPlace, MeanTest> at;
  std::map<char, MeanTest> sums;
};

Scene checkered(const test::TempFolder& folder, bool as_image) {
  std::string floor;
  if (as_image) {
    std::vector<std::array<int, 3>> texels;
    for (int j = kChecksAlong - 1; j >= 0; --j)  // rows from the top
      for (int i = 0; i < kChecksAlong; ++i) {
        const int value = is_light(i, j) ? 255 : 51;
        texels.push_back({value, value, value});
      }
    test::write_pixmap(folder / "checks.ppm", kChecksAlong, kChecksAlong, texels);
    floor =
        R"(, {"name": "floor", "material": "image", "quad": {"corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]}})";
  }
  for (int i = 0; i < kChecksAlong && !as_image; ++i)
    for (int j = 0; j < kChecksAlong; ++j)
      floor += std::string(R"(, {"name": "floor", "material": ")") + (is_light(i, j) ? "light" : "dark") +
               R"(", "quad": {"corner": [)" + std::to_string(i) + ", " + std::to_string(j) +
               R"(, 0], "u": [1, 0, 0], "v": [0, 1, 0]}})";
  return read_scene(
      folder.write("room.json", R"({"format": "reemit-room", "version": 1, "bands": "grey", "materials": {
      "wall": {"reflectance": 0.5}, "lamp": {"reflectance": 0, "radiance": 10}, "light": {"reflectance": 0.9},
      "dark": {"reflectance": 0.18})" +
                                    std::string(as_image ? R"(, "image": {"reflectance": 0.9, "texture":
          {"file": "checks.ppm", "encoding": "linear", "filter": "nearest"}})"
                                                         : "") +
                                    R"(}, "objects": [
      {"name": "hull", "material": "wall", "box": {"min": [0, 0, 0], "max": [4, 4, 3], "inward": true, "open": ["z-"]}},
      {"name": "lamp", "material": "lamp", "quad": {"corner": [0.5, 0.5, 2.9], "u": [0, 1, 0], "v": [1, 0, 0]}})" +
                                    floor + R"(],
      "cameras": [{"name": "c", "eye": [2, 2, 2.7], "look_at": [2, 2, 0], "up": [0, 1, 0], "vertical_fov_deg": 80}]})"));
}

/// Zones of the floor one by one; of the walls, whose zones end where faces of the floor do, their mean.
void add_zones(const Solution& s, std::map<LightPlace, double>& values) {
  constexpr double kWallArea = 12;  // [m2]
  for (std::size_t i = 0; i < s.mesh.zone_count(); ++i) {
    const ZoneId z(i);
    const double radiosity = s.irradiance(z, 0).mean * s.zone_reflectance(z, 0);
    const Vec3 normal = s.mesh.zone_normal(z);
    if (s.surface_names[s.mesh.zone_surface(z).index()].starts_with("floor"))
      values[place_of('z', s.mesh.zone_centroid(z), normal)] += radiosity;
    else
      values[place_of('w', Vec3::Zero(), normal)] += radiosity * s.mesh.zone_area(z) / kWallArea;
  }
}

/// Vertices of the floor inside checks: at their edges an image is either of its texels.
void add_vertices(const Room& room, const Solution& s, std::uint64_t seed,
                  std::map<LightPlace, double>& values) {
  VertexSettings settings;
  settings.gather_rays = 32;
  settings.light_samples = 32;
  settings.seed = seed;
  settings.close_hit = 0;  // all gather rays read zones: quicker, and as near in both rooms
  settings.threads = 2;
  const VertexData data = gather_vertices(room, s, settings, {}, test::kNever);
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    const Vec3& at = data.positions[v];
    const bool on_floor = std::abs(at.z()) < 1e-6 && std::abs(data.normals[v].z()) > 0.5;
    const auto is_inside = [](double x) { return std::abs(x - std::round(x)) > 0.1; };
    if (!on_floor || !is_inside(at.x()) || !is_inside(at.y())) continue;
    values[place_of('v', at, data.normals[v])] += static_cast<double>(data.radiance[v]);
  }
}

void add_blocks(const Room& room, const Solution& s, std::uint64_t seed,
                std::map<LightPlace, double>& values) {
  StillSettings settings;
  settings.width = kStillWidth;
  settings.height = kStillHeight;
  settings.spp = 16;
  settings.close_hit = 0;
  settings.seed = seed;
  settings.threads = 2;
  const StillImage still = render_still(room, s, room.scene().cameras.at(0), settings, {}, test::kNever);
  for (int y = 0; y < kStillHeight; ++y)
    for (int x = 0; x < kStillWidth; ++x)
      values[{'b', x / kStillBlock, y / kStillBlock, 0, 0, 0, 0}] +=
          static_cast<double>(still.radiance[static_cast<std::size_t>(y * kStillWidth + x)]) /
          (kStillBlock * kStillBlock);
}

CheckeredLight light_in(const Scene& scene, std::uint64_t first_seed) {
  MeshSettings mesh;
  mesh.zone_area = 0.125;  // cells end where checks do, and have corners in the middle of checks
  const MeshResult meshed = build_mesh(scene, mesh);
  SolverSettings solver;
  solver.packets = 32768;
  solver.batch_packets = 2048;
  solver.gather_small_zones = false;
  solver.threads = 2;
  CheckeredLight light;
  for (std::uint64_t seed = first_seed; seed < first_seed + kSolves; ++seed) {
    solver.seed = seed;
    const Solution solution = solve_zones(scene, meshed, solver, nullptr, test::kNever);
    const Room room(scene, solution.mesh);
    std::map<LightPlace, double> values;
    add_zones(solution, values);
    add_vertices(room, solution, seed, values);
    add_blocks(room, solution, seed, values);
    std::map<char, double> sums;
    for (const auto& [place, value] : values) {
      light.at[place].add(value);
      sums[std::get<0>(place)] += value;
    }
    for (const auto& [what, sum] : sums) light.sums[what].add(sum);
  }
  return light;
}

TEST(CheckeredRoom, ZonesVerticesAndStillsAreThoseOfChecksAsFaces) {
  const test::TempFolder folder;
  const CheckeredLight image = light_in(checkered(folder, true), 1);
  const CheckeredLight faces = light_in(checkered(folder, false), 101);
  ASSERT_EQ(image.at.size(), faces.at.size());
  std::map<char, int> places;
  for (const auto& [place, of_image] : image.at) {
    const auto found = faces.at.find(place);
    ASSERT_NE(found, faces.at.end()) << testing::PrintToString(place);
    const MeanTest& of_faces = found->second;
    ++places[std::get<0>(place)];
    const double error = std::hypot(of_image.standard_error(), of_faces.standard_error());
    EXPECT_LE(std::abs(of_image.mean() - of_faces.mean()),
              kMostPlaceErrors * error + MeanTest::kRounding * of_faces.mean())
        << testing::PrintToString(place) << ": " << of_image.mean() << " and " << of_faces.mean() << " +- "
        << error;
  }
  const std::map<char, int> fewest{{'z', 128}, {'w', 5}, {'v', 16}, {'b', 12}};
  for (const auto& [what, sum] : image.sums) {
    EXPECT_GE(places[what], fewest.at(what)) << what;
    EXPECT_TRUE(test::agree(sum, faces.sums.at(what))) << what;
    EXPECT_TRUE(sum.would_notice(what == 'v' ? 0.04 : 0.02, sum.mean())) << what;
  }
}

}  // namespace
}  // namespace reemit
