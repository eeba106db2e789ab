#include "bench/validation/solved_room.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "solver/progressive_solver.h"

namespace reemit::validation {

SolvedRoom::SolvedRoom(const Scene& scene, const MeshResult& mesh, SolveMethod method, double packets,
                       const std::string& seed_text, Reemission reemission)
    : scene_(&scene) {
  SolverSettings settings;
  settings.method = method;
  settings.reemission = reemission;
  settings.batch_packets = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(packets / kReplicates));
  settings.packets = settings.batch_packets * ZoneSums::kGroups;
  settings.stop_share = 1e-5;
  const std::uint64_t seed = seed_of(seed_text + to_string(method));
  const std::atomic<bool> interrupt{false};
  for (std::size_t i = 0; i < kSolves; ++i) {
    settings.seed = seed + i;
    solutions_.push_back(solve_zones(scene, mesh, settings, {}, interrupt));
    if (solutions_.back().sums.batches != static_cast<std::int64_t>(ZoneSums::kGroups))
      throw std::logic_error("a validation solve has not run the batches it was asked for");
  }
  room_ = std::make_unique<Room>(scene, this->mesh());
}

SurfaceId SolvedRoom::surface(const std::string& name) const {
  for (std::size_t s = 0; s < scene_->surfaces.size(); ++s)
    if (scene_->surfaces[s].name == name) return SurfaceId(s);
  throw std::out_of_range("no surface " + name);
}

double SolvedRoom::area(SurfaceId s) const {
  return area(std::vector<SurfaceId>{s});
}

double SolvedRoom::area(const std::vector<SurfaceId>& surfaces) const {
  double sum = 0;
  for (std::size_t t = 0; t < mesh().triangle_count(); ++t)
    if (std::find(surfaces.begin(), surfaces.end(), mesh().triangle(TriangleId(t)).surface) != surfaces.end())
      sum += mesh().triangle_area(TriangleId(t));
  return sum;
}

std::vector<SurfaceId> SolvedRoom::all_surfaces() const {
  std::vector<SurfaceId> all;
  for (std::size_t s = 0; s < scene_->surfaces.size(); ++s) all.emplace_back(s);
  return all;
}

Estimates SolvedRoom::zone(ZoneId z, std::size_t band) const {
  Estimates result;
  for (std::size_t r = 0; r < kReplicates; ++r)
    result.push_back(in_replicate(r, z.index() * scene_->bands.count() + band));
  return result;
}

Estimates SolvedRoom::mean(const std::vector<SurfaceId>& surfaces, std::size_t band) const {
  Estimates result(kReplicates, 0.0);
  double total = 0;
  for (std::size_t i = 0; i < mesh().zone_count(); ++i) {
    const ZoneId z(i);
    if (!mesh().zone_is_front(z) ||
        std::find(surfaces.begin(), surfaces.end(), mesh().zone_surface(z)) == surfaces.end())
      continue;
    const double zone_area = mesh().zone_area(z);
    total += zone_area;
    for (std::size_t r = 0; r < kReplicates; ++r)
      result[r] += zone_area * in_replicate(r, i * scene_->bands.count() + band);
  }
  return scaled(result, 1 / total);
}

Estimates SolvedRoom::indirect_mean(const std::vector<SurfaceId>& surfaces, std::size_t band) const {
  Estimates result = mean(surfaces, band);
  const double total = area(surfaces);
  for (std::size_t s = 0; s < kSolves; ++s) {
    double direct = 0;
    for (std::size_t i = 0; i < mesh().zone_count(); ++i) {
      const ZoneId z(i);
      if (mesh().zone_is_front(z) &&
          std::find(surfaces.begin(), surfaces.end(), mesh().zone_surface(z)) != surfaces.end())
        direct += mesh().zone_area(z) / total * solutions_[s].direct_irradiance(z, band).mean;
    }
    for (std::size_t g = 0; g < ZoneSums::kGroups; ++g) result[s * ZoneSums::kGroups + g] -= direct;
  }
  return result;
}

Estimates scaled(Estimates estimates, double factor) {
  return scaled(std::move(estimates), factor, 0);
}

Estimates scaled(Estimates estimates, double factor, double offset) {
  for (double& x : estimates) x = x * factor + offset;
  return estimates;
}

}  // namespace reemit::validation
