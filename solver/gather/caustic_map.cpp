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

/// Rays along a face look for what stands on it at this share of the radius above it.
constexpr float kLift = 0.1F;

float kernel(float squared_distance, float radius) {
  const float r2 = radius * radius;
  return 2 / (std::numbers::pi_v<float> * r2) * (1 - squared_distance / r2);
}

}  // namespace

CausticMap::CausticMap(const Room& room, std::size_t parts, std::uint64_t seed, const CausticPackets* known,
                       const StopToken* stop)
    : room_(&room), left_to_rays_(room.surfaces().surface_count(), 1.0F) {
  if (!room.surfaces().any_specular()) return;
  const CausticShooter shooter(room, seed);
  CausticShots shots = shoot_caustics(shooter, known, stop);
  if (shots.packets == 0) return;
  const std::vector<float> density = shooter.density_of_surfaces(shots.packets);
  for (std::size_t s = 0; s < density.size(); ++s) {
    const double photons =
        static_cast<double>(density[s]) * std::numbers::pi * kTypicalRadius * kTypicalRadius;
    left_to_rays_[s] = static_cast<float>(kTypicalRays / (kTypicalRays + photons));
  }
  parts_.resize(parts);
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t p) {
    std::vector<CausticPhotons> together;
    for (std::size_t k = p; k < CausticShots::kParts; k += parts)
      together.push_back(std::move(shots.parts[k]));
    parts_[p] = of_part(mean_of(std::move(together)));
  });
}

CausticMap::Photons CausticMap::of_part(CausticPhotons photons) {
  Photons result;
  result.all = std::move(photons);
  result.gain = std::make_unique<std::atomic<float>[]>(result.all.size());
  for (const std::uint8_t code : result.all.radius_codes) result.radius.push_back(photon_radius(code));
  std::array<std::vector<std::uint32_t>, kRadiusLevels> of_level;
  for (std::uint32_t i = 0; i < result.radius.size(); ++i) {
    std::size_t level = 0;
    while (level + 1 < kRadiusLevels && radius_of_level(level + 1) >= result.radius[i]) ++level;
    of_level[level].push_back(i);
  }
  for (std::size_t level = 0; level < kRadiusLevels; ++level)
    result.grids[level] = PhotonGrid(result.all.places, of_level[level], 2 * radius_of_level(level));
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
                            side_normal(rays, hit.triangle, hit.u, hit.v, hit.front).dot(normal) > kSameFace;
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
  for (std::size_t level = 0; level < kRadiusLevels; ++level)
    photons.grids[level].visit(place, radius_of_level(level), [&](std::uint32_t i, float d2) {
      const float radius = photons.radius[i];
      if (d2 >= radius * radius || !photons.all.is_on_face(i, x.normal, place, radius)) return;
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
