#pragma once
#include "scenes/model/material.h"
#include "scenes/model/vec.h"

namespace reemit {

/// A spread reflection for light that arrives from and goes to unit directions about +z, both above the
/// surface, as of a surface that reflects all light that the lobe sends anywhere. Symmetric in the two.
struct GlossValue {
  float brdf_per_sr = 0;
  float pdf_per_sr = 0;   ///< Density with which GlossModel::sample draws the second for the first.
  float half_cosine = 1;  ///< Of either to the normal of the facet that mirrors one to the other.
};

/// The lobes of rough surfaces. Reflected in all is never more than what arrives; docs/materials.md has what
/// is lost by roughness.
/// GGX: microfacets with Smith masking, heights correlated, facets drawn as they are seen [HEI18].
/// Ward: exp(-tan^2/alpha^2) of the half vector, normalised so that nothing is gained [GMD10].
/// Phong: cos^n about the mirror direction, not divided by a cosine [LW94].
class GlossModel {
 public:
  GlossModel() = default;
  /// `alpha` > 0: NonDiffusePart::roughness.
  GlossModel(GlossLobe lobe, double alpha);

  /// Direction `to` of light seen from `from` for two uniform numbers. False if it would lie below the
  /// surface: that light is lost.
  bool sample(const Vec3f& from, float u0, float u1, Vec3f& to) const;
  GlossValue value(const Vec3f& from, const Vec3f& to) const;

  /// Normal of a microfacet of GGX as seen from `from`; its density is that of sample() for the direction
  /// mirrored there. For surfaces that light also crosses.
  Vec3f sample_facet(const Vec3f& from, float u0, float u1) const;
  /// Share of the facets seen from a direction that are not hidden, G1 of GGX; of either side.
  float unmasked(const Vec3f& direction) const;

 private:
  GlossValue ggx(const Vec3f& from, const Vec3f& to) const;
  GlossValue ward(const Vec3f& from, const Vec3f& to) const;
  GlossValue phong(const Vec3f& from, const Vec3f& to) const;

  GlossLobe lobe_ = GlossLobe::kGgx;
  float alpha_ = 1;
  float exponent_ = 0;  // of Phong
};

}  // namespace reemit
