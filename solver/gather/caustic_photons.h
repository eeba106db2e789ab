#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/zones/side.h"
#include "scenes/model/vec.h"

namespace reemit {

/// Least cosine between normals of points of one face, or of faces that go on about as each other do.
inline constexpr float kSameFace = 0.8F;

/// True if places of these unit normals, `way` apart, may lie on one face: neither stands higher over the
/// other's plane than a face that bends from the one normal to the other could bring it. What lies over a
/// face at a hair's breadth, as the housing of a lamp under a cupboard, is not of that face.
inline bool is_level(const Vec3f& normal, const Vec3f& other_normal, const Vec3f& way) {
  constexpr float kRounding = 3e-6F;  // of places, normalised
  const float most = way.norm() * normal.cross(other_normal).norm() + kRounding;
  return std::fabs(way.dot(normal)) < most && std::fabs(way.dot(other_normal)) < most;
}

/// Packets of luminaires that came to Lambertian surfaces, or crossed sheets in the air, over mirrors, glass
/// or narrow gloss.
struct CausticPhotons {
  bool in_air = false;                ///< All on sheets; else all on surfaces.
  std::vector<Vec3f> places;          ///< Normalised.
  std::vector<Vec3f> normals;         ///< Unit, of the side that was met.
  std::vector<float> power;           ///< [photon * bands + band] [W]
  std::vector<TriangleId> triangles;  ///< That was met; in the air the number of the sheet.
  std::vector<SurfaceId> luminaires;  ///< That they come from; not valid for lights without area.

  std::vector<std::uint8_t> radius_codes;  ///< Of the kernels, once they are set (photon_radii.h).

  std::size_t size() const { return places.size(); }
  void append(const CausticPhotons& more);
  /// Where light comes to: on a side of a face, or of a sheet.
  struct Place {
    Vec3f at;      ///< Normalised.
    Vec3f normal;  ///< Unit.
    TriangleId triangle;
  };
  Place place(std::uint32_t i) const { return {places[i], normals[i], triangles[i]}; }
  /// True if photon i, within a radius of a place, met the face there or one that goes on as it does; in the
  /// air the same sheet.
  bool is_on_face(std::uint32_t i, const Place& place, float radius) const;
};

/// Photons of some packets.
struct PhotonCatch {
  PhotonCatch() { in_air.in_air = true; }

  CausticPhotons on_surfaces, in_air;
};

/// One estimate of the light from several, whose photons become parts of it.
CausticPhotons mean_of(std::vector<CausticPhotons> estimates);

}  // namespace reemit
