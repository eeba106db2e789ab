#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"
#include "solver/reflect/lobe.h"
#include "solver/reflect/specular.h"
#include "solver/texture/room_textures.h"
#include "solver/texture/zone_means.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// What the surfaces of a room do with light: the one reader of materials in the solver. Zones hold the
/// Lambertian part of it, reflectance(); what is spread over directions is value() and sample(); what goes on
/// as a ray is specular(). Values per band, double for books and float for rays. Const members may be called
/// from any thread.
class SurfaceModel {
 public:
  /// Room for the values of a point where they vary.
  using PointValues = RoomTextures::Values;

  /// `metres_per_unit`: of the space of the rays (RayTracer::metres_per_unit). The textures must outlive it.
  SurfaceModel(const Scene& scene, const ZoneMesh& mesh, const RoomTextures& textures, double metres_per_unit,
               TextureMeans means = TextureMeans::kFound);

  std::size_t band_count() const { return bands_; }
  std::size_t surface_count() const { return surface_count_; }

  /// Diffuse reflectance of a zone, which lies on that side of a triangle, one number per band [0,1], and the
  /// largest of them; of textures the mean over the zone. Backs that absorb all light are not told apart.
  const double* reflectance(ZoneId z, TriangleId t, bool front) const {
    return &reflectance_[row_of(z, t, front) * bands_];
  }
  const float* reflectance_float(ZoneId z, TriangleId t, bool front) const {
    return &side_reflectance_[row_of(z, t, front) * bands_];
  }
  double largest_reflectance(ZoneId z, TriangleId t, bool front) const {
    return largest_reflectance_[row_of(z, t, front)];
  }
  /// The same of a side of a surface, with textures at their means.
  const double* reflectance(SurfaceId s, bool front) const {
    return &reflectance_[row_of(s.index(), front) * bands_];
  }
  /// The same of a side of a triangle.
  const double* mean_reflectance(TriangleId t, bool front) const {
    return &reflectance_[row_of(surface_of(t), front) * bands_];
  }
  /// The same of one side of a triangle; zero on backs that absorb.
  const float* reflectance(TriangleId t, bool front) const {
    return side(t, front).reflects ? &side_reflectance_[row_of(surface_of(t), front) * bands_] : zero_.data();
  }
  /// At a point; textures are averaged over x.footprint. Where it varies, it is put into `here`.
  const float* reflectance(const SurfacePoint& x, PointValues& here) const {
    return reflectance(x.triangle, x.u, x.v, x.front, x.footprint, here);
  }
  const float* reflectance(const Hit& x, PointValues& here) const {
    return reflectance(x.triangle, x.u, x.v, x.front, 0, here);
  }

  /// BRDF at x for light from direction `from` (unit), seen from x.towards. Refers to `here`.
  BrdfValue value(const SurfacePoint& x, const Vec3f& from, PointValues& here) const {
    return std::visit([&](const auto& lobe) { return lobe.value(x, from); },
                      Lobe(LambertLobe{reflectance(x, here)}));
  }
  /// A direction from which light seen from x.towards comes, for two uniform numbers.
  ScatterSample sample(const SurfacePoint& x, float u0, float u1) const {
    return std::visit([&](const auto& lobe) { return lobe.sample(x, u0, u1); },
                      Lobe(LambertLobe{reflectance(x.triangle, x.front)}));
  }

  /// That a side of a triangle shows (ZoneMesh::surface).
  SurfaceId surface(TriangleId t, bool front) const { return shown_[row_of(surface_of(t), front)]; }

  /// Whether any surface of the room has a part that is carried on by rays; whether light crosses any.
  bool any_specular() const { return any_specular_; }
  bool any_transmits() const { return any_transmits_; }
  /// That part of a triangle; it holds for both sides, but backs that absorb have none.
  const SpecularSurface& specular(TriangleId t) const { return specular_[surface_of(t)]; }
  bool is_specular(TriangleId t, bool front) const { return side(t, front).specular; }
  /// Whether a ray that ends on a side of a triangle may have lost light in a body of glass that it started
  /// in, or else goes on from there.
  bool is_specular_or_inside(TriangleId t, bool front) const {
    const Side& s = side(t, front);
    return s.specular || s.absorbs_before;
  }
  /// Whether DirectLight finds light that lobes of a specular triangle spread.
  bool spreads(TriangleId t) const {
    const SpecularSurface& s = specular(t);
    return s.spreads(SpecularWayOn::kMirror) || s.spreads(SpecularWayOn::kAcross) ||
           s.spreads(SpecularWayOn::kDiffuse);
  }
  /// The body of glass that absorbed light on a way that ended on a side of a triangle: `known`, where a ray
  /// has been sent into one, else the one whose inside that side is. Not valid if there is none.
  TriangleId body_around(TriangleId t, bool front, TriangleId known) const {
    if (!known.valid()) return side(t, front).absorbs_before ? t : TriangleId();
    return specular(known).absorbs_inside() ? known : TriangleId();
  }
  /// The body that a ray is in when it goes on from a side of a triangle, for the one that it came through.
  TriangleId body_beyond(TriangleId t, bool leaves_front, TriangleId around) const {
    if (!specular(t).is_body()) return around;
    return leaves_front ? TriangleId() : t;
  }
  /// What radiance of surfaces inside a body (which need not be valid) is in rays, which carry it as that
  /// outside of glass.
  float radiance_outside(TriangleId body) const {
    return body.valid() ? specular(body).radiance_outside() : 1.0F;
  }
  /// Takes from `light`, per band, what a body (which need not be valid) absorbs along a way.
  void attenuate(TriangleId body, float way, float* light) const {
    if (!body.valid()) return;
    for (std::size_t b = 0; b < bands_; ++b) light[b] *= specular(body).left_inside(b, way);
  }

  /// Whether a side of a triangle, or any side of a surface, emits.
  bool emits(TriangleId t, bool front) const { return side(t, front).emits; }
  bool emits(SurfaceId s) const { return surfaces_[s.index()].emits; }
  /// Self-emitted radiance [W/(m2 sr)] of one side: exitance over pi, which is the radiance in every
  /// direction where emission is Lambertian. Zero where it does not emit.
  const float* emitted(TriangleId t, bool front) const {
    return emits(t, front) ? &emitted_[surface_of(t) * bands_] : zero_.data();
  }
  /// At a point, as reflectance(x, here).
  const float* emitted(const SurfacePoint& x, PointValues& here) const {
    const Side& s = side(x.triangle, x.front);
    if (!s.emission_varies) return emitted(x.triangle, x.front);
    point_emitted(x, here);
    return here.data();
  }
  bool emission_varies(TriangleId t) const { return side(t, true).emission_varies; }
  /// Radiance at an angle to the normal over emitted(): (e+2)/2 cos^e, 1 for Lambertian emission.
  float emission_shape(TriangleId t, float cosine) const {
    const float e = static_cast<float>(surfaces_[surface_of(t)].emission_exponent);
    return e == 0 ? 1.0F : (0.5F * e + 1) * std::pow(cosine, e);
  }
  /// e of Material::emission_exponent.
  double emission_exponent(SurfaceId s) const { return surfaces_[s.index()].emission_exponent; }
  /// Radiance along the normal [W/(m2 sr)] per band.
  const Spectrum& normal_radiance(SurfaceId s) const { return surfaces_[s.index()].normal_radiance; }
  /// Emitted by a square metre of one side [W/m2] per band.
  const Spectrum& exitance(SurfaceId s) const { return surfaces_[s.index()].exitance; }
  /// The same of a zone, which lies on such a side; of textures the mean over the zone.
  Spectrum exitance(ZoneId z, SurfaceId s) const;

  const RoomTextures& textures() const { return *textures_; }
  bool any_cut_outs() const { return !textures_->cut_outs().empty(); }

 private:
  struct OfSurface {
    Spectrum normal_radiance, exitance;
    double emission_exponent;
    bool emits;
  };
  struct Side {  // a byte, because every ray looks at one
    bool reflects : 1;
    bool emits : 1;
    bool reflectance_varies : 1;  // and it reflects
    bool emission_varies : 1;     // and it emits
    bool specular : 1;            // and it reflects
    bool absorbs_before : 1;      // it is the inside of a body of glass that absorbs light
  };
  /// Where the reflectance of a side of a surface stands: all zones have row `first`, or each its own.
  struct Rows {
    std::uint32_t first, mask;
  };

  const Side& side(TriangleId t, bool front) const { return sides_[side_of(t, front).index()]; }
  static std::size_t row_of(std::size_t surface, bool front) { return 2 * surface + (front ? 0 : 1); }
  std::size_t row_of(ZoneId z, TriangleId t, bool front) const {
    const Rows& rows = rows_[row_of(surface_of(t), front)];
    return std::size_t{rows.first} + (static_cast<std::uint32_t>(z.index()) & rows.mask);
  }
  std::size_t surface_of(TriangleId t) const { return surface_[t.index()]; }
  std::size_t pair_of(SurfaceId front, SurfaceId back);
  const float* reflectance(TriangleId t, float u, float v, bool front, float footprint,
                           PointValues& here) const {
    if (!side(t, front).reflectance_varies) return reflectance(t, front);
    textures_->reflectance(t, u, v, footprint * metres_per_unit_, here);
    return here.data();
  }
  void point_emitted(const SurfacePoint& x, PointValues& here) const;
  void add_zone_rows(const ZoneMesh& mesh);

  const RoomTextures* textures_;
  float metres_per_unit_;
  std::size_t bands_;
  bool any_specular_ = false;
  bool any_transmits_ = false;
  std::size_t surface_count_;
  // Surfaces, and then one row for every two whose faces lie back to back: so a triangle is of one row, and
  // no ray asks what it is of.
  std::vector<OfSurface> surfaces_;
  std::vector<SpecularSurface> specular_;  // as surfaces_
  std::map<std::pair<SurfaceId, SurfaceId>, std::size_t> pairs_;
  std::vector<SurfaceId> shown_;     // by surface and side
  std::vector<Rows> rows_;           // by surface and side
  std::vector<double> reflectance_;  // by surface and side, then by zone if any varies
  std::vector<double> largest_reflectance_;
  std::vector<float> side_reflectance_;  // as reflectance_
  std::vector<float> emitted_;           // as surfaces_
  std::vector<double> zone_radiance_;    // along the normal, by zone; empty if none varies
  std::vector<std::uint32_t> surface_;   // of each triangle, a row of surfaces_
  std::vector<Side> sides_;              // by side (mesh/zones/side.h)
  std::vector<float> zero_;
};

}  // namespace reemit
