#include "solver/gather/caustic_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <tbb/parallel_for.h>

namespace reemit {
namespace {

constexpr std::uint32_t kProbe = 1U << 15;
constexpr double kLeastPackets = 1U << 18, kMostPackets = 1U << 23;
constexpr double kWantedPhotons = 800'000;
constexpr double kPilotShare = 0.25;
/// Batches of the probe and the pilot; those of the parts are 0, 1, ...
constexpr std::uint32_t kProbeBatch = 1U << 20, kPilotBatch = kProbeBatch + 1;

// Where gathers and photons are compared: rays that a point may be expected to get, radius of the kernel.
constexpr double kTypicalRays = 256;

constexpr double kTypicalRadius = 0.3 * static_cast<double>(CausticMap::kLargestRadius);

/// Rays along a face look for what stands on it at this share of the radius above it.
constexpr float kLift = 0.1F;

/// Least cosine between normals of points of one face, or of faces that go on about as each other do.
constexpr float kSameSide = 0.8F;

float kernel(float squared_distance, float radius) {
  const float r2 = radius * radius;
  return 2 / (std::numbers::pi_v<float> * r2) * (1 - squared_distance / r2);
}

}  // namespace

CausticMap::CausticMap(const Room& room, std::size_t parts, std::uint64_t seed, const StopToken* stop)
    : room_(&room), left_to_rays_(room.surfaces().surface_count(), 1.0F) {
  if (!room.surfaces().any_specular()) return;
  const CausticShooter shooter(room, seed);
  const std::size_t probed = shooter.shoot(kProbe, kProbeBatch, stop).size();
  if (probed == 0) return;
  const double packets =
      std::clamp(kWantedPhotons * kProbe / static_cast<double>(probed), kLeastPackets, kMostPackets);
  const std::vector<float> density = shooter.density_of_surfaces(packets);
  for (std::size_t s = 0; s < density.size(); ++s) {
    const double photons =
        static_cast<double>(density[s]) * std::numbers::pi * kTypicalRadius * kTypicalRadius;
    left_to_rays_[s] = static_cast<float>(kTypicalRays / (kTypicalRays + photons));
  }
  pilot_ = of_pilot(shooter.shoot(static_cast<std::uint32_t>(kPilotShare * packets), kPilotBatch, stop));
  pilot_target_ = static_cast<float>(kPilotShare * kPhotons);
  parts_.resize(parts);
  for (std::size_t p = 0; p < parts; ++p)
    parts_[p].all = shooter.shoot(static_cast<std::uint32_t>(packets / static_cast<double>(parts)),
                                  static_cast<std::uint32_t>(p), stop);
  tbb::parallel_for(std::size_t{0}, parts,
                    [&](std::size_t p) { parts_[p] = of_part(std::move(parts_[p].all), stop); });
}

CausticMap::Photons CausticMap::of_pilot(CausticPhotons photons) const {
  Photons result{std::move(photons), {}, {}, {}};
  std::vector<std::uint32_t> all(result.all.size());
  std::iota(all.begin(), all.end(), 0U);
  for (std::size_t level = 0; level < kLevels; ++level)
    result.grids[level] = PhotonGrid(result.all.places, all, 2 * radius_of(level));
  return result;
}

CausticMap::Photons CausticMap::of_part(CausticPhotons photons, const StopToken* stop) const {
  Photons result{std::move(photons), {}, {}, {}};
  result.radius.resize(result.all.size());
  result.beside_wall.resize(result.all.size());
  tbb::parallel_for(std::size_t{0}, result.all.size(), [&](std::size_t i) {
    if (stop != nullptr && stop->requested()) return;  // with a radius of 0 it is not counted
    const Vec3f& normal = result.all.normals[i];
    const Vec3f& place = result.all.places[i];
    result.radius[i] = radius_at(normal, place);
    result.beside_wall[i] = is_beside_wall(normal, place, result.radius[i]) ? 1 : 0;
  });
  std::array<std::vector<std::uint32_t>, kLevels> of_level;
  for (std::uint32_t i = 0; i < result.radius.size(); ++i) {
    std::size_t level = 0;
    while (level + 1 < kLevels && radius_of(level + 1) >= result.radius[i]) ++level;
    of_level[level].push_back(i);
  }
  for (std::size_t level = 0; level < kLevels; ++level)
    result.grids[level] = PhotonGrid(result.all.places, of_level[level], 2 * radius_of(level));
  return result;
}

bool CausticMap::counts(const Photons& photons, std::uint32_t i, const Vec3f& normal, const Vec3f& place,
                        float radius) {
  constexpr float kFlat = 0.15F;
  return photons.all.normals[i].dot(normal) > kSameSide &&
         std::fabs((photons.all.places[i] - place).dot(normal)) < kFlat * radius;
}

float CausticMap::radius_at(const Vec3f& normal, const Vec3f& place) const {
  for (std::size_t level = kLevels; level-- > 0;) {
    const float radius = radius_of(level);
    float found = 0;
    pilot_.grids[level].visit(place, radius, [&](std::uint32_t i, float d2) {
      if (counts(pilot_, i, normal, place, radius)) found += 2 * (1 - d2 / (radius * radius));
    });
    if (found >= pilot_target_) return radius * std::sqrt(pilot_target_ / found);
  }
  return kLargestRadius;
}

bool CausticMap::is_beside_wall(const Vec3f& normal, const Vec3f& place, float radius) const {
  constexpr int kDirections = 8;
  const Frame frame(normal);
  const Vec3f from = place + kLift * radius * normal;
  for (int k = 0; k < kDirections; ++k) {
    const float phi = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / kDirections;
    const Vec3f to = from + radius * frame.to_world({std::cos(phi), std::sin(phi), 0});
    if (!room_->rays().visible(from, to)) return true;
  }
  return false;
}

bool CausticMap::is_inside_triangle(const SurfacePoint& x, float radius) const {
  const RayTracer& rays = room_->rays();
  if (x.triangle.index() >= room_->mesh().flat_count()) return false;
  const std::array<Vec3f, 3> corner{rays.point(x.triangle, 0, 0), rays.point(x.triangle, 1, 0),
                                    rays.point(x.triangle, 0, 1)};
  const float area2 = (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
  const std::array<float, 3> opposite{(corner[2] - corner[1]).norm(), (corner[2] - corner[0]).norm(),
                                      (corner[1] - corner[0]).norm()};
  const std::array<float, 3> barycentric{1 - x.u - x.v, x.u, x.v};
  for (std::size_t k = 0; k < 3; ++k)
    if (barycentric[k] * area2 < radius * opposite[k]) return false;
  return true;
}

float CausticMap::share_on_face(const SurfacePoint& x, const Vec3f& place, float radius, float turn) const {
  const RayTracer& rays = room_->rays();
  constexpr int kPoints = 12;
  const Frame frame(x.normal);
  const float lift = kLift * radius;
  const Vec3f from = place + lift * x.normal;
  int on_face = 0;
  for (int k = 0; k < kPoints; ++k) {
    // As the kernel weighs them, on a spiral.
    const float u = (static_cast<float>(k) + 0.5F) / kPoints;
    const float r = radius * std::sqrt(1 - std::sqrt(1 - u));
    const float phi =
        2 * std::numbers::pi_v<float> * (turn + static_cast<float>(k) * (std::numbers::phi_v<float> - 1));
    const Vec3f to = from + frame.to_world({r * std::cos(phi), r * std::sin(phi), 0});
    if (!rays.visible(from, to)) continue;
    Hit hit;
    if (rays.closest(to, -x.normal, hit) && hit.distance < 2.5F * lift &&
        side_normal(rays, hit.triangle, hit.u, hit.v, hit.front).dot(x.normal) > kSameSide)
      ++on_face;
  }
  return std::max(1.0F, static_cast<float>(on_face)) / kPoints;
}

void CausticMap::add_reflected(const SurfacePoint& at, std::size_t part, bool whole, float turn,
                               const BrdfValue& brdf, const float* weight, float* sum) const {
  if (!exists()) return;
  const Photons& photons = parts_[part % parts_.size()];
  if (photons.all.size() == 0) return;
  const RayTracer& rays = room_->rays();
  SurfacePoint x = at;
  x.normal = side_normal(rays, at);  // not that of the shading
  const Vec3f place = rays.point(x.triangle, x.u, x.v);
  const std::size_t bands = room_->band_count();
  const auto metres = static_cast<float>(rays.metres_per_unit());
  bool walled = false;
  float largest = 0;               // radius of photons found
  double count = 0, of_radii = 0;  // of them, as the kernel weighs them, and of their radii
  std::vector<float> found;        // by band
  for (std::size_t level = 0; level < kLevels; ++level)
    photons.grids[level].visit(place, radius_of(level), [&](std::uint32_t i, float d2) {
      const float radius = photons.radius[i];
      if (d2 >= radius * radius || !counts(photons, i, x.normal, place, radius)) return;
      if (photons.beside_wall[i] != 0) {
        walled = true;
        const Vec3f above = kLift * radius * x.normal;
        if (!rays.visible(place + above, photons.all.places[i] + above)) return;
      }
      if (found.empty()) found.assign(bands, 0.0F);
      const float share = whole ? 1 : 1 - left_to_rays(photons.all.luminaires[i]);
      const float per_unit = share * kernel(d2, radius);
      const float per_m2 = per_unit / (metres * metres);
      for (std::size_t b = 0; b < bands; ++b) found[b] += per_m2 * photons.all.power[i * bands + b];
      largest = std::max(largest, radius);
      count += static_cast<double>(per_unit);
      of_radii += static_cast<double>(per_unit) * static_cast<double>(radius);
    });
  if (!(count > 0)) return;
  const float face = !walled && is_inside_triangle(x, largest)
                         ? 1
                         : share_on_face(x, place, static_cast<float>(of_radii / count), turn);
  for (std::size_t b = 0; b < bands; ++b) sum[b] += weight[b] * brdf(b) * found[b] / face;
}

}  // namespace reemit
