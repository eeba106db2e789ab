#include "viewer_export/still/default_cameras.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace reemit {
namespace {

using std::numbers::pi;

constexpr int kSize = 640;                 // [px], width; the height is 3/4 of it
constexpr double kFovDeg = 60;             // vertical
constexpr int kGridSteps = 9;              // eyes along each horizontal side of the bounding box
constexpr int kAzimuths = 24;              // directions of view tried from each eye
constexpr int kSurroundRays = 96;          // rays that tell whether an eye stands in free space
constexpr double kLeastClearance = 0.04;   // of the box diagonal: nothing is closer to an eye
constexpr double kMostWrongSides = 0.005;  // share of surrounding rays that may meet backs of faces
constexpr double kLeastEnclosed = 0.3;     // share of surrounding rays that must meet the room at all
constexpr std::size_t kMostCameras = 3;
constexpr double kMostlyDown =
    0.8;  // part of the emission that leaves downwards if luminaires tell which way is up

struct View {
  Vec3 eye;
  Vec3 direction;  // unit
  double depth;    // mean distance seen [m]
};

/// Twice the area of a face times its normal.
Vec3 doubled_area_vector(const Surface& surface, const Face& face) {
  Vec3 sum(0, 0, 0);
  const Vec3& origin = surface.positions[face.outer.front()];
  for (std::size_t i = 1; i + 1 < face.outer.size(); ++i) {
    sum += (surface.positions[face.outer[i]] - origin).cross(surface.positions[face.outer[i + 1]] - origin);
  }
  return sum;
}

/// Mean of the normals of emitting faces, weighted by power: of unit length if all look the same way.
Vec3 mean_emission_direction(const Scene& scene) {
  Vec3 sum(0, 0, 0);
  double total = 0;
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.material_of(surface);
    if (!material.emits()) continue;
    for (const Face& face : surface.faces) {
      const Vec3 weighted = material.emitted_radiance.sum() * doubled_area_vector(surface, face);
      total += weighted.norm();
      if (!material.emits_both_sides) sum += weighted;
    }
    for (const CurvedShape& shape : surface.shapes) {  // all but disks emit to all sides alike
      const double power = material.emitted_radiance.sum() * 2 * shape_area(shape);
      total += power;
      const auto* disk = std::get_if<Disk>(&shape);
      if (disk != nullptr && !material.emits_both_sides) sum += power * disk->normal;
    }
  }
  return total > 0 ? Vec3(sum / total) : Vec3(0, 0, 0);
}

/// Box and axes of the room; a and b are level, up is up.
struct Frame {
  Vec3 min, max;
  Vec3 up, a, b;

  double diagonal() const { return (max - min).norm(); }
  Vec3 direction(double azimuth, double elevation) const {
    return std::cos(elevation) * (std::cos(azimuth) * a + std::sin(azimuth) * b) + std::sin(elevation) * up;
  }
};

Frame frame_of(const Scene& scene, const ZoneMesh& mesh) {
  Frame frame;
  frame.up = up_direction(scene);
  frame.a = frame.up.y() > 0.5 ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
  frame.b = frame.a.cross(frame.up);
  frame.min.setConstant(std::numeric_limits<double>::infinity());
  frame.max = -frame.min;
  for (const BaseTriangle& triangle : mesh.base().triangles) {
    for (const std::uint32_t v : triangle.vertex) {
      frame.min = frame.min.cwiseMin(mesh.base().vertices[v]);
      frame.max = frame.max.cwiseMax(mesh.base().vertices[v]);
    }
  }
  return frame;
}

enum class Seen { kNothing, kFront, kBack };

struct Sight {
  Seen seen;
  double distance;  // [m]
};

Sight look(const RayScene& rays, const Vec3& eye, const Vec3& direction) {
  Hit hit;
  if (!rays.closest(rays.normalised(eye), direction.cast<float>().normalized(), hit))
    return {Seen::kNothing, 0};
  const bool right_side = hit.front || rays.mesh().triangle(hit.triangle).two_sided;
  return {right_side ? Seen::kFront : Seen::kBack, hit.distance * rays.metres_per_unit()};
}

bool stands_free(const RayScene& rays, const Frame& frame, const Vec3& eye) {
  int enclosed = 0;
  int wrong_sides = 0;
  for (int i = 0; i < kSurroundRays; ++i) {
    // Directions on a spherical Fibonacci lattice: even cover with any number of them.
    const double elevation = std::asin(1 - (2.0 * i + 1) / kSurroundRays);
    const double azimuth = 2 * pi * std::fmod(i * (std::numbers::phi - 1), 1.0);
    const Sight sight = look(rays, eye, frame.direction(azimuth, elevation));
    if (sight.seen == Seen::kNothing) continue;
    if (sight.distance < kLeastClearance * frame.diagonal()) return false;
    ++enclosed;
    if (sight.seen == Seen::kBack) ++wrong_sides;
  }
  return enclosed >= kLeastEnclosed * kSurroundRays && wrong_sides <= kMostWrongSides * kSurroundRays;
}

/// Mean distance over the field of view; what is not there, or turns its back, counts as no distance.
double depth_of_view(const RayScene& rays, const Frame& frame, const Vec3& eye, double azimuth) {
  constexpr int kColumns = 8;
  constexpr int kRows = 6;
  const double half_height = kFovDeg / 2 * pi / 180;
  double sum = 0;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const double across = ((x + 0.5) / kColumns * 2 - 1) * half_height * 4 / 3;
      const double upwards = ((y + 0.5) / kRows * 2 - 1) * half_height;
      const Sight sight = look(rays, eye, frame.direction(azimuth + across, upwards));
      if (sight.seen == Seen::kFront) sum += sight.distance;
    }
  }
  return sum / (kColumns * kRows);
}

/// Heights of eyes as shares of the height of the room: a standing person where the room is made for one.
std::vector<double> eye_heights(const Frame& frame) {
  constexpr double kStanding = 1.6;  // [m]
  const double height = (frame.max - frame.min).dot(frame.up);
  if (height >= 2 && height <= 5) return {kStanding / height};
  return {0.35, 0.5, 0.65};
}

std::vector<View> candidate_views(const RayScene& rays, const Frame& frame) {
  std::vector<View> views;
  const Vec3 size = frame.max - frame.min;
  for (const double height : eye_heights(frame)) {
    for (int i = 0; i < kGridSteps; ++i) {
      for (int j = 0; j < kGridSteps; ++j) {
        const Vec3 share = height * frame.up + ((i + 0.5) / kGridSteps) * frame.a.cwiseAbs() +
                           ((j + 0.5) / kGridSteps) * frame.b.cwiseAbs();
        const Vec3 eye = frame.min + share.cwiseProduct(size);
        if (!stands_free(rays, frame, eye)) continue;
        for (int k = 0; k < kAzimuths; ++k) {
          const double azimuth = 2 * pi * k / kAzimuths;
          views.push_back({eye, frame.direction(azimuth, 0), depth_of_view(rays, frame, eye, azimuth)});
        }
      }
    }
  }
  return views;
}

/// Views by falling depth; each further one turns away from all before it and stands elsewhere.
std::vector<View> choose_views(const std::vector<View>& candidates, const Frame& frame) {
  const double most_alike = std::cos(70 * pi / 180);
  std::vector<View> chosen;
  while (chosen.size() < kMostCameras) {
    const View* best = nullptr;
    for (const View& view : candidates) {
      const bool differs = std::all_of(chosen.begin(), chosen.end(), [&](const View& other) {
        return view.direction.dot(other.direction) < most_alike &&
               (view.eye - other.eye).norm() > 0.15 * frame.diagonal();
      });
      if (differs && view.depth > 0 && (best == nullptr || view.depth > best->depth)) best = &view;
    }
    if (best == nullptr) break;
    chosen.push_back(*best);
  }
  return chosen;
}

/// The whole room from outside, from the side its largest triangle faces.
View outside_view(const ZoneMesh& mesh, const Frame& frame) {
  TriangleId largest(0);
  for (std::size_t t = 1; t < mesh.triangle_count(); ++t) {
    if (mesh.triangle_area(TriangleId(t)) > mesh.triangle_area(largest)) largest = TriangleId(t);
  }
  const Vec3 normal = mesh.triangle_normal(largest);
  const double distance = frame.diagonal();
  return {0.5 * (frame.min + frame.max) + distance * normal, -normal, distance};
}

Camera camera_of(const View& view, const Vec3& up, std::size_t number) {
  Camera camera;
  camera.name = fmt::format("auto-{}", number);
  camera.eye = view.eye;
  camera.look_at = view.eye + view.depth * view.direction;
  camera.up = std::abs(view.direction.dot(up)) < 0.99 ? up : Vec3(up.z(), up.x(), up.y());
  camera.vertical_fov_deg = kFovDeg;
  camera.width = kSize;
  camera.height = kSize * 3 / 4;
  return camera;
}

}  // namespace

Vec3 up_direction(const Scene& scene) {
  std::string extension = std::filesystem::path(scene.source).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".mgf" || extension == ".obj") {
    const Vec3 flow = mean_emission_direction(scene);
    if (flow.y() < -kMostlyDown) return Vec3::UnitY();
    if (flow.z() < -kMostlyDown) return Vec3::UnitZ();
  }
  return extension == ".mgf" ? Vec3::UnitZ() : Vec3::UnitY();
}

std::vector<Camera> default_cameras(const Scene& scene, const RayScene& rays) {
  const Frame frame = frame_of(scene, rays.mesh());
  std::vector<View> views = choose_views(candidate_views(rays, frame), frame);
  if (views.empty()) views.push_back(outside_view(rays.mesh(), frame));
  std::vector<Camera> cameras;
  for (const View& view : views) cameras.push_back(camera_of(view, frame.up, cameras.size() + 1));
  return cameras;
}

}  // namespace reemit
