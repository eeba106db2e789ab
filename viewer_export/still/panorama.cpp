#include "viewer_export/still/panorama.h"

#include <cmath>
#include <map>
#include <numbers>

namespace reemit {
namespace {

constexpr float kPanoramaStep = std::numbers::pi_v<float> / 30;  // 6 degrees
constexpr int kViewColumns = 13;                                 // 78 degrees
/// Pieces of surface are lit as a whole: large ones, for packets are few.
constexpr float kLitCell = 0.5F;  // of the width of the lit space

/// Which of the six axes a unit vector is nearest to.
std::uint64_t facing(const Vec3f& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0 ? 1 : 0));
}

template <class Visit>
void for_view(const Panorama& panorama, int column, const Visit& visit) {
  for (int c = 0; c < kViewColumns; ++c) {
    const int at = (column + c - kViewColumns / 2 + Panorama::kColumns) % Panorama::kColumns;
    for (int r = 0; r < Panorama::kRows; ++r)
      visit(panorama.sights[static_cast<std::size_t>(at) * Panorama::kRows + static_cast<std::size_t>(r)]);
  }
}

}  // namespace

RoomAxes::RoomAxes(const Vec3& up_direction) : up(up_direction.cast<float>()) {
  a = up.y() > 0.5F ? Vec3f(0, 0, -1) : Vec3f(0, 1, 0);
  b = a.cross(up);
}

Vec3f RoomAxes::direction(float azimuth, float elevation) const {
  return std::cos(elevation) * (std::cos(azimuth) * a + std::sin(azimuth) * b) + std::sin(elevation) * up;
}

LitCells::LitCells(const SurfaceModel& surfaces, const LitSpace& space) : size_(kLitCell * space.width) {
  for (std::size_t s = 0; s < surfaces.surface_count(); ++s) emits_.push_back(surfaces.emits(SurfaceId(s)));
  for (std::size_t i = 0; i < space.lit_points.size(); ++i)
    lit_.insert(cell(space.lit_points[i], space.lit_normals[i]));
}

std::uint64_t surface_cell(const Vec3f& point, const Vec3f& normal, float size) {
  constexpr std::int64_t kMiddle = 1 << 19;
  std::uint64_t number = facing(normal);
  for (int k = 0; k < 3; ++k) {
    // Half a cell is added so that walls at 0, a common place, do not lie between two cells.
    const auto place = static_cast<std::int64_t>(std::floor(point[k] / size + 0.5F));
    number = number << 20 | static_cast<std::uint64_t>((place + kMiddle) & 0xfffff);
  }
  return number;
}

Panorama look_around(const RayTracer& rays, const RoomAxes& axes, const LitCells& lit, float cell,
                     const Vec3f& eye) {
  Panorama panorama;
  panorama.eye = eye;
  panorama.sights.resize(static_cast<std::size_t>(Panorama::kColumns) * Panorama::kRows);
  for (int c = 0; c < Panorama::kColumns; ++c)
    for (int r = 0; r < Panorama::kRows; ++r) {
      const float azimuth = (static_cast<float>(c) + 0.5F) * kPanoramaStep;
      const float elevation = (static_cast<float>(r) + 0.5F - 0.5F * Panorama::kRows) * kPanoramaStep;
      const Vec3f direction = axes.direction(azimuth, elevation).normalized();
      Hit hit;
      if (!rays.closest_for_camera(eye, direction, hit)) continue;
      Sight& sight =
          panorama.sights[static_cast<std::size_t>(c) * Panorama::kRows + static_cast<std::size_t>(r)];
      Vec3f normal = rays.normal(hit.triangle, hit.u, hit.v);
      if (!hit.front) normal = -normal;
      sight.distance = hit.distance;
      const Vec3f point = eye + hit.distance * direction;
      sight.cell = surface_cell(point, normal, cell);
      sight.area = lit.cell(point, normal);
      const SurfaceId surface = rays.mesh().surface(hit.triangle, hit.front);
      sight.part = 6 * static_cast<std::uint64_t>(surface.index()) + facing(normal);
      sight.lit = lit.is_lit(sight.area, surface);
    }
  return panorama;
}

ViewContent content_of(const Panorama& panorama, int column, float near,
                       const std::unordered_set<std::uint64_t>& known) {
  constexpr double kShare = 1.0 / (kViewColumns * Panorama::kRows);
  ViewContent content;
  std::map<std::uint64_t, double> parts;
  std::unordered_set<std::uint64_t> cells;
  for_view(panorama, column, [&](const Sight& sight) {
    content.open += kShare * (sight.distance > 0 ? std::min(1.0F, sight.distance / near) : 1.0F);
    if (!(sight.distance > 0)) return;
    content.seen += kShare;
    if (sight.lit) content.lit += kShare;
    parts[sight.part] += kShare;
    if (!known.contains(sight.area)) content.novelty += kShare;
    cells.insert(sight.cell);
  });
  if (cells.empty()) return content;
  content.extent = kShare * static_cast<double>(cells.size());
  double entropy = 0;
  for (const auto& [part, share] : parts) entropy -= share / content.seen * std::log(share / content.seen);
  content.variety = std::exp(entropy);
  return content;
}

void add_areas(const Panorama& panorama, int column, std::unordered_set<std::uint64_t>& known) {
  for_view(panorama, column, [&](const Sight& sight) {
    if (sight.distance > 0) known.insert(sight.area);
  });
}

}  // namespace reemit
