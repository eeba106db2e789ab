#include "solver/sky/sky_survey.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "solver/trace/surface_point.h"

namespace reemit {
namespace {

constexpr std::uint64_t kSeed = 1;  // nothing of a solution should depend on it
constexpr std::uint32_t kFirstPoints = 1U << 16;
constexpr std::uint32_t kRaysOfFirst = 2;
constexpr std::uint32_t kSecondPoints = 1U << 15;
constexpr int kMostRays = 64;
constexpr std::uint32_t kSunPoints = 1U << 18;
/// Rays from the air of a cell, and from the air of one that sees little of the sky.
constexpr std::uint32_t kRaysInAir = 512;
constexpr std::uint32_t kMostRaysInAir = 2560;
/// Rays go through so much that lets light through.
constexpr int kMostCrossed = 16;

/// Points on the sides that have zones, evenly by area.
class PointsOfRoom {
 public:
  PointsOfRoom(const ZoneMesh& mesh, const RayTracer& rays) : rays_(rays) {
    const double metres2 = rays.metres_per_unit() * rays.metres_per_unit();
    double area = 0;
    for (std::size_t s = 0; s < mesh.side_count(); ++s) {
      const SideId side(s);
      if (!mesh.has_zones(side)) continue;
      area += mesh.triangle_area(triangle_of(side)) / metres2;
      sides_.push_back(side);
      until_.push_back(area);
    }
  }
  bool empty() const { return sides_.empty() || !(area() > 0); }
  double area() const { return until_.back(); }

  /// Point i of `count`; u moves it.
  SurfacePoint point(std::uint32_t i, std::uint32_t count, const std::array<float, 4>& u) const {
    const double at = (i + static_cast<double>(u[0])) / count * area();
    const auto above = std::upper_bound(until_.begin(), until_.end(), at);
    const auto k = std::min(static_cast<std::size_t>(above - until_.begin()), sides_.size() - 1);
    const auto [a, b] = sample_triangle(u[1], u[2]);
    return surface_point(rays_, triangle_of(sides_[k]), a, b, is_front(sides_[k]));
  }

 private:
  const RayTracer& rays_;
  std::vector<SideId> sides_;
  std::vector<double> until_;
};

bool lets_light_through(const SurfaceModel& surfaces, const Hit& hit) {
  if (!surfaces.any_specular() || !surfaces.is_specular(hit.triangle, hit.front)) return false;
  return surfaces.specular(hit.triangle).lets_light_through();
}

bool leaves(const RayTracer& rays, const SurfaceModel& surfaces, Vec3f from, const Vec3f& direction) {
  Hit hit;
  for (int crossed = 0; crossed <= kMostCrossed; ++crossed) {
    if (!rays.closest(from, direction, hit)) return true;
    if (!lets_light_through(surfaces, hit)) return false;
    from = rays.ray_origin(hit.triangle, hit.u, hit.v, !hit.front);
  }
  return false;
}

/// Points whose rays are traced in any order and looked at in theirs.
struct SurveyLook {
  Vec3f point, normal;
  int rays = 0;
  std::array<bool, kMostRays> left{};
  std::array<Vec3f, kMostRays> towards;
};

void look_out(const RayTracer& rays, const SurfaceModel& surfaces, const SurfacePoint& x,
              const CounterRng& rng, std::uint32_t index, std::uint32_t batch, SurveyLook& look) {
  const Vec3f origin = ray_origin(rays, x);
  const Frame frame(x.normal);
  for (int k = 0; k < look.rays; ++k) {
    const std::array<float, 4> u = rng.uniform4(index, batch, static_cast<std::uint32_t>(k + 1));
    const auto i = static_cast<std::size_t>(k);
    look.towards[i] = frame.to_world(
        sample_cosine_hemisphere((static_cast<float>(k) + u[0]) / static_cast<float>(look.rays), u[1]));
    look.left[i] = leaves(rays, surfaces, origin, look.towards[i]);
  }
}

/// From random points of a cell each way: a ray is of all ways to face from which it is drawn by cosine.
void look_from_air(const RayTracer& rays, const SurfaceModel& surfaces, const Eigen::Matrix3d& to_local,
                   const std::function<float(const Vec3f&)>& brightness, std::size_t cell, SkyView& view) {
  const CounterRng rng(kSeed, RngPurpose::kSkySurvey);
  constexpr std::uint32_t kBatch = 3;
  constexpr float kEdge = 2.0F / static_cast<float>(SkyView::kCells);
  const auto index = static_cast<std::uint32_t>(cell);
  std::uint32_t left = 0;
  for (std::uint32_t i = 0; i < kMostRaysInAir; ++i) {
    if (i == kRaysInAir && left > kRaysInAir / 20) return;
    const std::array<float, 4> u = rng.uniform4(index, kBatch, 2 * i);
    const std::array<float, 4> v = rng.uniform4(index, kBatch, 2 * i + 1);
    const Vec3f towards = sample_sphere(v[0], v[1]);
    const bool leaves_room =
        leaves(rays, surfaces, SkyView::corner_of(cell) + kEdge * Vec3f(u[0], u[1], u[2]), towards);
    if (leaves_room) ++left;
    const float bright = leaves_room ? brightness(towards) : 0;
    for (std::size_t facing = 0; facing < SkyView::kFacings; ++facing) {
      if (!(SkyView::normal_of(facing).dot(towards) > v[2])) continue;
      const std::uint32_t place = view.place_in_air(cell, facing);
      view.add_ray(place);
      if (leaves_room) view.add_escape(place, to_local * towards.cast<double>(), bright);
    }
  }
}

}  // namespace

void survey_sky(const ZoneMesh& mesh, const RayTracer& rays, const SurfaceModel& surfaces,
                const Eigen::Matrix3d& to_local, const std::function<float(const Vec3f&)>& brightness,
                SkyView& view, std::vector<SkySight>& sights) {
  const PointsOfRoom points(mesh, rays);
  const CounterRng rng(kSeed, RngPurpose::kSkySurvey);
  for (const std::uint32_t batch : {0U, 1U}) {
    const std::uint32_t count = points.empty() ? 0 : batch == 0 ? kFirstPoints : kSecondPoints;
    std::vector<SurveyLook> looks(count);
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count, 1024), [&](const auto& range) {
      for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
        const SurfacePoint x = points.point(i, count, rng.uniform4(i, batch, 0));
        SurveyLook& look = looks[i];
        look.point = rays.point(x.triangle, x.u, x.v);
        look.normal = x.normal;
        look.rays = kRaysOfFirst;
        const std::uint32_t place = batch == 0 ? SkyView::kUnknown : view.place_of(look.point, look.normal);
        if (place != SkyView::kUnknown)
          look.rays =
              std::clamp(static_cast<int>(0.5 / std::max(1e-3, view.open_share(place))), 1, kMostRays);
        look_out(rays, surfaces, x, rng, i, batch, look);
      }
    });
    // Both rounds stand for all of the area, each by the half.
    const double area = 0.5 * points.area() / count;
    for (const SurveyLook& look : looks) {
      const std::uint32_t place = view.add_place(look.point, look.normal);
      for (int k = 0; k < look.rays; ++k) {
        view.add_ray(place);
        const Vec3f& towards = look.towards[static_cast<std::size_t>(k)];
        if (!look.left[static_cast<std::size_t>(k)]) continue;
        view.add_escape(place, to_local * towards.cast<double>(), brightness(towards));
        sights.push_back({look.point, towards, place, static_cast<float>(area / look.rays)});
      }
    }
  }
  view.add_air();
  constexpr std::size_t kAirCells = SkyView::kCells * SkyView::kCells * SkyView::kCells;
  tbb::parallel_for(std::size_t{0}, kAirCells, [&](std::size_t cell) {
    look_from_air(rays, surfaces, to_local, brightness, cell, view);
  });
}

void survey_sun(const ZoneMesh& mesh, const RayTracer& rays, const SurfaceModel& surfaces,
                const std::function<Vec3f(float, float)>& sample, const SkyView& view,
                std::vector<SkySight>& sights) {
  const PointsOfRoom points(mesh, rays);
  if (points.empty()) return;
  const CounterRng rng(kSeed, RngPurpose::kSkySurvey);
  constexpr std::uint32_t kBatch = 2;
  std::vector<SkySight> all(kSunPoints);
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, kSunPoints, 1024), [&](const auto& range) {
    for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
      const SurfacePoint x = points.point(i, kSunPoints, rng.uniform4(i, kBatch, 0));
      const std::array<float, 4> u = rng.uniform4(i, kBatch, 1);
      SkySight& sight = all[i];
      sight.towards = sample(u[0], u[1]);
      sight.point = rays.point(x.triangle, x.u, x.v);
      sight.place = view.place_of(sight.point, x.normal);
      sight.area = 0;
      const float cosine = x.normal.dot(sight.towards);
      if (cosine > 0 && leaves(rays, surfaces, ray_origin(rays, x), sight.towards))
        sight.area = cosine * static_cast<float>(points.area() / kSunPoints);
    }
  });
  for (const SkySight& sight : all)
    if (sight.area > 0) sights.push_back(sight);
}

}  // namespace reemit
