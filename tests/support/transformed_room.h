#pragma once
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "scenes/model/scene.h"
#include "solver/solution/solution.h"
#include "solver/tally/replicates.h"

namespace reemit::test {

/// A room enlarged by `scale` and then moved by `shift` [m]. Radiance stays, so irradiance should too.
inline Scene transformed(Scene scene, double scale, const Vec3& shift) {
  for (Surface& surface : scene.surfaces)
    for (Vec3& p : surface.positions) p = scale * p + shift;
  for (Camera& camera : scene.cameras) {
    camera.eye = scale * camera.eye + shift;
    camera.look_at = scale * camera.look_at + shift;
  }
  return scene;
}

/// Diagonal of the box around a room [m].
inline double room_size(const Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const Surface& surface : scene.surfaces)
    for (const Vec3& p : surface.positions) box.extend(p);
  return box.diagonal().norm();
}

/// |difference| of the mean irradiance of every lit surface in its standard error, first band. The rooms may
/// be meshed differently. Pre: at least ZoneSums::kGroups batches each.
inline std::vector<double> surface_deviations(const Solution& a, const Solution& b) {
  const auto means = [](const Solution& s) {
    // Per surface: area, then the power that each batch group brings to it.
    std::vector<std::array<double, ZoneSums::kGroups + 1>> sums(s.surface_names.size());
    const std::size_t bands = s.bands.count();
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      auto& sum = sums[s.mesh.zone_surface(ZoneId(z)).index()];
      const double area = s.mesh.zone_area(ZoneId(z));
      sum[ZoneSums::kGroups] += area;
      for (std::size_t g = 0; g < ZoneSums::kGroups; ++g)
        sum[g] += area * s.sums.group_total[(g * s.mesh.zone_count() + z) * bands] /
                  static_cast<double>(s.sums.group_weight[g]);
    }
    std::vector<ReplicateMean> result;
    for (const auto& sum : sums)
      result.push_back(mean_of_replicates(ZoneSums::kGroups, ZoneSums::kGroups,
                                          [&](std::size_t g) { return sum[g] / sum[ZoneSums::kGroups]; }));
    return result;
  };
  const std::vector<ReplicateMean> x = means(a);
  const std::vector<ReplicateMean> y = means(b);
  std::vector<double> deviations;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double variance = x[i].squared_error + y[i].squared_error;
    if (variance > 0) deviations.push_back(std::abs(x[i].mean - y[i].mean) / std::sqrt(variance));
  }
  return deviations;
}

}  // namespace reemit::test
