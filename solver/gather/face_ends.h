#pragma once
#include <cstddef>

#include "solver/trace/ray_tracer.h"

namespace reemit {

/// Share of a kernel's radius by which rays along a face look above it for what stands there.
inline constexpr float kLiftOverFace = 0.1F;

/// What of a round kernel over a place of a surface lies on the face there, and what makes up for the rest.
/// All lengths are normalised; `normal` is that of the side of the face, unit. Const members may be called
/// from any thread.
class FaceEnds {
 public:
  /// A kernel on a face.
  struct Kernel {
    float share = 1;  ///< Of it, on the face.
    float gain = 1;   ///< What makes up for the rest.
  };

  /// `flat_count`: base triangles that are flat, as ZoneMesh::flat_count. The tracer must outlive it.
  FaceEnds(const RayTracer& rays, std::size_t flat_count) : rays_(&rays), flat_count_(flat_count) {}

  /// True if something stands on the face within the radius.
  bool is_beside_wall(const Vec3f& normal, const Vec3f& place, float radius) const;
  /// True only if the whole kernel lies on this triangle, but for what stands on it.
  bool is_inside_triangle(TriangleId triangle, const Vec3f& place, float radius) const;
  /// The gain g of a place is such that sum K(x, y) g(x) g(y) over a face is 1 at all its places: photons y
  /// that count at points x by the kernel K(x, y) = 2/(pi r^2) (1 - |x-y|^2/r^2) then bring what they have,
  /// no more and no less, and even light is even up to the ends of the face. It is found on a patch of places
  /// around this one by the scaling of [SK67] in the symmetric form, as exact as 64 places are: within 2 % at
  /// the end of a half plane and on strips as wide as half the radius, 4 % in corners and on faces that are
  /// smaller. `turn` in [0,1) places the places. `beside_wall`: rays along the face look what is beyond a
  /// wall.
  Kernel kernel(const Vec3f& normal, const Vec3f& place, float radius, float turn, bool beside_wall) const;

 private:
  const RayTracer* rays_;
  std::size_t flat_count_;
};

}  // namespace reemit
