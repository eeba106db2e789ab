// The rooms that are shipped: they read without warnings, their fronts look into the room, and their cameras
// stand in free space.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/surface_geometry.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/cie_1931.h"
#include "scenes/model/colour.h"
#include "tests/scenes/io/library_folder.h"

namespace reemit {
namespace {

using test::kLibrary;

Scene read_room(const std::string& name) {
  return read_scene(kLibrary / (name + ".json"));
}

class LibraryRoom : public testing::TestWithParam<const char*> {};

TEST_P(LibraryRoom, ReadsWithoutWarnings) {
  const Scene scene = read_room(GetParam());
  EXPECT_THAT(scene.warnings, testing::IsEmpty());
  EXPECT_FALSE(scene.name.empty());
  EXPECT_GE(scene.cameras.size(), 3u);
}

TEST_P(LibraryRoom, CamerasStandInside) {
  const Scene scene = read_room(GetParam());
  Box box = bounds(scene);
  if (std::string(GetParam()).starts_with("sphereflake"))  // Nothing is above the flake.
    box.max.y() = std::numeric_limits<double>::infinity();
  for (const Camera& camera : scene.cameras) {
    if (camera.name == "published") continue;  // Looks into the Cornell box through its open front.
    EXPECT_TRUE((camera.eye.array() > box.min.array()).all() && (camera.eye.array() < box.max.array()).all())
        << camera.name;
  }
}

bool inside_loop(const Surface& surface, const std::vector<std::uint32_t>& loop, const Vec3& point, int u,
                 int v) {
  bool inside = false;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    const Vec3& a = surface.positions[loop[i]];
    const Vec3& b = surface.positions[loop[j]];
    if ((a[v] > point[v]) == (b[v] > point[v])) continue;
    if (point[u] < a[u] + (point[v] - a[v]) / (b[v] - a[v]) * (b[u] - a[u])) inside = !inside;
  }
  return inside;
}

/// Nearest face along a ray, tested polygon by polygon.
struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  bool front = false;
};

void intersect(const Surface& surface, const Face& face, const Vec3& eye, const Vec3& direction,
               Hit& nearest) {
  Vec3 normal = Vec3::Zero();
  const Vec3& origin = surface.positions[face.outer[0]];
  for (std::size_t i = 1; i + 1 < face.outer.size(); ++i) {
    normal +=
        (surface.positions[face.outer[i]] - origin).cross(surface.positions[face.outer[i + 1]] - origin);
  }
  const double slope = normal.dot(direction);
  const double distance = normal.dot(origin - eye) / slope;
  if (!(distance > 0 && distance < nearest.distance)) return;
  int largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  const int u = (largest + 1) % 3, v = (largest + 2) % 3;
  const Vec3 point = eye + distance * direction;
  if (!inside_loop(surface, face.outer, point, u, v)) return;
  for (const auto& hole : face.holes) {
    if (inside_loop(surface, hole, point, u, v)) return;
  }
  nearest = {distance, slope < 0};
}

void intersect(const Sphere& sphere, const Vec3& eye, const Vec3& direction, Hit& nearest) {
  const Vec3 to_centre = sphere.centre - eye;
  const double middle = direction.dot(to_centre);
  const double half2 = sphere.radius * sphere.radius - (to_centre - middle * direction).squaredNorm();
  if (half2 < 0) return;
  const bool outside = to_centre.norm() > sphere.radius;
  const double distance = middle + (outside ? -1 : 1) * std::sqrt(half2);
  if (distance > 0 && distance < nearest.distance) nearest = {distance, outside != sphere.inward};
}

TEST_P(LibraryRoom, CamerasSeeFrontsInEveryDirection) {
  const Scene scene = read_room(GetParam());
  const std::string name = GetParam();
  const bool open = name.starts_with("cornell") || name.starts_with("sphereflake") ||
                    name == "hundred_panels" || name == "daylight_room";
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr int kRays = 400;  // Per camera.
  int rays = 0, misses = 0, backs = 0;
  for (const Camera& camera : scene.cameras) {
    for (int i = 0; i < kRays; ++i) {
      const double x = normal(random), y = normal(random), z = normal(random);
      const Vec3 direction = Vec3(x, y, z).normalized();
      Hit hit;
      for (const Surface& surface : scene.surfaces) {
        for (const Face& face : surface.faces) intersect(surface, face, camera.eye, direction, hit);
        for (const CurvedShape& shape : surface.shapes) {
          if (const auto* sphere = std::get_if<Sphere>(&shape))
            intersect(*sphere, camera.eye, direction, hit);
        }
      }
      ++rays;
      misses += std::isinf(hit.distance);
      backs += !std::isinf(hit.distance) && !hit.front && camera.name != "published";
    }
  }
  if (!open) {
    EXPECT_EQ(misses, 0);
  }
  // Sheets such as leaves, slats and the inside of a mug are seen from behind; a wall must never be.
  EXPECT_LT(backs, rays / 100);
}

INSTANTIATE_TEST_SUITE_P(All, LibraryRoom,
                         testing::Values("cornell_box", "cornell_box_empty", "cornell_box_spectral",
                                         "furnace_box", "two_rooms", "office", "gallery", "hundred_panels",
                                         "sphereflake", "sphereflake_one_lamp", "daylight_room", "cove"));

TEST(Library, EveryRoomIsTested) {
  std::size_t rooms = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kLibrary))
    rooms += entry.path().extension() == ".json";
  EXPECT_EQ(rooms, 12u);  // Those above.
}

TEST(Library, CornellBoxIsThePublishedOne) {
  const Scene scene = read_room("cornell_box");
  const auto surface = [&](const std::string& name) -> const Surface& {
    const auto it = std::find_if(scene.surfaces.begin(), scene.surfaces.end(),
                                 [&](const Surface& s) { return s.name == name; });
    EXPECT_NE(it, scene.surfaces.end()) << name;
    return *it;
  };
  EXPECT_NEAR(surface_area(surface("lamp")), 0.130 * 0.105, 1e-12);
  EXPECT_NEAR(surface_area(surface("ceiling")), 0.556 * 0.5592 - 0.130 * 0.105, 1e-12);
  EXPECT_NEAR(surface_area(surface("right wall")), 0.5592 * 0.5488, 1e-12);
  // The left wall is left as published: its fourth vertex is 3.2 mm off the plane of the others.
  const auto& left = surface("left wall").positions;
  const Vec3 normal = (left[1] - left[0]).cross(left[2] - left[0]).normalized();
  EXPECT_NEAR(std::abs(normal.dot(left[3] - left[0])), 3.2e-3, 1e-6);
  EXPECT_NEAR(scene.cameras[0].vertical_fov_deg, 2 * std::atan(12.5 / 35) * 180 / std::numbers::pi, 1e-4);
  const Material& lamp = scene.material_of(surface("lamp"));
  EXPECT_FALSE(lamp.emits_both_sides);
  EXPECT_NEAR((lamp.emitted_radiance * scene.bands.efficacy_lm_per_w()).sum(), 10000, 1);
}

double interpolated(const std::vector<double>& nm, const std::vector<double>& value, double at) {
  const auto upper = std::upper_bound(nm.begin(), nm.end(), at);
  if (upper == nm.end()) return value.back();
  const auto i = static_cast<std::size_t>(upper - nm.begin());
  return value[i - 1] + (at - nm[i - 1]) / (nm[i] - nm[i - 1]) * (value[i] - value[i - 1]);
}

TEST(Library, CornellColoursFollowFromTheMeasuredSpectra) {
  std::ifstream file(kLibrary / "data" / "cornell_measured.json");
  const auto data = nlohmann::json::parse(file);
  const auto curve = [&](const nlohmann::json& at) { return at.get<std::vector<double>>(); };
  const auto nm = curve(data["reflectance"]["nm"]);
  const auto colour = [&](const std::vector<double>* reflectance) {
    Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
    constexpr double kStep = 0.05;  // [nm]; midpoints
    for (double at = 400 + kStep / 2; at < 700; at += kStep) {
      const double light = interpolated(curve(data["lamp"]["nm"]), curve(data["lamp"]["value"]), at);
      xyz += cie_1931(at) * (light * (reflectance ? interpolated(nm, *reflectance, at) : 1.0));
    }
    return Eigen::Array3d(xyz_to_rec709() * xyz);
  };
  const Eigen::Array3d bare = colour(nullptr);
  const Scene scene = read_room("cornell_box");
  for (const Material& material : scene.materials) {
    if (material.name == "lamp") {
      EXPECT_NEAR(material.emitted_radiance[0] / material.emitted_radiance[1], bare[0] / bare[1], 1e-4);
      EXPECT_NEAR(material.emitted_radiance[2] / material.emitted_radiance[1], bare[2] / bare[1], 1e-4);
      continue;
    }
    const auto measured = curve(data["reflectance"][material.name]);
    EXPECT_LT((material.reflectance - colour(&measured) / bare).abs().maxCoeff(), 1e-4) << material.name;
  }
}

TEST(Library, SpectralCornellBoxHasTheSameLamp) {
  const Scene scene = read_room("cornell_box_spectral");
  ASSERT_EQ(scene.bands.count(), 15u);
  const auto lamp = std::find_if(scene.materials.begin(), scene.materials.end(),
                                 [](const Material& m) { return m.emits(); });
  ASSERT_NE(lamp, scene.materials.end());
  EXPECT_NEAR((lamp->emitted_radiance * scene.bands.efficacy_lm_per_w()).sum(), 10000, 1e-6);
  // 600-620 nm holds the mean of 15.6 + 0.028 (nm - 600), 400-420 that of 0.08 (nm - 400).
  EXPECT_NEAR(lamp->emitted_radiance[10] / lamp->emitted_radiance[0], 15.88 / 0.8, 1e-9);
}

TEST(Library, FurnaceEmitsPi) {
  const Scene scene = read_room("furnace_box");
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.reflectance[0], 0.5);
  EXPECT_EQ(material.emitted_radiance[0], 1);
}

std::size_t luminaires_of(const Scene& scene) {
  std::size_t count = scene.lights.size();
  for (const Surface& surface : scene.surfaces) count += scene.material_of(surface).emits();
  return count;
}

TEST(Library, GalleryHasManyLuminaires) {
  EXPECT_EQ(luminaires_of(read_room("gallery")), 100u);
}

TEST(Library, HundredPanelsDifferWidely) {
  const Scene scene = read_room("hundred_panels");
  EXPECT_EQ(luminaires_of(scene), 100u);
  double weakest = std::numeric_limits<double>::infinity(), strongest = 0;
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.material_of(surface);
    if (!material.emits()) continue;
    const double flux =
        surface_area(surface) * (material.emitted_radiance * scene.bands.efficacy_lm_per_w()).sum();
    weakest = std::min(weakest, flux);
    strongest = std::max(strongest, flux);
  }
  EXPECT_GT(strongest, 1e4 * weakest);
}

TEST(Library, SphereflakesHaveFourGenerations) {
  struct Spheres {
    std::size_t all = 0;
    std::size_t luminous = 0;
    double flux_lm = 0;
  };
  const auto spheres_of = [](const Scene& scene) {
    Spheres sum;
    for (const Surface& surface : scene.surfaces) {
      for (const CurvedShape& shape : surface.shapes) {
        if (!std::holds_alternative<Sphere>(shape)) continue;
        const Material& material = scene.material_of(surface);
        ++sum.all;
        sum.luminous += material.emits();
        sum.flux_lm += shape_area(shape) * (material.exitance() * scene.bands.efficacy_lm_per_w()).sum();
      }
    }
    return sum;
  };
  const Scene every = read_room("sphereflake"), one = read_room("sphereflake_one_lamp");
  const Spheres of_every = spheres_of(every), of_one = spheres_of(one);
  EXPECT_EQ(of_every.all, 1u + 9 + 81 + 729 + 6561);
  EXPECT_EQ(of_every.luminous, 7381u);
  EXPECT_EQ(of_one.all, 7381u);
  EXPECT_EQ(of_one.luminous, 1u);
  EXPECT_NEAR(of_every.flux_lm, 4000, 1e-3);
  EXPECT_NEAR(of_one.flux_lm, 4000, 1e-3);
  // The same spheres in the same places.
  ASSERT_EQ(every.surfaces.size(), one.surfaces.size());
  for (std::size_t i = 0; i < every.surfaces.size(); ++i) {
    ASSERT_EQ(every.surfaces[i].name, one.surfaces[i].name);
    ASSERT_EQ(every.surfaces[i].shapes.size(), one.surfaces[i].shapes.size());
    for (std::size_t k = 0; k < every.surfaces[i].shapes.size(); ++k) {
      EXPECT_EQ(shape_bounds(every.surfaces[i].shapes[k]), shape_bounds(one.surfaces[i].shapes[k]));
    }
  }
}

}  // namespace
}  // namespace reemit
