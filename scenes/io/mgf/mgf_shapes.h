#pragma once
#include <span>
#include <string>
#include <vector>

#include "scenes/io/common/polygon_loops.h"
#include "scenes/io/mgf/mgf_contexts.h"
#include "scenes/model/shape.h"

namespace reemit {

/// How torus, which is closed by itself, is tessellated.
struct MgfRoundness {
  int segments = 32;  ///< Per full circle, divisible by 8.
  bool keep_area =
      false;  ///< Enlarge the shape a little so that its area, and with it a luminaire's power, is exact.
};

/// Luminaires: 32 segments, exact area. Others: as many as keep the faces within 1 mm of the shape, from 16
/// to 32.
MgfRoundness mgf_roundness(double radius_m, bool emits);

// Each function returns the faces or the shape of one MGF entity, in the coordinates of its vertices, fronts
// as the description of the entity says [MGF]. A torus carries shading normals, prisms and polygons only if
// their vertices do. They throw InputError at `where` when the entity is illegal: wrong sign or zero of a
// radius, coinciding ends, ...

/// f and fh: the first loop is the outline, the rest are holes. Seams are turned into holes.
std::vector<Polygon> mgf_face(const std::vector<std::vector<MgfVertex>>& loops, const std::string& where);
/// Extends behind the outline, whose front looks out of it; with a negative length before it, and all faces
/// look inwards.
std::vector<Polygon> mgf_prism(std::span<const MgfVertex> outline, double length, const std::string& where);
/// A negative radius faces inwards.
CurvedShape mgf_sphere(const Vec3& centre, double radius, const std::string& where);
/// cyl and cone; negative radii face inwards.
CurvedShape mgf_cone(const Vec3& a, double radius_a, const Vec3& b, double radius_b,
                     const std::string& where);
/// A disk about the normal of its vertex, with a hole if `inner` is above 0: 0 <= inner < outer.
CurvedShape mgf_ring(const MgfVertex& centre, double inner, double outer, const std::string& where);
/// About the normal of its vertex; `inner`, `outer`: radii of the smallest and of the largest circle,
/// negative ones face inwards.
std::vector<Polygon> mgf_torus(const MgfVertex& centre, double inner, double outer,
                               const MgfRoundness& roundness, const std::string& where);

}  // namespace reemit
