#include "solver/reflect/surface_model.h"

#include <algorithm>
#include <numbers>

#include "solver/texture/zone_means.h"

namespace reemit {

SurfaceModel::SurfaceModel(const Scene& scene, const ZoneMesh& mesh, const RoomTextures& textures,
                           double metres_per_unit, TextureMeans means)
    : textures_(&textures),
      metres_per_unit_(static_cast<float>(metres_per_unit)),
      bands_(scene.bands.count()),
      surface_count_(scene.surfaces.size()),
      zero_(bands_, 0.0F) {
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
      shown_.emplace_back(rows_.size() / 2);
      rows_.push_back({static_cast<std::uint32_t>(rows_.size()), 0});
      reflectance_.insert(reflectance_.end(), rho.begin(), rho.end());
      for (const double x : rho) side_reflectance_.push_back(static_cast<float>(x));
      largest_reflectance_.push_back(rho.maxCoeff());
    }
    const Spectrum emitted = m.exitance() / std::numbers::pi;
    for (const double x : emitted) emitted_.push_back(static_cast<float>(x));
  }
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    const SurfaceId s = mesh.triangle(t).surface;
    const std::size_t surface = mesh.is_back_to_back(t) ? pair_of(s, mesh.surface(t, false)) : s.index();
    surface_.push_back(static_cast<std::uint32_t>(surface));
    const bool emits = surfaces_[surface].emits;
    const bool back = mesh.has_zones(t, false);
    const bool varies = textures.varies_reflectance(s);
    const bool glows = emits && textures.varies_emission(s);
    const bool back_emits = emits && back && emits_both_sides[s.index()];
    const SpecularSurface& specular = specular_[surface];
    sides_.push_back({.reflects = true,
                      .emits = emits,
                      .reflectance_varies = varies,
                      .emission_varies = glows,
                      .specular = specular.exists(),
                      .absorbs_before = false});
    sides_.push_back({.reflects = back,
                      .emits = back_emits,
                      .reflectance_varies = varies && back && textures.varies_back(s),
                      .emission_varies = glows && back_emits,
                      .specular = specular.exists() && back,
                      .absorbs_before = specular.absorbs_inside()});
  }
  if (!textures.empty() && means == TextureMeans::kFound) add_zone_rows(mesh);
}

// The row of two surfaces whose faces lie back to back. Neither emits nor is specular (may_be_back_to_back).
std::size_t SurfaceModel::pair_of(SurfaceId front, SurfaceId back) {
  const auto [pair, is_new] = pairs_.try_emplace({front, back}, surfaces_.size());
  if (!is_new) return pair->second;
  surfaces_.push_back(surfaces_[front.index()]);
  specular_.push_back(specular_[front.index()]);
  for (std::size_t b = 0; b < bands_; ++b) emitted_.push_back(emitted_[front.index() * bands_ + b]);
  for (const SurfaceId s : {front, back}) {
    const std::size_t row = row_of(s.index(), true);
    shown_.push_back(s);
    rows_.push_back({static_cast<std::uint32_t>(rows_.size()), 0});
    for (std::size_t b = 0; b < bands_; ++b) {
      reflectance_.push_back(reflectance_[row * bands_ + b]);
      side_reflectance_.push_back(side_reflectance_[row * bands_ + b]);
    }
    largest_reflectance_.push_back(largest_reflectance_[row]);
  }
  return pair->second;
}

void SurfaceModel::add_zone_rows(const ZoneMesh& mesh) {
  ZoneTextureMeans means = zone_texture_means(*textures_, mesh, bands_);
  zone_radiance_ = std::move(means.radiance);
  if (means.reflectance.empty()) return;
  const auto first = static_cast<std::uint32_t>(rows_.size());
  for (std::size_t r = 0; r < 2 * surface_count_; ++r) {
    const SurfaceId s(r / 2);
    if (textures_->varies_reflectance(s) && (r % 2 == 0 || textures_->varies_back(s)))
      rows_[r] = {first, 0xffffffff};
  }
  for (std::size_t i = 0; i < means.reflectance.size(); i += bands_) {
    const auto row = means.reflectance.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end = row + static_cast<std::ptrdiff_t>(bands_);
    for (auto x = row; x != end; ++x) side_reflectance_.push_back(static_cast<float>(*x));
    largest_reflectance_.push_back(*std::max_element(row, end));
  }
  reflectance_.insert(reflectance_.end(), means.reflectance.begin(), means.reflectance.end());
}

Spectrum SurfaceModel::exitance(ZoneId z, SurfaceId s) const {
  if (zone_radiance_.empty() || !textures_->varies_emission(s)) return exitance(s);
  const Spectrum radiance =
      Spectrum::Map(&zone_radiance_[z.index() * bands_], static_cast<Eigen::Index>(bands_));
  return 2 * std::numbers::pi / (emission_exponent(s) + 2) * radiance;
}

void SurfaceModel::point_emitted(const SurfacePoint& x, PointValues& here) const {
  textures_->radiance(x.triangle, x.u, x.v, x.footprint * metres_per_unit_, here);
  const auto share = static_cast<float>(2 / (surfaces_[surface_of(x.triangle)].emission_exponent + 2));
  if (share == 1) return;
  for (std::size_t b = 0; b < bands_; ++b) here[b] *= share;
}

}  // namespace reemit
