#include "solver/zoning/pilot_light.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <numeric>
#include <utility>

#include "solver/gather/point_sampler.h"
#include "solver/progressive_solver.h"
#include "solver/reflect/lambert.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

constexpr std::uint64_t kPilotSeed = 1;  // nothing of a solution should depend on it
constexpr std::uint64_t kPackets = 1 << 18;
/// Independent parts of the solution: a point is looked at once with each.
constexpr int kPilotHalves = 2;
/// Surfaces send on no more than this of the light in it, by all ways but clear transmission together, so
/// that it ends soon whatever the room: white ones that are partly metal absorb nothing by themselves.
constexpr double kMostReflectance = 0.9;

Scene dimmed(Scene scene) {
  for (Material& material : scene.materials) {
    Spectrum& mirror = material.non_diffuse.specular_reflectance;
    Spectrum& through = material.non_diffuse.diffuse_transmittance;
    const bool is_tint = material.non_diffuse.angle_law == AngleLaw::kConductor;
    if (is_tint && mirror.size() > 0) mirror = mirror.min(kMostReflectance);
    Spectrum sum = material.lambertian_share();
    if (!is_tint && mirror.size() > 0) sum += mirror;
    const Spectrum share = kMostReflectance / sum.max(kMostReflectance);
    material.reflectance *= share;
    if (material.textures.reflectance) {
      material.textures.reflectance_factor *= share;
      material.textures.most_reflectance *= share;
    }
    if (material.back_reflectance.size() > 0) material.back_reflectance *= share;
    if (!is_tint && mirror.size() > 0) mirror *= share;
    if (through.size() > 0) through *= share;
  }
  return scene;
}

SolverSettings pilot_settings() {
  SolverSettings settings;
  settings.packets = kPackets;
  settings.batch_packets = kPackets / static_cast<std::uint64_t>(settings.smallest_batch_count);
  settings.gather_small_zones = false;
  settings.stop_share = 1e-3;
  settings.seed = kPilotSeed;
  return settings;
}

/// What light on a cell counts for: under a sky that on outsides, which is much brighter, less than that
/// inside (SkyLight::need), or outsides would have nearly all of the zones.
double need_of(const Room& room, const SideCell& cell) {
  if (room.sky() == nullptr) return 1;
  const SidePoint at = cell_point(cell, 1.0F / 3, 1.0F / 3);
  const auto u = static_cast<float>(at.at.u);
  const auto v = static_cast<float>(at.at.v);
  return room.sky()->need(room.rays().point(at.triangle, u, v),
                          side_normal(room.rays(), at.triangle, u, v, at.front));
}

/// By band, the reflected radiance averaged over all area that is not sealed [W/(m2 sr)].
std::vector<double> mean_radiances(const RadianceField& field) {
  const ZoneMesh& mesh = field.room().mesh();
  std::vector<double> mean(field.band_count());
  double area = 0;
  for (std::size_t i = 0; i < mesh.zone_count(); ++i) {
    const ZoneId z(i);
    if (mesh.is_sealed(z)) continue;
    area += mesh.zone_area(z);
    float pick = 0.5F;
    const double need = need_of(field.room(), mesh.pick_cell(z, pick));
    for (std::size_t b = 0; b < field.band_count(); ++b)
      mean[b] += need * mesh.zone_area(z) * static_cast<double>(field.mean_reflected(z, b));
  }
  for (double& m : mean) m = area > 0 ? m / area : 0;
  return mean;
}

/// A number for each cell of a side.
std::uint64_t key_of(const SideCell& cell) {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
  std::uint64_t key = cell.corners.divisions;
  for (const GridPoint& p : cell.corners.at) {
    key = (key ^ (std::uint64_t{p.i} << 16 | p.j)) * kOdd;
    key ^= key >> 32;
  }
  return (static_cast<std::uint64_t>(side_of(cell.triangle, cell.front).index()) << 32) ^ key;
}

}  // namespace

LightSpread spread_of(std::span<const SeenPoint> points) {
  LightSpread light;
  for (const SeenPoint& point : points)
    light.add(static_cast<double>(point.seen.first_look), static_cast<double>(point.seen.second_look));
  return light;
}

PilotLight::PilotLight(const Scene& scene, MeshResult mesh, const WorkWatch& watch)
    : pilot_scene_(dimmed(scene)),
      solver_(pilot_scene_, new_solution(pilot_scene_, std::move(mesh), pilot_settings()), never_,
              watch.part(0, 0.5)),
      field_(room(), solve(solver_, watch.part(0.5, 1)), kPilotHalves),
      direct_(room()),
      gather_(field_, direct_,
              GatherSettings{
                  .close_hit = 0, .continue_uneven = false, .aim_at_bright = false, .seed = kPilotSeed}) {
  const std::vector<double> means = mean_radiances(field_);
  mean_ = std::accumulate(means.begin(), means.end(), 0.0);
  for (const double m : means)
    band_weight_.push_back(m > 0 ? static_cast<float>(mean_ / (static_cast<double>(means.size()) * m))
                                 : 0.0F);
}

const Solution& PilotLight::solve(ProgressiveSolver& solver, const WorkWatch& watch) {
  while (solver.step()) watch.at(solver.progress().fraction);
  solver.end({}, Examination::kNone);
  return solver.solution();
}

PilotLight::Looker::Looker(const PilotLight& pilot) : pilot_(&pilot), batch_(pilot.gather_) {}

LightSpread PilotLight::Looker::look(const SideCell& cell, const LookEffort& effort) {
  LightSpread light;
  look_at_all({&cell, 1}, effort, &light);
  return light;
}

void PilotLight::Looker::look_at_all(std::span<const SideCell> cells, const LookEffort& effort,
                                     LightSpread* light) {
  const auto points = static_cast<std::size_t>(effort.points);
  const std::size_t values = points * kPilotHalves * pilot_->room().band_count();
  points_.clear();
  found_.assign(cells.size() * values, 0.0F);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const PointSampler places(kPilotSeed, RngPurpose::kPilotLight, key_of(cells[i]), 0,
                              std::countr_zero(std::bit_ceil(static_cast<unsigned>(effort.points))));
    for (int k = 0; k < effort.points; ++k) {
      const std::array<float, 2> u = places.place(k);
      const auto [a, b] = sample_triangle(u[0], u[1]);
      points_.push_back({{a, b}, {}});
    }
    send_rays(cells[i], std::span(points_).subspan(i * points, points), effort, &found_[i * values]);
  }
  batch_.flush();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::span<SeenPoint> of_cell = std::span(points_).subspan(i * points, points);
    add_up(cells[i], of_cell, &found_[i * values]);
    light[i] = spread_of(of_cell);
  }
}

void PilotLight::Looker::look_at(const SideCell& cell, std::span<SeenPoint> places,
                                 const LookEffort& effort) {
  found_.assign(places.size() * kPilotHalves * pilot_->room().band_count(), 0.0F);
  send_rays(cell, places, effort, found_.data());
  batch_.flush();
  add_up(cell, places, found_.data());
}

void PilotLight::Looker::send_rays(const SideCell& cell, std::span<const SeenPoint> places,
                                   const LookEffort& effort, float* found) {
  const Room& room = pilot_->room();
  const std::size_t bands = room.band_count();
  const float* reflectance = room.surfaces().reflectance(cell.triangle, cell.front);
  direct_weight_.resize(bands);
  ray_weight_.resize(bands);
  for (std::size_t b = 0; b < bands; ++b) {
    const float weight = pilot_->band_weight_[b];
    direct_weight_[b] =
        lambert_reflected_radiance(weight * reflectance[b], 1.0F / static_cast<float>(effort.shadows));
    ray_weight_[b] = weight * reflectance[b] / static_cast<float>(effort.gathers);
  }
  draw_numbers(side_of(cell.triangle, cell.front), effort);
  const std::uint64_t key = key_of(cell);
  for (int i = 0; i < effort.points; ++i) {
    const InCell& place = places[static_cast<std::size_t>(i)].at;
    const SidePoint at = cell_point(cell, place.a, place.b);
    const SurfacePoint x = surface_point(room.rays(), at.triangle, static_cast<float>(at.at.u),
                                         static_cast<float>(at.at.v), at.front);
    pilot_->direct_.add_samples(
        x, kPilotHalves * effort.shadows, [&](int ray) { return light_[static_cast<std::size_t>(ray)]; },
        direct_weight_.data(),
        [&](int ray) { return found + static_cast<std::size_t>(ray / effort.shadows) * bands; });
    for (int half = 0; half < kPilotHalves; ++half, found += bands) {
      const auto part = static_cast<std::uint32_t>(half) % static_cast<std::uint32_t>(pilot_->field_.parts());
      for (int ray = half * effort.gathers; ray < (half + 1) * effort.gathers; ++ray) {
        const std::array<float, 2>& d = hemisphere_[static_cast<std::size_t>(ray)];
        const auto path = static_cast<std::uint32_t>(i * kPilotHalves * effort.gathers + ray);
        batch_.add(x, d[0], d[1], {key, part, path, part}, ray_weight_.data(), found);
      }
    }
  }
}

// The same rays from every point of the side, so that their noise is the same and only differences of the
// light are left.
void PilotLight::Looker::draw_numbers(SideId side, const LookEffort& effort) {
  const auto shadows = static_cast<std::size_t>(kPilotHalves * effort.shadows);
  const auto gathers = static_cast<std::size_t>(kPilotHalves * effort.gathers);
  if (side == side_ && light_.size() == shadows && hemisphere_.size() == gathers) return;
  side_ = side;
  const PointSampler rays(kPilotSeed, RngPurpose::kPilotLight, side.index(), 1,
                          std::countr_zero(unsigned{kPilotHalves}));
  light_.clear();
  hemisphere_.clear();
  for (int half = 0; half < kPilotHalves; ++half) {
    for (int ray = 0; ray < effort.shadows; ++ray) light_.push_back(rays.light(half, ray, effort.shadows));
    for (int ray = 0; ray < effort.gathers; ++ray)
      hemisphere_.push_back(rays.hemisphere(half, ray, effort.gathers));
  }
}

void PilotLight::Looker::add_up(const SideCell& cell, std::span<SeenPoint> points, const float* found) const {
  const Room& room = pilot_->room();
  const double need = need_of(room, cell);
  for (SeenPoint& point : points) {
    std::array<double, kPilotHalves> sum{};
    for (double& of_half : sum)
      for (std::size_t b = 0; b < room.band_count(); ++b) of_half += static_cast<double>(*found++);
    point.seen = {static_cast<float>(need * sum[0]), static_cast<float>(need * sum[1])};
  }
}

}  // namespace reemit
