#include "solver/emit/luminaire_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/emit/light_places.h"
#include "solver/emit/luminaire_faces.h"

namespace reemit {

LuminaireTable::LuminaireTable(const Room& room)
    : rays_(&room.rays()), sky_light_(room.sky()), surfaces_(&room.surfaces()), bands_(room.band_count()) {
  add_surfaces(room);
  add_cells(room);
  add_lights(room.scene());
  add_sky(room);
  build_tree();
}

void LuminaireTable::add_strength(const Spectrum& strength) {
  for (std::size_t b = 0; b < bands_; ++b)
    strength_.push_back(static_cast<float>(strength[static_cast<Eigen::Index>(b)]));
  brightness_.push_back(static_cast<float>(strength.sum()));
}

void LuminaireTable::add_surfaces(const Room& room) {
  const ZoneMesh& mesh = room.mesh();
  const SurfaceModel& surfaces = room.surfaces();
  const double metres = rays_->metres_per_unit();
  area_of_surface_.assign(surfaces.surface_count(), 0.0F);
  const auto add = [&](AreaLuminaire luminaire, SurfaceId surface) {
    area_of_surface_[surface.index()] += static_cast<float>(luminaire.area());
    surface_of_area_.push_back(surface);
    areas_.push_back(std::move(luminaire));
    add_strength(surfaces.normal_radiance(surface));
  };
  for (const LuminaireFace& face : luminaire_faces(room)) {
    const double exponent = surfaces.emission_exponent(face.surface);
    std::vector<Vec3> corners;
    for (const Vec3& c : face.corners) corners.push_back((c - rays_->centre()) / metres);
    add({corners, face.normal, exponent}, face.surface);
    if (face.emits_both_sides) add({corners, -face.normal, exponent}, face.surface);
  }
  for (std::size_t s = 0; s < mesh.curved().size(); ++s) {
    const TriangleId patch = mesh.first_patch(s);
    const SurfaceId surface = mesh.triangle(patch).surface;
    if (!surfaces.emits(surface)) continue;
    const CurvedShape& shape = rays_->patches(patch).shape();
    const double exponent = surfaces.emission_exponent(surface);
    const bool is_clear = surfaces.specular(patch).is_pane();
    add({shape, exponent, is_clear}, surface);
    if (surfaces.emits(patch, false)) add({flipped(shape), exponent, is_clear}, surface);
  }
}

void LuminaireTable::add_cells(const Room& room) {
  const double metres = rays_->metres_per_unit();
  first_cell_ = areas_.size();
  for (const LuminaireCell& cell : luminaire_cells(room)) {
    const SurfaceId surface = surfaces_->surface(cell.triangle, cell.front);
    std::vector<Vec3> corners;
    for (const Vec3& c : cell.corners) corners.push_back((c - rays_->centre()) / metres);
    const Vec3& front = room.mesh().triangle_normal(cell.triangle);
    AreaLuminaire luminaire(corners, cell.front ? front : Vec3(-front),
                            surfaces_->emission_exponent(surface));
    area_of_surface_[surface.index()] += static_cast<float>(luminaire.area());
    surface_of_area_.push_back(surface);
    areas_.push_back(std::move(luminaire));
    add_strength(cell.radiance);
    cells_.push_back(cell.triangle);
  }
}

void LuminaireTable::radiance_at(std::size_t entry, const Vec3f& target,
                                 SurfaceModel::PointValues& radiance) const {
  const TriangleId t = cells_[entry - first_cell_];
  const Barycentric at = rays_->mesh().barycentric_of(t, rays_->in_room(target));
  const auto u = static_cast<float>(at.u);
  const auto v = static_cast<float>(at.v);
  const RoomTextures& textures = surfaces_->textures();
  const SurfaceId surface = surfaces_->surface(t, true);
  if (surfaces_->emission_varies(t)) {
    textures.radiance(t, u, v, 0, radiance);
  } else {
    radiance.clear();
    for (const double even : surfaces_->normal_radiance(surface))
      radiance.push_back(static_cast<float>(even));
  }
  if (!textures.is_cut_out(surface)) return;
  const float opacity = textures.opacity(t, u, v);
  for (float& r : radiance) r *= opacity;
}

void LuminaireTable::add_lights(const Scene& scene) {
  const std::vector<PunctualLight> placed = lights_before_faces(scene, *rays_);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const PunctualLight& light = scene.lights[i];
    if (!(light_power(light, rays_->metres_per_unit()).sum() > 0)) continue;
    punctual_.push_back(make_punctual_emitter(placed[i], *rays_));
    add_strength(strength_of(light));
  }
}

void LuminaireTable::add_sky(const Room& room) {
  const SkyLight* sky = room.sky();
  if (sky == nullptr) return;
  sky->prepare();
  if (sky->has_sky()) {
    sky_ = size();
    add_strength(sky->sky_strength());
  }
  if (sky->has_sun()) {
    sun_ = size();
    add_strength(sky->sun_strength());
  }
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
    if (is_at_infinity(punctual_[i]))
      at_infinity_.push_back(static_cast<std::uint32_t>(entry));
    else
      add(bounds_of_light(punctual_[i], brightness_[entry]), entry);
  }
  for (const std::size_t entry : {sky_, sun_})
    if (entry != kNoEntry) at_infinity_.push_back(static_cast<std::uint32_t>(entry));
  tree_ = LightTree(bounds);
}

float LuminaireTable::unoccluded(std::size_t entry, const Vec3f& x, const Vec3f& n) const {
  if (entry < areas_.size())
    return static_cast<float>(areas_[entry].expected_irradiance(x.cast<double>(), n.cast<double>()));
  if (entry == sky_) return sky_light_->expected_from_sky(x, n);
  if (entry == sun_) {
    // Inside most points do not see the sun, however strong it is: it is asked for no more often than the
    // sky, of which it is known how much they see.
    const float unhidden = sky_light_->expected_from_sun(n);
    if (sky_ == kNoEntry) return unhidden;
    return std::min(unhidden, sky_light_->expected_from_sky(x, n) / brightness_[sun_]);
  }
  return expected_irradiance(punctual_[entry - areas_.size()], x, n);
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
    result.target = (point.point + static_cast<double>(RayTracer::kLift) * point.normal).cast<float>();
    result.pdf_per_sr = static_cast<float>(point.pdf_per_sr);
    return true;
  }
  if (entry == sky_ || entry == sun_) {
    const SkyLight::Sample towards =
        entry == sky_ ? sky_light_->sample_sky(x, n, u0, u1) : sky_light_->sample_sun(n, u0, u1);
    result = {towards.factor, true, towards.towards};
    return result.factor > 0;
  }
  result = sample_light(punctual_[entry - areas_.size()], x, n, u0, u1);
  return result.factor > 0;
}

}  // namespace reemit
