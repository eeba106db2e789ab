// Textures, emissive textures and cut-outs against the same rooms without: faces in place of checks and of
// holes, closed forms, quadrature of the image's own formula.

#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/gather/direct_light.h"
#include "solver/progressive_solver.h"
#include "solver/solution/solution_file.h"
#include "tests/support/mean_test.h"
#include "tests/support/pixmap.h"
#include "viewer_export/still/render_still.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::MeanTest;

constexpr int kChecks = 4;

bool is_white(int i, int j) {
  return (i + j) % 2 == 0;
}

class TexturedRooms : public testing::Test {
 protected:
  TexturedRooms() {
    std::vector<std::array<int, 3>> checks;
    for (int j = kChecks - 1; j >= 0; --j)  // rows from the top
      for (int i = 0; i < kChecks; ++i)
        checks.push_back(is_white(i, j) ? Pixel{255, 255, 255} : Pixel{0, 0, 0});
    test::write_pixmap(folder_ / "checks.ppm", kChecks, kChecks, checks);
  }
  using Pixel = std::array<int, 3>;

  Scene room(const std::string& materials, const std::string& objects) const {
    return read_scene(folder_.write(
        "room.json",
        R"({"format": "reemit-room", "version": 1, "bands": "grey", "materials": {"wall": {"reflectance": 0.5},
        "black": {"reflectance": 0}, "lamp": {"reflectance": 0, "radiance": 10}, )" +
            materials + R"(}, "objects": [)" + objects + "]}"));
  }

  /// A quad of n x n checks as faces, `white` and `black` ones of these materials; "" leaves them out.
  static std::string checks_as_faces(const std::string& white, const std::string& black) {
    std::string objects;
    for (int i = 0; i < kChecks; ++i)
      for (int j = 0; j < kChecks; ++j) {
        const std::string& material = is_white(i, j) ? white : black;
        if (material.empty()) continue;
        objects += R"(, {"name": "check", "material": ")" + material + R"(", "quad": {"corner": [)" +
                   std::to_string(i) + ", " + std::to_string(j) + R"(, 0], "u": [1, 0, 0], "v": [0, 1, 0]}})";
      }
    return objects;
  }

  static Solution solve(const Scene& scene, SolveMethod method, std::uint64_t seed,
                        std::uint64_t packets = 8192) {
    SolverSettings settings;
    settings.method = method;
    settings.packets = packets;
    settings.batch_packets = packets / 2;
    settings.gather_small_zones = false;
    settings.seed = seed;
    settings.threads = 2;
    MeshSettings mesh;
    mesh.zone_area = 0.5;
    const std::atomic<bool> interrupt = false;
    return solve_zones(scene, build_mesh(scene, mesh), settings, nullptr, interrupt);
  }

  /// Watts absorbed by the surfaces whose names start so, over independent runs, of which each must lose
  /// nothing.
  static MeanTest absorbed_by(const Scene& scene, const std::string& name, SolveMethod method,
                              std::uint64_t first, std::size_t of_band) {
    MeanTest watts;
    for (std::uint64_t seed = first; seed < first + 40; ++seed) {
      const Solution s = solve(scene, method, seed);
      const BandAudit& band = s.audit.bands[of_band];
      EXPECT_EQ(band.balance(), 0);
      EXPECT_EQ(band.total_escaped(), 0);
      RunQuanta quanta = 0;
      for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
        if (scene.surfaces[i].name.starts_with(name)) quanta += band.absorbed[i];
      watts.add(s.audit.watts(band, quanta));
    }
    return watts;
  }

  /// The surfaces whose names start so absorb the same in both rooms, by either method; a difference of
  /// `noticed` would be seen.
  static void expect_same_absorption(const Scene& a, const Scene& b, const std::string& name, double noticed,
                                     std::size_t band = 0) {
    for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
      const MeanTest watts = absorbed_by(a, name, method, 1, band);
      EXPECT_TRUE(test::agree(watts, absorbed_by(b, name, method, 101, band))) << name;
      EXPECT_TRUE(watts.would_notice(noticed, watts.mean())) << name;
    }
  }

  test::TempFolder folder_;
};

const std::string kHull =
    R"({"name": "hull", "material": "wall", "box": {"min": [0, 0, 0], "max": [4, 4, 3], "inward": true, "open": ["z-"]}},
       {"name": "lamp", "material": "lamp", "quad": {"corner": [0.5, 0.5, 2.9], "u": [0, 1, 0], "v": [1, 0, 0]}})";

TEST_F(TexturedRooms, CheckeredFloorIsThatOfChecksAsFaces) {
  const Scene textured =
      room(R"("floor": {"reflectance": 0.9, "texture": {"file": "checks.ppm", "filter": "nearest"}})",
           kHull + R"(, {"name": "check", "material": "floor",
                                         "quad": {"corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]}})");
  const Scene faces = room(R"("white": {"reflectance": 0.9})", kHull + checks_as_faces("white", "black"));
  expect_same_absorption(textured, faces, "check", 0.04);
  expect_same_absorption(textured, faces, "hull", 0.04);
}

/// Two rooms in spectral bands: checks of two colours as an image and as faces.
struct ColouredChecks {
  explicit ColouredChecks(const test::TempFolder& folder) {
    std::vector<std::array<int, 3>> checks;
    std::string faces;
    for (int j = kChecks - 1; j >= 0; --j)  // rows from the top
      for (int i = 0; i < kChecks; ++i) {
        checks.push_back(is_white(i, j) ? std::array<int, 3>{255, 0, 0} : std::array<int, 3>{0, 255, 255});
        faces += std::string(R"(, {"name": "check", "material": ")") + (is_white(i, j) ? "red" : "cyan") +
                 R"(", "quad": {"corner": [)" + std::to_string(i) + ", " + std::to_string(j) +
                 R"(, 0], "u": [1, 0, 0], "v": [0, 1, 0]}})";
      }
    test::write_pixmap(folder / "coloured.ppm", kChecks, kChecks, checks);
    textured = room(folder, R"(, {"name": "check", "material": "floor",
                                  "quad": {"corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]}})");
    faceted = room(folder, faces);
  }

  static Scene room(const test::TempFolder& folder, const std::string& floor) {
    ReadOptions options;
    options.bands = {400, 700, 20};
    return read_scene(folder.write("coloured.json",
                                   R"({"format": "reemit-room", "version": 1, "bands": "rgb", "materials": {
        "wall": {"reflectance": 0.5}, "lamp": {"reflectance": 0, "radiance": [10, 10, 10]},
        "red": {"reflectance": [1, 0, 0]}, "cyan": {"reflectance": [0, 1, 1]},
        "floor": {"reflectance": 1, "texture": {"file": "coloured.ppm", "filter": "nearest"}}}, "objects": [)" +
                                       std::string(kHull) + floor + "]}"),
                      options);
  }

  Scene textured, faceted;
};

TEST_F(TexturedRooms, ColoursInSpectralBandsAreThoseOfChecksAsFaces) {
  const ColouredChecks checks(folder_);
  ASSERT_EQ(checks.textured.bands.count(), 16U);
  // Every point by itself, and the light that is exchanged: of a red and of a blue band.
  const MeshResult meshed = build_mesh(checks.textured, {});
  const Room walls(checks.textured, meshed.mesh);
  std::size_t points = 0;
  for (std::size_t t = 0; t < meshed.mesh.triangle_count(); ++t) {
    const BaseTriangle& triangle = meshed.mesh.triangle(TriangleId(t));
    if (checks.textured.surfaces[triangle.surface.index()].name != "check") continue;
    for (const auto& [u, v] : {std::pair{0.1F, 0.3F}, {0.6F, 0.3F}, {0.15F, 0.72F}, {0.37F, 0.32F}}) {
      const SurfacePoint x = surface_point(walls.rays(), TriangleId(t), u, v, true);
      const Vec3 at = meshed.mesh.point(TriangleId(t), u, v);
      const auto i = static_cast<int>(at.x());
      const auto j = static_cast<int>(at.y());
      SurfaceModel::PointValues here;
      const float* rho = walls.surfaces().reflectance(x, here);
      for (const Material& m : checks.faceted.materials)
        if (m.name == (is_white(i, j) ? "red" : "cyan")) {
          for (std::size_t b = 0; b < 16; ++b)
            EXPECT_NEAR(rho[b], m.reflectance[static_cast<Eigen::Index>(b)], 1e-6) << m.name << b;
        }
      ++points;
    }
  }
  EXPECT_GE(points, 8U);
  for (const std::size_t band : {2U, 11U}) {
    expect_same_absorption(checks.textured, checks.faceted, "check", 0.05, band);
    expect_same_absorption(checks.textured, checks.faceted, "hull", 0.05, band);
  }
}

TEST_F(TexturedRooms, ZonesHoldTheMeanOfTheImage) {
  const Scene scene =
      room(R"("floor": {"reflectance": 0.9, "texture": {"file": "checks.ppm", "scale": 3.7}})",
           kHull + R"(, {"name": "check", "material": "floor",
                                      "quad": {"corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]}})");
  const Solution s = solve(scene, SolveMethod::kShooting, 1, 1024);
  double sum = 0;
  double area = 0;
  for (std::size_t i = 0; i < s.mesh.zone_count(); ++i) {
    if (s.surface_names[s.mesh.zone_surface(ZoneId(i)).index()] != "check" ||
        !s.mesh.zone_is_front(ZoneId(i)))
      continue;
    sum += s.mesh.zone_area(ZoneId(i)) * s.zone_reflectance(ZoneId(i), 0);
    area += s.mesh.zone_area(ZoneId(i));
  }
  EXPECT_NEAR(area, 16, 1e-9);
  // The integral of the interpolated image over 3.7 repetitions each way, by a fine grid of its own formula.
  const auto value = [](double u, double v) {
    const double x = u * kChecks - 0.5;
    const double y = v * kChecks - 0.5;
    const auto at = [](double i, double j) {
      const auto k = [](double n) {
        return static_cast<int>(std::floor(n) - kChecks * std::floor(n / kChecks));
      };
      return is_white(k(i), kChecks - 1 - k(j)) ? 1.0 : 0.0;
    };
    const double a = x - std::floor(x);
    const double b = y - std::floor(y);
    return (1 - b) * ((1 - a) * at(x, y) + a * at(x + 1, y)) +
           b * ((1 - a) * at(x, y + 1) + a * at(x + 1, y + 1));
  };
  double truth = 0;
  constexpr int kGrid = 1000;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j)
      truth += 0.9 * value(3.7 * (i + 0.5) / kGrid, 1 - 3.7 * (j + 0.5) / kGrid) / (kGrid * kGrid);
  EXPECT_NEAR(sum / area, truth, 1e-3 * truth);
}

/// An emissive image of 5 x 3 texels without symmetry.
const std::vector<std::array<int, 3>> kGlow{{10, 10, 10}, {200, 200, 200}, {30, 30, 30}, {255, 255, 255},
                                            {60, 60, 60}, {90, 90, 90},    {0, 0, 0},    {120, 120, 120},
                                            {20, 20, 20}, {250, 250, 250}, {5, 5, 5},    {180, 180, 180},
                                            {70, 70, 70}, {140, 140, 140}, {33, 33, 33}};

Scene glowing(const test::TempFolder& folder) {
  test::write_pixmap(folder / "glow.ppm", 5, 3, kGlow);
  return read_scene(
      folder.write("glow.json", R"({"format": "reemit-room", "version": 1, "bands": "grey", "materials": {
    "screen": {"reflectance": 0, "radiance": 7, "emission_texture": {"file": "glow.ppm", "encoding": "linear", "wrap": "clamp"}},
    "black": {"reflectance": 0}}, "objects": [
    {"name": "screen", "material": "screen", "quad": {"corner": [0, 0, 0], "u": [2, 0, 0], "v": [0, 1, 0]}},
    {"name": "hull", "material": "black", "box": {"min": [-3, -3, -1], "max": [5, 4, 3], "inward": true}}]})"));
}

TEST_F(TexturedRooms, EmissiveTextureSendsThePowerOfItsIntegral) {
  const Scene scene = glowing(folder_);
  const Solution s = solve(scene, SolveMethod::kShooting, 1, 1024);
  double mean = 0;
  for (const auto& p : kGlow) mean += p[0] / 255.0 / 15;  // with clamped edges the integral is that of texels
  const double watts = s.audit.watts(s.audit.bands[0], s.audit.bands[0].emitted);
  EXPECT_NEAR(watts, pi * 7 * mean * 2, 1e-3 * watts);
}

/// The point x of a level face, seen from below.
SurfacePoint ceiling_point(const Room& walls, const Vec3& x) {
  const ZoneMesh& mesh = walls.mesh();
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId triangle(t);
    const Barycentric b = mesh.barycentric_of(triangle, x);
    if (std::abs(mesh.corner(triangle, 0).z() - x.z()) > 1e-9 || b.u < 0 || b.v < 0 || b.u + b.v > 1)
      continue;
    if (std::abs(mesh.triangle_normal(triangle).z()) < 0.5) continue;
    return surface_point(walls.rays(), triangle, static_cast<float>(b.u), static_cast<float>(b.v),
                         mesh.triangle_normal(triangle).z() < 0);
  }
  ADD_FAILURE() << "no face there";
  return surface_point(walls.rays(), TriangleId(0), 0.3F, 0.3F, true);
}

/// Irradiance at a point of the ceiling by shadow rays [W/m2].
MeanTest direct_light_at(const Scene& scene, const Vec3& x) {
  MeshSettings settings;
  settings.zone_area = 0.1;
  const MeshResult meshed = build_mesh(scene, settings);
  const Room walls(scene, meshed.mesh);
  const DirectLight light(walls);
  const SurfacePoint point = ceiling_point(walls, x);
  MeanTest mean;
  for (std::uint64_t k = 0; k < 32; ++k) {
    double sum = 0;
    light.add_samples(point, SobolSequence(500 + k), 0, 1024, &sum);
    mean.add(sum / 1024);
  }
  return mean;
}

TEST_F(TexturedRooms, DirectLightOfAnEmissiveTextureIsItsIntegral) {
  // A point of the ceiling above the screen, and the quadrature of the interpolated image.
  const Vec3 x(0.7, 0.4, 3);
  const auto value = [](double u, double v) {
    const double px = std::clamp(u * 5 - 0.5, 0.0, 4.0);
    const double py = std::clamp((1 - v) * 3 - 0.5, 0.0, 2.0);
    const auto texel = [](int i, int j) { return kGlow[static_cast<std::size_t>(5 * j + i)][0] / 255.0; };
    const int i = std::min(static_cast<int>(px), 3);
    const int j = std::min(static_cast<int>(py), 1);
    const double a = px - i;
    const double b = py - j;
    return (1 - b) * ((1 - a) * texel(i, j) + a * texel(i + 1, j)) +
           b * ((1 - a) * texel(i, j + 1) + a * texel(i + 1, j + 1));
  };
  double truth = 0;
  constexpr int kGrid = 400;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) {
      const double u = (i + 0.5) / kGrid;
      const double v = (j + 0.5) / kGrid;
      const Vec3 way = x - Vec3(2 * u, v, 0);
      const double cosine = way.z() / way.norm();
      truth += 7 * value(u, v) * cosine * cosine / way.squaredNorm() * 2 / (kGrid * kGrid);
    }
  const MeanTest mean = direct_light_at(glowing(folder_), x);
  EXPECT_TRUE(mean.agrees_with(truth));
  EXPECT_TRUE(mean.would_notice(0.02, truth));
}

const std::string kCeiling =
    R"({"name": "ceiling", "material": "black", "quad": {"corner": [0, 0, 3], "u": [0, 4, 0], "v": [4, 0, 0]}})";

// Packets leave a zone with what is there of it; shadow rays must not find more.
TEST_F(TexturedRooms, LuminousCutOutSendsWhatIsThereOfIt) {
  // From a square, on its axis: c = (4/pi) a/sqrt(1+a^2) atan(a/sqrt(1+a^2)) with a = half side / distance.
  const Scene sheet = room(R"("lace": {"reflectance": 0, "exitance": 100, "opacity": 0.25})",
                           kCeiling + R"(, {"name": "lamp", "material": "lace",
                              "quad": {"corner": [1, 1, 0], "u": [2, 0, 0], "v": [0, 2, 0]}})");
  const double a = 1.0 / 3;
  const double side = a / std::sqrt(1 + a * a);
  const double truth = 0.25 * 100 * 4 / pi * side * std::atan(side);
  const MeanTest even = direct_light_at(sheet, {2, 2, 3});
  EXPECT_TRUE(even.agrees_with(truth));
  EXPECT_TRUE(even.would_notice(0.02, truth));

  // Squares that are there and squares that are not, and a texture that makes them glow differently.
  const std::string holes =
      R"("reflectance": 0, "opacity_texture": {"file": "checks.ppm", "filter": "nearest"}, "opacity_cutoff": 0.5)";
  const std::string quad = R"(, {"name": "lamp", "material": "lace",
                              "quad": {"corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]}})";
  const Scene cut = room(R"("lace": {)" + holes + R"(, "radiance": 10})", kCeiling + quad);
  const Scene faces = room(R"("lace": {"reflectance": 0})", kCeiling + checks_as_faces("lamp", ""));
  const MeanTest of_faces = direct_light_at(faces, {1.3, 2.2, 3});
  const MeanTest of_holes = direct_light_at(cut, {1.3, 2.2, 3});
  EXPECT_TRUE(test::agree(of_holes, of_faces));
  EXPECT_TRUE(of_holes.would_notice(0.1, of_faces.mean()));
  // What packets find is the same light.
  const Solution s = solve(sheet, SolveMethod::kShooting, 1, 1024);
  EXPECT_NEAR(s.audit.watts(s.audit.bands[0], s.audit.bands[0].emitted), 0.25 * 100 * 4, 1e-3);
}

const std::string kChambers =
    R"({"name": "bright", "material": "wall", "box": {"min": [0, 0, -2], "max": [4, 4, 0], "inward": true, "open": ["z+"]}},
       {"name": "far", "material": "wall", "box": {"min": [0, 0, 0], "max": [4, 4, 2], "inward": true, "open": ["z-"]}},
       {"name": "lamp", "material": "lamp", "quad": {"corner": [1.5, 1.5, -1.9], "u": [1, 0, 0], "v": [0, 1, 0]}})";

TEST_F(TexturedRooms, CutOutLetsAsMuchThroughAsItsHoles) {
  const Scene cut = room(
      R"("sheet": {"reflectance": 0.5, "opacity_texture": {"file": "checks.ppm", "filter": "nearest"}, "opacity_cutoff": 0.5})",
      kChambers + R"(, {"name": "sheet", "material": "sheet",
                       "quad": {"corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]}})");
  const Scene holes = room(R"("sheet": {"reflectance": 0.5})", kChambers + checks_as_faces("sheet", ""));
  expect_same_absorption(cut, holes, "far", 0.05);
  // Zones are as large as what is there of them, so irradiance is that of the sheet.
  const Solution s = solve(cut, SolveMethod::kShooting, 1);
  double area = 0;
  for (std::size_t i = 0; i < s.mesh.zone_count(); ++i)
    if (s.surface_names[s.mesh.zone_surface(ZoneId(i)).index()] == "sheet" && s.mesh.zone_is_front(ZoneId(i)))
      area += s.mesh.zone_area(ZoneId(i));
  EXPECT_NEAR(area, 8, 0.05);
  save_solution(s, folder_ / "cut.h5");
  const Solution again = load_solution(folder_ / "cut.h5");
  EXPECT_EQ(again.zone_reflectances, s.zone_reflectances);
  EXPECT_EQ(again.zone_exitances, s.zone_exitances);
  EXPECT_EQ(again.mesh.solid_shares(), s.mesh.solid_shares());
}

TEST_F(TexturedRooms, OpacityOfAHalfIsAClearSheetOfAHalf) {
  const std::string sheet = R"(, {"name": "sheet", "material": "sheet",
                                "quad": {"corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]}})";
  const Scene thin = room(R"("sheet": {"reflectance": 0.6, "opacity": 0.5})", kChambers + sheet);
  const Scene clear = room(R"("sheet": {"reflectance": 0.3, "transmittance": 0.5})", kChambers + sheet);
  expect_same_absorption(thin, clear, "far", 0.05);
  expect_same_absorption(thin, clear, "sheet", 0.05);
}

/// What an eye at `eye` sees of a screen of checks that glow; in a black room, so that there is no noise.
StillImage look_at_checks(const test::TempFolder& folder, const std::string& objects, const Vec3& eye,
                          const Vec3& look_at, double fov, int size, int spp,
                          const std::string& scale = "1") {
  const Scene scene = read_scene(folder.write(
      "seen.json", R"({"format": "reemit-room", "version": 1, "bands": "grey", "materials": {
      "screen": {"reflectance": 0, "radiance": 1, "emission_texture": {"file": "checks.ppm", "filter": "nearest", "scale": )" +
                       scale + R"(}}, "mirror": {"mirror": 1}}, "objects": [)" + objects + "]}"));
  SolverSettings settings;
  settings.packets = settings.batch_packets = 1024;
  settings.threads = 2;
  MeshSettings mesh;
  mesh.zone_area = 100;  // zones that know nothing of the image
  const std::atomic<bool> interrupt = false;
  const Solution solution = solve_zones(scene, build_mesh(scene, mesh), settings, nullptr, interrupt);
  const Room walls(scene, solution.mesh);
  Camera camera;
  camera.eye = eye;
  camera.look_at = look_at;
  camera.up = {0, 1, 0};
  camera.vertical_fov_deg = fov;
  StillSettings still;
  still.width = still.height = size;
  still.spp = spp;
  still.threads = 2;
  return render_still(walls, solution, camera, still, {}, interrupt);
}

const char* kScreen =
    R"({"name": "s", "material": "screen", "quad": {"corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]}})";

TEST_F(TexturedRooms, StillsShowTheImageWhateverTheZones) {
  // 2 atan(2/4): the screen fills the picture, 4 pixels a check.
  const StillImage image = look_at_checks(folder_, kScreen, {2, 2, 4}, {2, 2, 0}, 2 * 26.565051177, 16, 16);
  for (int j = 0; j < kChecks; ++j)
    for (int i = 0; i < kChecks; ++i)
      for (const int inside : {1, 2}) {
        const std::size_t pixel = static_cast<std::size_t>((4 * j + inside) * 16 + 4 * i + inside);
        EXPECT_NEAR(image.radiance[pixel], is_white(i, kChecks - 1 - j) ? 1 : 0, 1e-5) << i << " " << j;
      }
}

TEST_F(TexturedRooms, StillsShowTheImageInAMirror) {
  const std::string objects = std::string(kScreen) +
                              R"(, {"name": "m", "material": "mirror",
                                   "quad": {"corner": [-20, -20, 3], "u": [0, 40, 0], "v": [40, 0, 0]}})";
  // The eye looks up into the mirror; the image of the screen lies at z = 6, 4 before it.
  const StillImage image = look_at_checks(folder_, objects, {2, 2, 2}, {2, 2, 3}, 2 * 26.565051177, 16, 16);
  int wrong = 0;
  for (int j = 0; j < kChecks; ++j)
    for (int i = 0; i < kChecks; ++i) {
      const std::size_t pixel = static_cast<std::size_t>((4 * j + 1) * 16 + 4 * i + 1);
      // Seen from behind, so right is -x.
      if (std::abs(image.radiance[pixel] - (is_white(kChecks - 1 - i, kChecks - 1 - j) ? 1 : 0)) > 1e-5)
        ++wrong;
    }
  EXPECT_EQ(wrong, 0);
}

TEST_F(TexturedRooms, FineImagesAreAveragedOverPixels) {
  // 64 checks a pixel and 16 rays: each would see black or white.
  const StillImage image =
      look_at_checks(folder_, kScreen, {2, 2, 4}, {2, 2, 0}, 2 * 26.565051177, 8, 16, "16");
  double squares = 0;
  for (const float value : image.radiance) {
    EXPECT_NEAR(value, 0.5F, 0.12F);
    squares += std::pow(static_cast<double>(value) - 0.5, 2) / 64;
  }
  EXPECT_LT(std::sqrt(squares), 0.05) << "unfiltered rays: sqrt(1/4 / 16) = 0.125";
}

}  // namespace
}  // namespace reemit
