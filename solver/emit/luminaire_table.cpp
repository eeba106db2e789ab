#include "solver/emit/luminaire_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/model/photometry.h"
#include "solver/emit/light_places.h"
#include "solver/emit/luminaire_faces.h"
#include "solver/emit/punctual_packets.h"

namespace reemit {

LuminaireTable::LuminaireTable(const Scene& scene, const RayScene& rays)
    : rays_(&rays), bands_(scene.bands.count()) {
  add_surfaces(scene);
  add_lights(scene);
  build_tree();
}

void LuminaireTable::add_emission(const Spectrum& emission) {
  for (std::size_t b = 0; b < bands_; ++b)
    emission_.push_back(static_cast<float>(emission[static_cast<Eigen::Index>(b)]));
  brightness_.push_back(static_cast<float>(emission.sum()));
}

void LuminaireTable::add_area(AreaLuminaire luminaire, const Material& material) {
  areas_.push_back(std::move(luminaire));
  add_emission(material.emitted_radiance);
}

void LuminaireTable::add_surfaces(const Scene& scene) {
  const ZoneMesh& mesh = rays_->mesh();
  const double metres = rays_->metres_per_unit();
  const auto both = [](const Material& m, bool two_sided) { return m.emits_both_sides && two_sided; };
  for (const LuminaireFace& face : luminaire_faces(scene, mesh)) {
    const Material& material = scene.material_of(scene.surfaces[face.surface.index()]);
    std::vector<Vec3> corners;
    for (const Vec3& c : face.corners) corners.push_back((c - rays_->centre()) / metres);
    add_area({corners, face.normal, material.emission_exponent}, material);
    if (both(material, face.two_sided))
      add_area({corners, -face.normal, material.emission_exponent}, material);
  }
  for (std::size_t s = 0; s < mesh.curved().size(); ++s) {
    const TriangleId patch = mesh.first_patch(s);
    const BaseTriangle& triangle = mesh.triangle(patch);
    const Material& material = scene.material_of(scene.surfaces[triangle.surface.index()]);
    if (!material.emits()) continue;
    const CurvedShape& shape = rays_->patches(patch).shape();
    add_area({shape, material.emission_exponent}, material);
    if (both(material, triangle.two_sided)) add_area({flipped(shape), material.emission_exponent}, material);
  }
}

void LuminaireTable::add_lights(const Scene& scene) {
  const std::vector<PunctualLight> placed = lights_before_faces(scene, *rays_);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const PunctualLight& light = scene.lights[i];
    if (!(light_power(light, *rays_).sum() > 0)) continue;
    punctual_.push_back(make_punctual_emitter(placed[i], *rays_));
    lights_.push_back(&light);
    add_emission(emission_of(light));
  }
}

LuminaireBounds LuminaireTable::bounds_of_light(std::size_t i) const {
  const PunctualEmitter& emitter = punctual_[i];
  const float strength = brightness_[areas_.size() + i];
  if (const auto* spot = std::get_if<SpotLight>(lights_[i])) {
    const double cos_outer = std::max(0.0, std::cos(spot->outer_angle));
    return spot_bounds(emitter.position, emitter.direction, static_cast<float>(cos_outer), strength);
  }
  if (const auto* measured = std::get_if<PhotometricLight>(lights_[i])) {
    const double reach = 0.5 * measured->opening.size().norm() / rays_->metres_per_unit();
    return sphere_bounds(emitter.position, static_cast<float>(reach),
                         strength * static_cast<float>(measured->table->greatest_intensity()));
  }
  return sphere_bounds(emitter.position, 0, strength);
}

void LuminaireTable::build_tree() {
  const double metres = rays_->metres_per_unit();
  std::vector<LuminaireBounds> bounds;
  const auto add = [&](const LuminaireBounds& b, std::size_t entry) {
    bounds.push_back(b);
    tree_entry_.push_back(static_cast<std::uint32_t>(entry));
  };
  for (std::size_t i = 0; i < areas_.size(); ++i)
    add(areas_[i].bounds(static_cast<double>(brightness_[i]) * metres * metres), i);
  for (std::size_t i = 0; i < punctual_.size(); ++i) {
    const std::size_t entry = areas_.size() + i;
    if (punctual_[i].kind == PunctualEmitter::Kind::kDirectional)
      at_infinity_.push_back(static_cast<std::uint32_t>(entry));
    else
      add(bounds_of_light(i), entry);
  }
  tree_ = LightTree(bounds);
}

float LuminaireTable::unoccluded(std::size_t entry, const Vec3f& x, const Vec3f& n) const {
  if (entry < areas_.size())
    return static_cast<float>(areas_[entry].expected_irradiance(x.cast<double>(), n.cast<double>()));
  return punctual_[entry - areas_.size()].unoccluded_irradiance(x, n,
                                                                static_cast<float>(rays_->metres_per_unit()));
}

bool LuminaireTable::sample(std::size_t entry, const Vec3f& x, const Vec3f& n, float u0, float u1,
                            LuminaireSample& result) const {
  if (entry < areas_.size()) {
    AreaSample point;
    if (!areas_[entry].sample(x.cast<double>(), n.cast<double>(), static_cast<double>(u0),
                              static_cast<double>(u1), point))
      return false;
    result.factor = static_cast<float>(point.factor);
    result.at_infinity = false;
    result.target = (point.point + static_cast<double>(RayScene::kLift) * point.normal).cast<float>();
    return true;
  }
  const PunctualEmitter& e = punctual_[entry - areas_.size()];
  const PunctualSample point = e.sample(x, n, u0, u1, static_cast<float>(rays_->metres_per_unit()));
  result.factor = point.factor;
  result.at_infinity = point.at_infinity;
  result.target = point.target;
  return result.factor > 0;
}

}  // namespace reemit
