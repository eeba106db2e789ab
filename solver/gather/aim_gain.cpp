#include "solver/gather/aim_gain.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include <tbb/parallel_for.h>

#include "solver/gather/replicate_gather.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

constexpr std::size_t kPointsOfPilot = 512;
constexpr int kRaysOfKind = 16;  // of each kind from a point
constexpr double kGathers = 2;
/// Of the mean radiance of the points, what counts as a point's own at least.
constexpr double kLeastRadiance = 0.1;
/// Work, as a multiple of a gather ray that is read: all else that a sample of a still takes with its shadow
/// ray; finding where to aim; and a hit that is continued.
constexpr double kRestOfSample = 2.5;
constexpr double kAim = 0.5;
constexpr double kContinued = 3;

/// Mean of what a ray brings and of its square.
struct Moments {
  double mean = 0;
  double square = 0;
  void add(double value, double weight) {
    mean += weight * value / kRaysOfKind;
    square += weight * value * value / kRaysOfKind;
  }
  double variance() const { return std::max(0.0, square - mean * mean); }
};

/// What rays from a point found; variances of one ray of each kind, all bands together.
struct Found {
  double radiance = 0;   // irradiance over pi, as the zone has it
  double direct = 0;     // of one shadow ray
  double unaimed = 0;    // of one gather ray where none is aimed
  double others = 0;     // of one where one is, weighed
  double aimed = 0;      // of the aimed one
  double continued = 0;  // of gather rays
  double aimed_continued = 0;
};

class Pilot {
 public:
  Pilot(const HemisphereGather& gather, const DirectLight& direct, std::uint64_t seed)
      : gather_(gather), direct_(direct), rng_(seed, RngPurpose::kAimGain) {}

  Found look(ZoneId zone, const SurfacePoint& x, std::uint64_t index) const;

 private:
  const HemisphereGather& gather_;
  const DirectLight& direct_;
  CounterRng rng_;
};

Found Pilot::look(ZoneId zone, const SurfacePoint& x, std::uint64_t index) const {
  const RayTracer& rays = gather_.room().rays();
  const BrightZones& bright = gather_.bright();
  const Vec3f origin = ray_origin(rays, x);
  const Frame frame(x.normal);
  BrightZones::View view;
  bright.view(origin, x.normal, view);
  Moments direct;
  Moments unaimed;
  Moments others;
  Moments aimed;
  Found found;
  std::vector<float> light(gather_.band_count());
  const std::vector<float> weight(light.size(), std::numbers::inv_pi_v<float>);
  // Rays of both kinds tell what either would find on bright zones [VG95].
  const auto look_along = [&](const Vec3f& direction, const BrightZones::Aim* aim) {
    Hit hit;
    if (!(x.normal.dot(direction) > 0) || !rays.closest(origin, direction, hit)) return;
    const ZoneId met = gather_.room().mesh().zone_at(hit.triangle, hit.u, hit.v, hit.front);
    if (!met.valid() ||
        (aim != nullptr && !(aim->is_met(hit.triangle, hit.front, hit.distance) && bright.holds(met))))
      return;
    const auto value = static_cast<double>(bright.radiance(met));
    const double continued = gather_.continues(met, hit.distance) ? 1 : 0;
    if (!bright.holds(met)) {
      unaimed.add(value, 1);
      others.add(value / kGathers, 1);
      found.continued += continued / kRaysOfKind;
      return;
    }
    const auto share_of_others = [&](float count) {
      return static_cast<double>(
          gather_.share_of_kind({origin, x.normal, view.total, count}, direction, met, hit));
    };
    const double share = share_of_others(static_cast<float>(kGathers)) / kGathers;
    const double by_chance = share_of_others(1);
    unaimed.add(value, by_chance);
    others.add(share * value, by_chance);
    aimed.add(share * value, 1 - by_chance);
    found.continued += by_chance * continued / kRaysOfKind;
    found.aimed_continued += (1 - by_chance) * continued / kRaysOfKind;
  };
  for (std::uint32_t i = 0; i < kRaysOfKind; ++i) {
    const std::array<float, 4> u = rng_.uniform4(index, i, 0);
    const std::array<float, 4> v = rng_.uniform4(index, i, 1);
    look_along(frame.to_world(sample_cosine_hemisphere(u[0], u[1])), nullptr);
    std::fill(light.begin(), light.end(), 0.0F);
    direct_.add_sample(x, {u[2], u[3], v[0]}, weight.data(), light.data());
    double sum = 0;
    for (const float l : light) sum += static_cast<double>(l);
    direct.add(sum, 1);
    if (!(view.total > 0)) continue;
    const BrightZones::Aim aim = bright.aim(origin, view, {v[1], v[2], v[3]});
    if (aim.distance > 0) look_along(aim.direction, &aim);
  }
  const float* reflectance = gather_.room().zone_reflectance(zone);
  for (std::size_t b = 0; b < gather_.band_count(); ++b)
    if (reflectance[b] > 0)
      found.radiance += static_cast<double>(gather_.field().mean_reflected(zone, b) / reflectance[b]);
  found.direct = direct.variance();
  found.unaimed = unaimed.variance();
  found.others = others.variance();
  found.aimed = aimed.variance();
  return found;
}

}  // namespace

double aim_gain(const HemisphereGather& gather, const DirectLight& direct, std::uint64_t seed) {
  const Room& room = gather.room();
  const ZoneMesh& mesh = room.mesh();
  // Evenly over the area that reflects light.
  std::vector<double> area_to(mesh.zone_count() + 1, 0.0);
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const bool is_lit = gather.bright().radiance(ZoneId(z)) > 0;
    area_to[z + 1] = area_to[z] + (is_lit ? mesh.zone_area(ZoneId(z)) : 0.0);
  }
  const Pilot pilot(gather, direct, seed);
  const CounterRng rng(seed, RngPurpose::kAimGain);
  std::vector<Found> found(kPointsOfPilot);
  tbb::parallel_for(std::size_t{0}, kPointsOfPilot, [&](std::size_t i) {
    const std::array<float, 4> u = rng.uniform4(i, kRaysOfKind, 0);
    const double at = (static_cast<double>(i) + static_cast<double>(u[0])) / kPointsOfPilot * area_to.back();
    const auto next = std::upper_bound(area_to.begin() + 1, area_to.end() - 1, at);
    const ZoneId zone(static_cast<std::size_t>(next - area_to.begin()) - 1);
    const SurfacePoint x = point_in_zone(room, zone, {u[1], u[2]});
    if (!x.front && room.surfaces().specular(x.triangle).is_body()) return;
    found[i] = pilot.look(zone, x, i);
  });
  double mean = 0;
  for (const Found& f : found) mean += f.radiance / kPointsOfPilot;
  double before = 0;
  double after = 0;
  double work = kRestOfSample + kGathers;
  double more_work = kAim + 1;
  for (const Found& f : found) {
    const double radiance = f.radiance + kLeastRadiance * mean;
    if (!(radiance > 0)) continue;
    before += (f.direct + f.unaimed / kGathers) / (radiance * radiance);
    after += (f.direct + kGathers * f.others + f.aimed) / (radiance * radiance);
    work += kContinued * kGathers * f.continued / kPointsOfPilot;
    more_work += kContinued * f.aimed_continued / kPointsOfPilot;
  }
  return after > 0 ? before * work / (after * (work + more_work)) : 1;
}

}  // namespace reemit
