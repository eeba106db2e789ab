#include "solver/gather/caustic_map.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <tbb/parallel_for.h>

#include "solver/gather/caustic_shots.h"

namespace reemit {
namespace {

// Where gathers and photons are compared: rays that a point may be expected to get, radius of the kernel.
constexpr double kTypicalRays = 256;

constexpr double kTypicalRadius = 0.3 * static_cast<double>(kLargestPhotonRadius);

}  // namespace

CausticMap::CausticMap(const Room& room, std::size_t parts, std::uint64_t seed, const CausticPackets* known,
                       const StopToken* stop, const PointsInAir& in_air)
    : room_(&room),
      ends_(FaceEnds(room.rays(), room.mesh().flat_count())),
      left_to_rays_(room.surfaces().surface_count(), 1.0F) {
  if (!room.surfaces().any_specular()) return;
  const CausticShooter shooter(room, seed);
  std::optional<AirSheets> sheets;
  if (!in_air.points.empty()) sheets.emplace(in_air.points, kPilotReach);
  CausticShots shots =
      sheets ? shoot_caustics(shooter, *sheets, in_air.rounds, stop) : shoot_caustics(shooter, known, stop);
  if (shots.packets == 0) return;
  const std::vector<float> density = shooter.density_of_surfaces(shots.packets);
  for (std::size_t s = 0; s < density.size(); ++s) {
    const double photons =
        static_cast<double>(density[s]) * std::numbers::pi * kTypicalRadius * kTypicalRadius;
    left_to_rays_[s] = static_cast<float>(kTypicalRays / (kTypicalRays + photons));
  }
  parts_.resize(parts);
  tbb::parallel_for(std::size_t{0}, parts,
                    [&](std::size_t p) { parts_[p] = of_part(mean_of_parts(shots.parts, p, parts)); });
  if (!sheets) return;
  std::vector<CausticPhotons> of_air;
  for (std::size_t p = 0; p < parts; ++p) of_air.push_back(mean_of_parts(shots.in_air, p, parts));
  air_ = AirPhotons(room, in_air.points, *sheets, std::move(of_air));
}

void CausticMap::add_irradiance(const MeasuringPoint& x, std::size_t part, const float* weight,
                                float* sum) const {
  air_.add_irradiance(x, part, left_to_rays_, weight, sum);
}

CausticMap::Photons CausticMap::of_part(CausticPhotons photons) {
  Photons result;
  result.all = std::move(photons);
  result.spread = std::make_unique<std::atomic<Spread>[]>(result.all.size());
  for (const std::uint8_t code : result.all.radius_codes) result.radius.push_back(photon_radius(code));
  result.grids = grids_by_radius(result.all);
  return result;
}

CausticMap::Spread CausticMap::spread_of(const Photons& photons, std::uint32_t i) const {
  std::atomic<Spread>& spread = photons.spread[i];
  if (const Spread known = spread.load(std::memory_order_relaxed); known.gain != 0) return known;
  const Vec3f& normal = photons.all.normals[i];
  const Vec3f& place = photons.all.places[i];
  const float before = photons.radius[i];
  const double turn = static_cast<double>(i) * (std::numbers::phi - 1);
  const auto fraction = static_cast<float>(turn - std::floor(turn));
  Spread found{.gain = 1, .shrunk = 0, .walled = false};
  float radius = before;
  // Share of the kernel that lies on the face; tells of walls and gains by the way.
  const auto share_within = [&](float reach) {
    found.walled = ends_->is_beside_wall(normal, place, reach);
    FaceEnds::Kernel kernel;
    if (found.walled || !ends_->is_inside_triangle(photons.all.triangles[i], place, reach))
      kernel = ends_->kernel(normal, place, reach, fraction, found.walled);
    found.gain = kernel.gain;
    return kernel.share;
  };
  // On what is narrower than a third of the radius, gains cannot be told.
  constexpr float kLeastShare = 0.3F;
  constexpr int kMostTimes = 4;
  const auto shrink = [&](float share) { radius *= std::sqrt(std::max(share, 0.1F * kLeastShare)); };
  if (before < kLargestPhotonRadius) shrink(share_within(radius_of_level(level_of_radius(before))));
  float share = share_within(radius);
  for (int times = 0; share < kLeastShare && times < kMostTimes; ++times) {
    shrink(share);
    share = share_within(radius);
  }
  found.shrunk = static_cast<std::uint16_t>(std::lround(65535 * radius / before));
  spread.store(found, std::memory_order_relaxed);
  return found;
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
  for (std::size_t level = 0; level < kRadiusLevels; ++level)
    photons.grids[level].visit(place, radius_of_level(level), [&](std::uint32_t i, float d2) {
      float radius = photons.radius[i];
      if (d2 >= radius * radius || !photons.all.is_on_face(i, {place, x.normal, x.triangle}, radius)) return;
      const Spread spread = spread_of(photons, i);
      radius = spread.radius_of(radius);
      if (d2 >= radius * radius) return;
      if (spread.walled) {
        walled = true;
        const Vec3f above = kLiftOverFace * radius * x.normal;
        if (!rays.visible(place + above, photons.all.places[i] + above)) return;
      }
      if (found.empty()) found.assign(bands, 0.0F);
      const float share = whole ? 1 : 1 - left_to_rays(photons.all.luminaires[i]);
      const float per_unit = share * photon_kernel(d2, radius) * spread.gain;
      const float per_m2 = per_unit / (metres * metres);
      for (std::size_t b = 0; b < bands; ++b) found[b] += per_m2 * photons.all.power[i * bands + b];
      largest = std::max(largest, radius);
      count += static_cast<double>(per_unit);
      of_radii += static_cast<double>(per_unit) * static_cast<double>(radius);
    });
  if (!(count > 0)) return;
  const float gain =
      !walled && ends_->is_inside_triangle(x.triangle, place, largest)
          ? 1
          : ends_->kernel(x.normal, place, static_cast<float>(of_radii / count), turn, walled).gain;
  for (std::size_t b = 0; b < bands; ++b) sum[b] += weight[b] * brdf(b) * found[b] * gain;
}

}  // namespace reemit
