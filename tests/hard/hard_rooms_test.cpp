// Rooms that other programs stumble over, read, meshed, solved and asked as users do: docs/hard_cases.md.
// What must be dark is exactly 0; statistics have fixed seeds, and each test says what it allows.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/scene_reader.h"
#include "solver/progressive_solver.h"
#include "solver/zoning/build_zones.h"
#include "tests/support/never.h"
#include "tests/support/temp_folder.h"
#include "tests/support/variable_furnace.h"
#include "tests/support/zone_irradiances.h"
#include "viewer_export/still/render_still.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

const std::string kLamp =
    R"({"name": "lamp", "material": "lamp", "quad": {"corner": [0.5, 2.9, 1], "u": [1, 0, 0], "v": [0, 0, 1]}})";
const std::string kHull =
    R"({"name": "hull", "material": "wall", "box": {"min": [0, 0, 0], "max": [4, 3, 5], "inward": true}})";

Scene room_of(const std::string& objects, const std::string& more = "") {
  const TempFolder folder;
  return read_scene(folder.write("room.json", R"({"format": "reemit-room", "version": 1, "materials": {
    "wall": {"reflectance": 0.5}, "one": {"reflectance": 0.5, "sides": "front"}, "black": {"reflectance": 0},
    "lamp": {"reflectance": 0.2, "radiance": 10}}, "objects": [)" +
                                                  objects + "]" + more + "}"));
}

Solution solved(const Scene& scene, const SolverSettings& settings, const MeshSettings& mesh = {}) {
  return solve_zones(scene, build_zones(scene, mesh), settings, {}, kNever);
}

Solution solved(const Scene& scene, std::uint64_t packets) {
  SolverSettings settings;
  settings.packets = packets;
  return solved(scene, settings);
}

std::size_t surface_of(const Solution& s, const std::string& name) {
  const auto found = std::find(s.surface_names.begin(), s.surface_names.end(), name);
  EXPECT_NE(found, s.surface_names.end()) << name;
  return static_cast<std::size_t>(found - s.surface_names.begin());
}

double watts_absorbed(const Solution& s, const std::string& name) {
  const BandAudit& band = s.audit.bands[0];
  return s.audit.watts(band, band.absorbed[surface_of(s, name)]);
}

/// Rms of radiosity against another solution of the same zones, relative, weighted by area.
double rms_difference(const Solution& a, const Solution& b) {
  double difference = 0;
  double sum = 0;
  for (std::size_t z = 0; z < a.mesh.zone_count(); ++z) {
    const double area = a.mesh.zone_area(ZoneId(z));
    const double reference = b.zone_material(ZoneId(z)).reflectance[0] * b.irradiance(ZoneId(z), 0).mean;
    const double value = a.zone_material(ZoneId(z)).reflectance[0] * a.irradiance(ZoneId(z), 0).mean;
    difference += area * std::pow(value - reference, 2);
    sum += area * reference * reference;
  }
  return std::sqrt(difference / sum);
}

// The floor is one polygon under a room and a closet in its corner, whose walls have no thickness.
/// A closet in the corner (2.3 .. 4, 0 .. 3, 3.1 .. 5) of a lit room, cut off by walls without thickness that
/// stand on the same floor and reach the same ceiling.
class DarkCloset : public ::testing::TestWithParam<SolveMethod> {
 protected:
  DarkCloset() {
    SolverSettings few;
    few.method = GetParam();
    few.packets = 200'000;
    MeshSettings mesh;
    mesh.default_zone_count = 800;
    mesh.share_zones = false;  // or what is dark would be one zone, which exports leave out
    solution_ = solved(scene_, few, mesh);
  }

  /// How far within the closet [m], seen from above.
  static double depth(const Vec3& p) { return std::min(p.x() - 2.3, p.z() - 3.1); }

  Scene scene_ = room_of(kHull + "," + kLamp + R"(,
    {"name": "a", "material": "wall", "quad": {"corner": [2.3, 0, 3.1], "u": [0, 3, 0], "v": [0, 0, 1.9]}},
    {"name": "b", "material": "wall", "quad": {"corner": [2.3, 0, 3.1], "u": [0, 3, 0], "v": [1.7, 0, 0]}})");
  Solution solution_;
};

TEST_P(DarkCloset, HasNoLightInAnyZone) {
  const ZoneMesh& mesh = solution_.mesh;
  int dark = 0;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const ZoneId zone(z);
    const Vec3 seen = mesh.zone_centroid(zone) + 1e-3 * mesh.zone_normal(zone);
    if (depth(seen) < 0 || !(seen.array() > 0).all() || !(seen.array() < Vec3(4, 3, 5).array()).all())
      continue;
    ++dark;
    EXPECT_EQ(solution_.irradiance(zone, 0).mean, 0) << seen.transpose();
  }
  EXPECT_GT(dark, 20);
}

TEST_P(DarkCloset, FloorIsLitOnOneSideOfTheWallsOnlyUpToTheWalls) {
  VertexSettings settings;
  settings.gather_rays = settings.light_samples = 32;
  settings.all_zones = true;
  const VertexData data = gather_vertices(Room(scene_, solution_.mesh), solution_, settings, {}, kNever);
  const auto on_floor = [&](std::uint32_t v) {
    return !data.on_back[v] && data.positions[v].y() == 0 && data.normals[v].y() > 0.9;
  };
  std::size_t dark = 0;
  for (const auto& t : data.triangles) {
    if (!std::all_of(t.begin(), t.end(), on_floor)) continue;
    const Vec3 middle = (data.positions[t[0]] + data.positions[t[1]] + data.positions[t[2]]) / 3;
    for (const std::uint32_t v : t) {
      const Vec3& p = data.positions[v];
      if (depth(middle) > 0) {
        EXPECT_GT(depth(p), -1e-6) << "not cut under the wall";
        EXPECT_EQ(data.irradiance[v], 0) << p.transpose();
      } else if (p.x() > 0.5 && p.z() > 0.5) {
        EXPECT_GT(data.irradiance[v], 0) << p.transpose();
      }
    }
    dark += depth(middle) > 0 ? 1 : 0;
  }
  EXPECT_GT(dark, 10U);
}

TEST_P(DarkCloset, IsBlackInEveryPicture) {
  const Room room(scene_, solution_.mesh);
  Camera inside;
  inside.eye = Vec3(2.5, 2.8, 3.3);
  inside.look_at = Vec3(4, 0, 5);
  inside.vertical_fov_deg = 100;
  StillSettings settings;
  settings.width = 64;
  settings.height = 48;
  settings.spp = 16;
  for (const Integrator integrator : {Integrator::kZones, Integrator::kGather, Integrator::kPath}) {
    settings.integrator = integrator;
    const StillImage image = render_still(room, solution_, inside, settings, {}, kNever);
    EXPECT_EQ(*std::max_element(image.radiance.begin(), image.radiance.end()), 0) << to_string(integrator);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, DarkCloset,
                         ::testing::Values(SolveMethod::kShooting, SolveMethod::kWalk, SolveMethod::kMatrix),
                         [](const auto& method) { return std::string(to_string(method.param)); });

TEST(HardRooms, LampInTheCeilingPlaneSendsItsPowerOnceIntoTheRoom) {
  const std::string hull =
      R"({"name": "hull", "material": "one", "box": {"min": [0, 0, 0], "max": [4, 3, 5], "inward": true}})";
  const Scene scene = room_of(hull + R"(, {"name": "lamp", "material": "lamp",
    "polygon": {"vertices": [[1, 3, 1], [2, 3, 1], [2, 3, 2], [1, 3, 2]]}})");
  const Solution s = solved(scene, 50'000);
  const BandAudit& band = s.audit.bands[0];
  EXPECT_NEAR(s.audit.watts(band, band.emitted), 10 * std::numbers::pi, 1e-9);
  EXPECT_EQ(band.total_escaped(), 0);
  EXPECT_GT(watts_absorbed(s, "hull"), 10);
  EXPECT_THAT(s.mesh_report.warnings, Contains(HasSubstr("'lamp' covers 1 m2 of 'hull'")));
}

TEST(HardRooms, LampThatShinesOutOfTheBackOfItsCeilingIsNamed) {
  const std::string hull =
      R"({"name": "hull", "material": "one", "box": {"min": [0, 0, 0], "max": [4, 3, 5], "inward": true}})";
  const auto warnings = [&](const std::string& order) {
    return build_zones(room_of(hull + R"(, {"name": "lamp", "material": "lamp", "polygon": {"vertices": )" +
                               order + "}}"))
        .report.warnings;
  };
  EXPECT_THAT(warnings("[[1, 3, 2], [2, 3, 2], [2, 3, 1], [1, 3, 1]]"),
              Contains(HasSubstr(
                  "1 luminous faces, 1 m2, lie in one-sided faces and shine out of their backs ('lamp' lies "
                  "in 'hull')")));
  EXPECT_THAT(warnings("[[1, 3, 1], [2, 3, 1], [2, 3, 2], [1, 3, 2]]"),
              ::testing::Not(Contains(HasSubstr("shine out of their backs"))));
}

// A reversed polygon of the same material in a wall is no hole: it is the wall, once.
TEST(HardRooms, AHoleDrawnAsAReversedPolygonDoublesNothing) {
  const Scene scene = room_of(kHull + "," + kLamp + R"(, {"name": "hole", "material": "wall",
    "polygon": {"vertices": [[1, 0, 1], [2, 0, 1], [2, 0, 2], [1, 0, 2]]}})");
  const Solution s = solved(scene, 100'000);
  const Solution plain = solved(room_of(kHull + "," + kLamp), 100'000);
  EXPECT_EQ(s.audit.bands[0].total_escaped(), 0);
  EXPECT_THAT(s.mesh_report.warnings, Contains(HasSubstr("'hull' covers 1 m2 of 'hole'")));
  EXPECT_NEAR(watts_absorbed(s, "hull"), watts_absorbed(plain, "hull"), 1e-3 * watts_absorbed(plain, "hull"));
}

// Two crates that stand in each other, and a wardrobe with a shelf that no light enters.
TEST(HardRooms, BuriedAndShutInZonesAreReportedAndHoldNothingUp) {
  const std::string crates =
      R"(, {"name": "a", "material": "wall", "box": {"min": [1, 0.5, 1], "max": [2, 1.5, 2]}},
    {"name": "b", "material": "wall", "box": {"min": [1.5, 1, 1.5], "max": [2.5, 2, 2.5]}})";
  const std::string wardrobe =
      R"(, {"name": "wardrobe", "material": "wall", "box": {"min": [3, 0.2, 3], "max": [3.8, 2.2, 4.5]}},
    {"name": "shelf", "material": "wall", "quad": {"corner": [3.1, 1, 3.1], "u": [0, 0, 1], "v": [0.5, 0, 0]}})";
  SolverSettings settings;
  settings.error_target = 0.05;
  const Solution plain = solved(room_of(kHull + "," + kLamp), settings);
  const Solution s = solved(room_of(kHull + "," + kLamp + crates + wardrobe), settings);
  EXPECT_EQ(s.record.stopped, StopReason::kErrorTarget);
  EXPECT_LT(s.record.packets, 3 * plain.record.packets);
  EXPECT_EQ(watts_absorbed(s, "shelf"), 0);
  std::size_t buried = 0;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    const ZoneId zone(z);
    const std::size_t surface = s.mesh.zone_surface(zone).index();
    if (surface != surface_of(s, "a") && surface != surface_of(s, "b") &&
        surface != surface_of(s, "wardrobe"))
      continue;
    if (s.irradiance(zone, 0).mean == 0) ++buried;
  }
  // The insides of both crates with what lies of one in the other, and the inside of the wardrobe: one zone
  // each, at least.
  EXPECT_GE(buried, 4U);
}

TEST(HardRooms, LightThatLeavesThroughAWindowIsBookedByDirection) {
  const Scene scene = room_of(kLamp + R"(, {"name": "hull", "material": "wall",
    "box": {"min": [0, 0, 0], "max": [4, 3, 5], "inward": true, "open": ["x+"]}})");
  const Solution s = solved(scene, 100'000);
  const BandAudit& band = s.audit.bands[0];
  EXPECT_GT(band.total_escaped(), band.emitted / 20);
  EXPECT_EQ(band.escaped[1], 0) << "towards -x, where the wall is";
  EXPECT_GT(band.escaped[0], band.total_escaped() / 3) << "towards +x";
  for (const std::size_t sideways : {2, 3, 4, 5}) EXPECT_GT(band.escaped[sideways], 0) << sideways;
  EXPECT_TRUE(s.audit.balanced());
}

// What is left of a packet falls as rho^n; rays must not grow faster than 1/(1 - rho).
TEST(HardRooms, BrightWallsCostNoMoreThanTheirReflections) {
  std::map<double, double> rays;
  for (const double rho : {0.9, 0.99, 0.999}) {
    RoomBuilder room;
    const MaterialId all = room.material("all", rho, 1);
    room.box(Vec3::Zero(), Vec3(3, 2, 1), {all, all, all, all, all, all}, 4);
    SolverSettings settings;
    settings.packets = 8'000;
    settings.direct = DirectSource::kPackets;  // all flights count alike
    const Solution s = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
    rays[rho] = static_cast<double>(s.record.rays);
    // Irradiance is E = 1/(1 - rho).
    EXPECT_NEAR(s.irradiance(ZoneId(0), 0).mean * (1 - rho), 1, 0.05) << rho;
  }
  RecordProperty("rays_0_9", std::to_string(rays[0.9]));
  RecordProperty("rays_0_99", std::to_string(rays[0.99]));
  RecordProperty("rays_0_999", std::to_string(rays[0.999]));
  EXPECT_LT(rays[0.99], 10.1 * rays[0.9]);
  EXPECT_LT(rays[0.999], 10.1 * rays[0.99]);
}

// The true error is measured against a run of half the noise, with another seed.
TEST(HardRooms, TinyLampsNarrowBeamsAndIndirectLightReachTheSameTarget) {
  const std::string shelf =
      R"(, {"name": "shade", "material": "wall", "quad": {"corner": [1, 2.3, 1.5], "u": [2, 0, 0], "v": [0, 0, 2]}})";
  const std::map<std::string, std::string> rooms{
      {"tiny",
       R"(, {"name": "tiny", "material": "lamp", "box": {"min": [2, 2.4, 2], "max": [2.1, 2.5, 2.1]}})"},
      {"narrow",
       R"(, {"name": "narrow", "material": "beam", "quad": {"corner": [2, 2.9, 2], "u": [0.1, 0, 0], "v": [0, 0, 0.1]}})"},
      {"indirect",
       shelf +
           R"(, {"name": "up", "material": "lamp", "quad": {"corner": [2, 2.4, 2], "u": [0, 0, 0.5], "v": [0.5, 0, 0]}})"}};
  for (const auto& [name, objects] : rooms) {
    const TempFolder folder;
    const Scene scene =
        read_scene(folder.write("room.json", R"({"format": "reemit-room", "version": 1, "materials": {
      "wall": {"reflectance": 0.5}, "lamp": {"reflectance": 0.2, "radiance": 10},
      "beam": {"reflectance": 0.2, "radiance": 10, "emission_exponent": 500}}, "objects": [)" +
                                                 kHull + objects + "]}"));
    MeshSettings mesh;
    mesh.default_zone_count = 300;
    SolverSettings settings;
    settings.error_target = 0.08;
    const Solution s = solved(scene, settings, mesh);
    EXPECT_EQ(s.record.stopped, StopReason::kErrorTarget) << name;
    settings.error_target = 0;
    settings.packets = 4 * s.record.packets;
    settings.seed = 2;
    EXPECT_LT(rms_difference(s, solved(scene, settings, mesh)), 0.08) << name;
  }
}

// Screens in a furnace whose zones have 1e-10 to 1 of the area of the largest ones.
TEST(HardRooms, ZonesOfTenDecadesOfAreaHaveTheSameError) {
  VariableFurnace furnace(1);
  double x = 0.2;
  std::vector<double> areas;
  for (const double size : {0.1, 1e-2, 1e-3, 1e-4, 1.5e-5}) {
    furnace.screen({x, 0.2, 0.3}, {size, 0, 0}, {0, 0.4 * size, size}, 1);
    x += 0.25;
  }
  SolverSettings settings;
  settings.packets = 1'000'000;
  const Solution s = solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
  double smallest = 1e9;
  double largest = 0;
  double worst = 0;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    const double area = s.mesh.zone_area(ZoneId(z));
    smallest = std::min(smallest, area);
    largest = std::max(largest, area);
    worst = std::max(worst, std::abs(s.irradiance(ZoneId(z), 0).mean / VariableFurnace::kRadiosity - 1));
  }
  EXPECT_GT(largest / smallest, 0.9e10);
  EXPECT_LT(worst, 0.05);
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(furnace_fit(s, VariableFurnace::kRadiosity), kFalseAlarm);
}

// Batches run on several threads at a time. The error must fall as one over the square root of the packets at
// least, and zones must scatter about the truth as their batches do.
TEST(HardRooms, ErrorFallsOverFourDecadesOfPackets) {
  const VariableFurnace furnace(2);
  for (const SamplingKind sampling : {SamplingKind::kRandom, SamplingKind::kSobol}) {
    double first = 0;
    for (const std::uint64_t packets : {1'000, 10'000, 100'000, 1'000'000, 10'000'000}) {
      if (sampling == SamplingKind::kRandom && packets > 1'000'000) continue;  // time
      SolverSettings settings;
      settings.sampling = sampling;
      settings.threads = 4;
      settings.packets = packets;
      const Solution s = solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
      double squares = 0;
      for (std::size_t z = 0; z < s.mesh.zone_count(); ++z)
        squares += std::pow(s.irradiance(ZoneId(z), 0).mean / VariableFurnace::kRadiosity - 1, 2);
      const double error = std::sqrt(squares / static_cast<double>(s.mesh.zone_count()));
      if (packets == 1'000) first = error;
      // Over 64 zones the error of an error is some tenth; twice is far out.
      EXPECT_LT(error, 2 * first / std::sqrt(static_cast<double>(packets) / 1000)) << packets;
      EXPECT_GT(furnace_fit(s, VariableFurnace::kRadiosity), kFalseAlarm) << packets;
      RecordProperty("error_" + to_string(sampling) + "_" + std::to_string(packets), std::to_string(error));
    }
  }
}

TEST(HardRooms, TenThousandLuminairesSendTheirPower) {
  const Scene scene =
      room_of(R"({"name": "hull", "material": "wall", "box": {"min": [0, 0, 0], "max": [100, 3, 100],
    "inward": true}}, {"name": "lamp", "material": "lamp", "quad": {"corner": [0.3, 2.9, 0.3], "u": [0.3, 0, 0],
    "v": [0, 0, 0.3]}, "array": [{"count": 100, "step": [0.99, 0, 0]}, {"count": 100, "step": [0, 0, 0.99]}]})");
  const Solution s = solved(scene, 100'000);
  const BandAudit& band = s.audit.bands[0];
  EXPECT_NEAR(s.audit.watts(band, band.emitted), 9000 * std::numbers::pi, 1e-6);
  EXPECT_EQ(band.total_escaped(), 0);
  EXPECT_TRUE(s.audit.balanced());
}

TEST(HardRooms, TwelveCubesInARowEqualOneBar) {
  const std::string cubes =
      R"(, {"name": "cube", "material": "wall", "box": {"min": [0.5, 0.5, 2], "max": [0.75, 0.75, 2.25]},
    "array": {"count": 12, "step": [0.25, 0, 0]}})";
  const std::string bar =
      R"(, {"name": "bar", "material": "wall", "box": {"min": [0.5, 0.5, 2], "max": [3.5, 0.75, 2.25]}})";
  constexpr std::uint64_t kPackets = 2'000'000;
  const Solution a = solved(room_of(kHull + "," + kLamp + cubes), kPackets);
  const Solution b = solved(room_of(kHull + "," + kLamp + bar), kPackets);
  double in_cubes = 0;
  for (const std::string& name : a.surface_names)
    if (name.starts_with("cube")) in_cubes += watts_absorbed(a, name);
  // 2e6 packets, of which some 2 % meet the bar: a relative error below 1 % each.
  EXPECT_NEAR(in_cubes, watts_absorbed(b, "bar"), 0.02 * watts_absorbed(b, "bar"));
  RecordProperty("cubes_over_bar", std::to_string(in_cubes / watts_absorbed(b, "bar")));
  // No light between them: what is lit of the cubes is what the bar shows.
  const auto lit_area = [](const Solution& s) {
    double area = 0;
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      const std::string& name = s.surface_names[s.mesh.zone_surface(ZoneId(z)).index()];
      if ((name.starts_with("cube") || name == "bar") && s.irradiance(ZoneId(z), 0).mean > 0)
        area += s.mesh.zone_area(ZoneId(z));
    }
    return area;
  };
  EXPECT_NEAR(lit_area(a), lit_area(b), 1e-9);
}

/// Light of a sun on a faceted ball whose shading normals are those of the sphere: largest difference of the
/// irradiance of its zones from E cos, over E, with cos at their middle on the sphere.
double worst_zone_of_ball(int segments) {
  const TempFolder folder;
  const Scene scene =
      read_scene(folder.write("room.json", R"({"format": "reemit-room", "version": 1, "materials": {
    "wall": {"reflectance": 0}}, "objects": [{"name": "ball", "material": "wall",
    "sphere": {"center": [0, 0, 0], "radius": 1, "segments": )" +
                                               std::to_string(segments) + R"(}}],
    "lights": [{"type": "directional", "direction": [-1, -0.3, -0.2], "irradiance": 100}]})"));
  SolverSettings settings;
  settings.packets = 2'000'000;
  MeshSettings mesh;
  mesh.zone_area = 100;  // the facets are the zones
  mesh.share_zones = false;
  const Solution s = solved(scene, settings, mesh);
  const Vec3 to_sun = Vec3(1, 0.3, 0.2).normalized();
  double worst = 0;
  for (std::size_t t = 0; t < s.mesh.triangle_count(); ++t) {
    const Vec3 middle = s.mesh.point(TriangleId(t), 1.0 / 3, 1.0 / 3);
    const ZoneId zone = s.mesh.zone_at(TriangleId(t), 1.0F / 3, 1.0F / 3, true);
    const double e = s.irradiance(zone, 0).mean / 100;
    // Geometric normals: a facet that looks away from the sun is dark, whatever its shading normals say.
    const double facet = s.mesh.triangle_normal(TriangleId(t)).dot(to_sun);
    if (facet < 0) {
      EXPECT_EQ(e, 0) << segments;
    }
    worst = std::max(worst, std::abs(e - std::max(0.0, middle.normalized().dot(to_sun))));
  }
  return worst;
}

TEST(HardRooms, CoarseBallsWithSmoothNormalsConverge) {
  const double coarse = worst_zone_of_ball(8);
  const double middle = worst_zone_of_ball(16);
  const double fine = worst_zone_of_ball(32);
  RecordProperty("errors",
                 std::to_string(coarse) + " " + std::to_string(middle) + " " + std::to_string(fine));
  EXPECT_LT(middle, 0.6 * coarse);
  EXPECT_LT(fine, 0.6 * middle);
}

}  // namespace
}  // namespace reemit::test
