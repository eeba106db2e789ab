#include "solver/gather/caustic_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
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

/// Photons of a cell of the grid that are looked at where they only tell how dense they are: beside a lamp
/// there may be very many, on faces that do not count.
constexpr std::uint32_t kMostOfCell = 64;

/// Photons one after the other in order of their places, each of which begins with the radius of the last.
constexpr std::size_t kNeighbours = 64;

/// Rays along a face look for what stands on it at this share of the radius above it.
constexpr float kLift = 0.1F;

/// Least cosine between normals of points of one face, or of faces that go on about as each other do.
constexpr float kSameSide = 0.8F;

std::vector<std::uint32_t> numbers_below(std::size_t end) {
  std::vector<std::uint32_t> numbers(end);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

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
  Photons result;
  result.all = std::move(photons);
  const std::vector<std::uint32_t> all = numbers_below(result.all.size());
  for (std::size_t level = 0; level < kLevels; ++level)
    result.grids[level] = PhotonGrid(result.all.places, all, 2 * radius_of(level));
  return result;
}

CausticMap::Photons CausticMap::of_part(CausticPhotons photons, const StopToken* stop) const {
  Photons result;
  result.all = std::move(photons);
  result.radius.resize(result.all.size());
  result.gain = std::make_unique<std::atomic<float>[]>(result.all.size());
  std::vector<std::uint32_t> order = numbers_below(result.all.size());
  order = PhotonGrid(result.all.places, order, 2 * radius_of(kLevels - 1)).numbers();
  tbb::parallel_for(std::size_t{0}, order.size(), kNeighbours, [&](std::size_t begin) {
    std::size_t levels = 0;
    const std::size_t end = std::min(order.size(), begin + kNeighbours);
    for (std::size_t k = begin; k < end; ++k) {
      if (stop != nullptr && stop->requested()) return;  // with a radius of 0 it is not counted
      const std::uint32_t i = order[k];
      result.radius[i] = radius_at(result.all.normals[i], result.all.places[i], levels);
    }
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

float CausticMap::gain_of(const Photons& photons, std::uint32_t i) const {
  std::atomic<float>& gain = photons.gain[i];
  if (const float known = gain.load(std::memory_order_relaxed); known != 0) return known;
  const Vec3f& normal = photons.all.normals[i];
  const Vec3f& place = photons.all.places[i];
  const float radius = photons.radius[i];
  const bool walled = is_beside_wall(normal, place, radius);
  float found = 1;
  if (walled || !is_inside_triangle(photons.all.triangles[i], place, radius)) {
    const double turn = static_cast<double>(i) * (std::numbers::phi - 1);
    found = gain_at_end(normal, place, radius, static_cast<float>(turn - std::floor(turn)));
  }
  if (walled) found = -found;
  gain.store(found, std::memory_order_relaxed);
  return found;
}

bool CausticMap::counts(const Photons& photons, std::uint32_t i, const Vec3f& normal, const Vec3f& place,
                        float radius) {
  constexpr float kFlat = 0.15F;
  return photons.all.normals[i].dot(normal) > kSameSide &&
         std::fabs((photons.all.places[i] - place).dot(normal)) < kFlat * radius;
}

float CausticMap::radius_at(const Vec3f& normal, const Vec3f& place, std::size_t& levels) const {
  const auto found_within = [&](std::size_t level, float enough) {
    const float radius = radius_of(level);
    float found = 0;
    pilot_.grids[level].visit_some(place, radius, kMostOfCell, [&](std::uint32_t i, float d2, float scale) {
      if (counts(pilot_, i, normal, place, radius)) found += 2 * scale * (1 - d2 / (radius * radius));
      return found < enough;
    });
    return found;
  };
  const auto is_enough = [&](std::size_t level) {
    return found_within(level, pilot_target_) >= pilot_target_;
  };
  const std::size_t before = levels;
  while (levels > 0 && !is_enough(levels - 1)) --levels;
  if (levels == before)
    while (levels < kLevels && is_enough(levels)) ++levels;
  if (levels == 0) return kLargestRadius;
  const float found = found_within(levels - 1, std::numeric_limits<float>::infinity());
  return radius_of(levels - 1) * std::sqrt(pilot_target_ / found);
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

bool CausticMap::is_inside_triangle(TriangleId triangle, const Vec3f& place, float radius) const {
  const RayTracer& rays = room_->rays();
  if (triangle.index() >= room_->mesh().flat_count()) return false;
  const Vec3f& normal = rays.normal(triangle);
  for (int k = 0; k < 3; ++k) {
    const Vec3f from = rays.corner(triangle, k);
    const Vec3f edge = rays.corner(triangle, (k + 1) % 3) - from;
    if (normal.cross(edge).dot(place - from) < radius * edge.norm()) return false;
  }
  return true;
}

/// By what light there is multiplied, for the photon and for the point, where only a share of the kernel lies
/// on the face. With both gains what a photon brings and even light stay what they are: they solve the
/// scaling of [SK67] along the end of a half plane to 4 % (0.4 % in the mean), and where as much is lost all
/// over a face smaller than the kernel. Which of the two it is shows in how far the lost part lies to one
/// side. A gain of the point alone, the reciprocal of its share, keeps even light, and takes up to 30 % from
/// what lies along the end.
float CausticMap::gain_at_end(const Vec3f& normal, const Vec3f& place, float radius, float turn) const {
  const RayTracer& rays = room_->rays();
  constexpr int kPoints = 12;
  const Frame frame(normal);
  const float lift = kLift * radius;
  const Vec3f from = place + lift * normal;
  int beyond = 0;
  Eigen::Vector2f beyond_mean = Eigen::Vector2f::Zero();
  float beyond_distance = 0;
  for (int k = 0; k < kPoints; ++k) {
    // As the kernel weighs them, on a spiral.
    const float u = (static_cast<float>(k) + 0.5F) / kPoints;
    const float r = radius * std::sqrt(1 - std::sqrt(1 - u));
    const float phi =
        2 * std::numbers::pi_v<float> * (turn + static_cast<float>(k) * (std::numbers::phi_v<float> - 1));
    const Eigen::Vector2f place_in_plane(r * std::cos(phi), r * std::sin(phi));
    const Vec3f to = from + frame.to_world({place_in_plane.x(), place_in_plane.y(), 0});
    Hit hit;
    const bool is_on_face = rays.visible(from, to) && rays.closest(to, -normal, hit) &&
                            hit.distance < 2.5F * lift &&
                            side_normal(rays, hit.triangle, hit.u, hit.v, hit.front).dot(normal) > kSameSide;
    if (is_on_face) continue;
    ++beyond;
    beyond_mean += place_in_plane;
    beyond_distance += r;
  }
  if (beyond == 0) return 1;
  constexpr float kRise = 2.4F;
  constexpr float kOfHalfPlane = 2 / std::numbers::pi_v<float>;  // one-sidedness at its end
  const float one_sided = std::min(1.0F, beyond_mean.norm() / (kOfHalfPlane * beyond_distance));
  const float lost = static_cast<float>(std::min(beyond, kPoints - 1)) / kPoints;
  const float all_over = 1 / std::sqrt(1 - lost);
  return all_over + one_sided * (1 + kRise * lost * lost - all_over);
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
      const float gain = gain_of(photons, i);
      if (gain < 0) {
        walled = true;
        const Vec3f above = kLift * radius * x.normal;
        if (!rays.visible(place + above, photons.all.places[i] + above)) return;
      }
      if (found.empty()) found.assign(bands, 0.0F);
      const float share = whole ? 1 : 1 - left_to_rays(photons.all.luminaires[i]);
      const float per_unit = share * kernel(d2, radius) * std::fabs(gain);
      const float per_m2 = per_unit / (metres * metres);
      for (std::size_t b = 0; b < bands; ++b) found[b] += per_m2 * photons.all.power[i * bands + b];
      largest = std::max(largest, radius);
      count += static_cast<double>(per_unit);
      of_radii += static_cast<double>(per_unit) * static_cast<double>(radius);
    });
  if (!(count > 0)) return;
  const float gain = !walled && is_inside_triangle(x.triangle, place, largest)
                         ? 1
                         : gain_at_end(x.normal, place, static_cast<float>(of_radii / count), turn);
  for (std::size_t b = 0; b < bands; ++b) sum[b] += weight[b] * brdf(b) * found[b] * gain;
}

}  // namespace reemit
