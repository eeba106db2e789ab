#include "solver/reflect/surface_model.h"

#include <numbers>

namespace reemit {

SurfaceModel::SurfaceModel(const Scene& scene, const ZoneMesh& mesh, double metres_per_unit)
    : bands_(scene.bands.count()), zero_(bands_, 0.0F) {
  std::vector<bool> emits_both_sides;
  for (const Surface& surface : scene.surfaces) {
    const Material& m = scene.material_of(surface);
    surfaces_.push_back({m.emitted_radiance, m.exitance(), m.emission_exponent, m.emits()});
    specular_.emplace_back(m, metres_per_unit);
    any_specular_ = any_specular_ || specular_.back().exists();
    any_transmits_ = any_transmits_ || specular_.back().transmits();
    emits_both_sides.push_back(m.emits_both_sides);
    for (const bool front : {true, false}) {
      const Spectrum& rho = m.reflectance_of(front);
      reflectance_.insert(reflectance_.end(), rho.begin(), rho.end());
      for (const double x : rho) side_reflectance_.push_back(static_cast<float>(x));
      largest_reflectance_.push_back(rho.maxCoeff());
    }
    const Spectrum emitted = m.exitance() / std::numbers::pi;
    for (const double x : emitted) emitted_.push_back(static_cast<float>(x));
  }
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    const std::size_t surface = mesh.triangle(t).surface.index();
    surface_.push_back(static_cast<std::uint32_t>(surface));
    const bool emits = surfaces_[surface].emits;
    const bool back = mesh.has_zones(t, false);
    sides_.push_back({true, emits});
    sides_.push_back({back, emits && back && emits_both_sides[surface]});
  }
}

}  // namespace reemit
