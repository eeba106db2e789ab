#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/zones/side.h"
#include "scenes/model/vec.h"

namespace reemit {

/// Least cosine between normals of points of one face, or of faces that go on about as each other do.
inline constexpr float kSameFace = 0.8F;

/// Packets of luminaires that came to Lambertian surfaces over mirrors, glass or narrow gloss.
struct CausticPhotons {
  std::vector<Vec3f> places;          ///< Normalised.
  std::vector<Vec3f> normals;         ///< Unit, of the side that was met.
  std::vector<float> power;           ///< [photon * bands + band] [W]
  std::vector<TriangleId> triangles;  ///< That was met.
  std::vector<SurfaceId> luminaires;  ///< That they come from; not valid for lights without area.

  std::vector<std::uint8_t> radius_codes;  ///< Of the kernels, once they are set (photon_radii.h).

  std::size_t size() const { return places.size(); }
  void append(const CausticPhotons& more);
  /// True if photon i, within a radius of a place, met the face there or one that goes on as it does.
  bool is_on_face(std::uint32_t i, const Vec3f& normal, const Vec3f& place, float radius) const;
};

/// One estimate of the light from several, whose photons become parts of it.
CausticPhotons mean_of(std::vector<CausticPhotons> estimates);

}  // namespace reemit
