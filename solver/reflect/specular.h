#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "scenes/model/material.h"
#include "solver/reflect/gloss.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// A way on from a surface.
enum class SpecularWayOn {
  kMirror,   ///< Into the mirror direction, or near it where the surface is rough.
  kAcross,   ///< Straight on or refracted, or near that.
  kDiffuse,  ///< Across, into all directions alike.
};

/// What becomes of diffuse transmission where a ray meets it.
enum class DiffuseWay {
  kFollowed,     ///< It is one of the ways on.
  kNotFollowed,  ///< It is found apart: in what zones hold (RadianceField), or by light on the other side.
};

/// How light goes on from a surface as one ray. To be used from hit to hit, so that memory is asked for once;
/// a room without such surfaces needs one of no bands.
struct SpecularStep {
  explicit SpecularStep(std::size_t bands) : reflected(bands), transmitted(bands), diffuse(bands) {}

  std::vector<float> reflected;    ///< By band, share of the arriving light [0,1].
  std::vector<float> transmitted;  ///< Likewise, straight on or refracted.
  std::vector<float> diffuse;      ///< Likewise, let through into all directions.
  Vec3f direction{0, 0, 1};        ///< Of the way that was chosen; unit.
  bool front = true;               ///< Side of the surface that it leaves from.
  SpecularWayOn way = SpecularWayOn::kMirror;
  bool bends = true;     ///< It is not the straight way on, so shadow rays do not find it.
  bool is_wide = false;  ///< A lobe spreads it so far that shadow rays find its light best.
  float chance = 0;      ///< Of this choice (0,1].
  DiffuseWay diffuse_way = DiffuseWay::kFollowed;  ///< Set by whoever asks.
  /// Density of the direction [1/sr] where DirectLight finds luminaires there too; 0 where it does not.
  float pdf_per_sr = 0;

  /// By band, the share of the arriving light that goes this way; of rough surfaces, what their lobe sends
  /// there over the density.
  const std::vector<float>& share() const {
    return way == SpecularWayOn::kMirror ? reflected : way == SpecularWayOn::kAcross ? transmitted : diffuse;
  }
  std::vector<float>& share() { return const_cast<std::vector<float>&>(std::as_const(*this).share()); }
  bool crosses() const { return way != SpecularWayOn::kMirror; }
};

/// How often the ways on from a surface are chosen.
enum class Survival {
  kRoulette,  ///< Each with its largest share over the bands; else the ray ends.
  kCertain,   ///< In proportion to these; the ray always goes on.
};

/// What of a material is carried on by rays: reflection and transmission, sharp or as the lobes of gloss.h,
/// and diffuse transmission, whose radiance is tau/pi times the irradiance of the other side.
/// What a rough thin sheet lets through is what it would reflect, mirrored at it; rough bodies of glass
/// refract at the facets of GGX [WAL07]. With the Lambertian part it never adds up to more than the light
/// that arrives. Light that goes on and back along the same way meets the same shares, so a ray may be
/// followed from either end; radiance is meant as that of vacuum, L/n^2.
class SpecularSurface {
 public:
  SpecularSurface() = default;
  /// `metres_per_unit`: of the space in which distances are given.
  SpecularSurface(const Material& material, double metres_per_unit);

  bool exists() const { return reflects_ || transmits_ || diffuses_; }
  bool transmits() const { return transmits_; }
  bool lets_light_through() const { return transmits_ || diffuses_; }
  /// Light is let through into all directions.
  bool diffuses() const { return diffuses_; }
  /// Light crosses it straight on.
  bool is_pane() const { return transmits_ && !solid_ && !rough_across_; }
  /// Light is bent where it crosses; the back is the inside of a body.
  bool is_body() const { return transmits_ && solid_; }
  bool absorbs_inside() const { return !absorption_.empty(); }
  bool is_rough() const { return rough_mirror_ || rough_across_; }
  /// By band, the share that is let through into all directions.
  const std::vector<float>& diffuse_transmittance() const { return diffuse_; }
  /// Whether anything goes on but by lobes that are wide (SpecularStep::is_wide).
  bool sends_narrowly() const { return (reflects_ && !wide_mirror_) || (transmits_ && !wide_across_); }
  /// Ways on are drawn with two numbers besides that which chooses one.
  bool is_spread() const { return is_rough() || diffuses_; }
  /// Whether light that DirectLight finds is spread on a way: by the reflected lobe, by that of a thin sheet,
  /// by diffuse transmission.
  bool spreads(SpecularWayOn way) const {
    if (way == SpecularWayOn::kDiffuse) return diffuses_;
    return (way == SpecularWayOn::kMirror ? rough_mirror_ : rough_across_) && !solid_;
  }

  /// Shares of the light that arrives at `cosine` (0,1] to the normal of a side. Returns the sum of the
  /// chances that the ways would have by roulette; it may be above 1 where bands differ.
  float shares(float cosine, bool front, SpecularStep& step) const;
  /// Not less than what shares() returns, for a fraction of its time; 1 or more where that says little.
  float most_shares(float cosine) const {
    if (solid_ || law_ == AngleLaw::kDielectric) return 1;
    if (law_ != AngleLaw::kSchlick) return most_shares_;
    const float d = 1 - std::clamp(cosine, 0.0F, 1.0F);
    return most_shares_ + d * d * d * d * d;
  }
  /// Chooses a way for light seen from x.towards by a number that is uniform in [0,most); 0 < most <= 1 is
  /// what all chances may add up to. Two uniform numbers spread it. False if it ends here.
  bool choose(const SurfacePoint& x, float u, const std::array<float, 2>& spread, Survival survival,
              SpecularStep& step, float most = 1) const;
  /// Takes one of the ways for certain. False if nothing goes there.
  bool take(const SurfacePoint& x, SpecularWayOn way, const std::array<float, 2>& spread,
            SpecularStep& step) const;
  /// For light that comes by one of the ways from a unit direction: step.share() becomes the BRDF or BTDF
  /// [1/sr] by band, seen from x.towards, and step.pdf_per_sr the density with which the way would be drawn
  /// there. False if it spreads nothing there.
  bool value(const SurfacePoint& x, SpecularWayOn way, const Vec3f& from, SpecularStep& step) const;
  /// Radiance outside of the body over radiance inside of it, n^-2, as refraction bundles light [WAL07]; 1
  /// for other surfaces.
  float radiance_outside() const { return is_body() ? static_cast<float>(1 / (ior_ * ior_)) : 1.0F; }
  /// What is left of light after a way inside the body that ended on this surface, of one band; the way is in
  /// the units of the constructor.
  float left_inside(std::size_t band, float way) const;

  /// Roughness above which SpecularStep::is_wide.
  static constexpr double kWide = 0.2;

 private:
  /// Finds the direction of the way of `step`. False if a lobe sends it nowhere.
  bool turn(const SurfacePoint& x, const std::array<float, 2>& spread, SpecularStep& step) const;
  void turn_anywhere_across(const SurfacePoint& x, const std::array<float, 2>& spread,
                            SpecularStep& step) const;
  bool turn_by_lobe(const SurfacePoint& x, const std::array<float, 2>& spread, SpecularStep& step) const;
  bool is_rough_body() const { return solid_ && rough_across_; }
  /// Facet that light seen from x.towards meets on rough glass, in the frame of the normal.
  Vec3f facet_of(const SurfacePoint& x, const std::array<float, 2>& spread) const;
  bool turn_at_facet(const SurfacePoint& x, const std::array<float, 2>& spread, SpecularStep& step) const;

  bool reflects_ = false;
  bool transmits_ = false;
  bool diffuses_ = false;
  bool solid_ = false;
  bool rough_mirror_ = false;
  bool rough_across_ = false;
  bool wide_mirror_ = false;
  bool wide_across_ = false;
  GlossModel mirror_lobe_, across_lobe_;
  AngleLaw law_ = AngleLaw::kConstant;
  double ior_ = 1;
  std::vector<double> eta_, k_;       // by band, of metals
  std::vector<float> most_;           // by band: what the Lambertian parts leave
  std::vector<float> reflectance_;    // by band
  std::vector<float> transmittance_;  // by band
  std::vector<float> diffuse_;        // by band
  std::vector<float> absorption_;     // by band, per unit; empty = none
  float most_shares_ = 0;             // of all ways, along the normal where these follow Schlick's law
};

}  // namespace reemit
