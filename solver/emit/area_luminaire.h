#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <variant>
#include <vector>

#include "mesh/zones/curved_patch.h"
#include "scenes/model/shape.h"
#include "scenes/model/vec.h"
#include "solver/emit/luminaire_bounds.h"

namespace reemit {

/// A point of a luminaire with an area, drawn for a shading point.
struct AreaSample {
  Vec3 point{0, 0, 0};   ///< Normalised.
  Vec3 normal{0, 0, 1};  ///< Unit, of the emitting side.
  /// What arrives per unit of radiance along the normal over the density of the point [sr]: cos(theta) over
  /// the density per solid angle, times cos^e at the luminaire.
  double factor = 0;
  double pdf_per_sr = 0;  ///< Density of the direction to the point [1/sr].
};

/// One emitting side of a shape with an area, in the normalised space, as direct light sees it. Which density
/// points are drawn from depends on the shape and on how near it is; docs/luminaire_densities.md has the
/// measurements behind it.
class AreaLuminaire {
 public:
  /// Convex planar polygon with 3 to kMostCorners corners in either sense; `front`: unit normal of the side
  /// that emits; `exponent`: e of Material::emission_exponent.
  AreaLuminaire(const std::vector<Vec3>& corners, const Vec3& front, double exponent);
  /// The front of a curved shape. `is_clear`: light crosses the shape straight on, so that an inner side
  /// lights what is outside through the wall before it.
  AreaLuminaire(const CurvedShape& shape, double exponent, bool is_clear = false);

  double area() const { return area_; }
  /// Bounds for a light tree; `radiance`: along the normal, of all bands.
  LuminaireBounds bounds(double radiance) const;

  /// About the irradiance at x (unit normal n) per unit of radiance if nothing is in the way: of polygons,
  /// spheres and disks with Lambertian emission that are near exact up to rounding; beyond twice the radius
  /// of the sphere around them as if all were in the middle, within some 20 %. Above 0 wherever any point of
  /// the side can light x ([SWZ96, sec. 4.2] on wrong zeros).
  double expected_irradiance(const Vec3& x, const Vec3& n) const;

  /// Draws a point for two uniform numbers. False if it cannot light x.
  bool sample(const Vec3& x, const Vec3& n, double u0, double u1, AreaSample& result) const;

 private:
  struct Rectangle {
    Vec3 corner, edge_u, edge_v;
  };
  struct Triangle {
    std::array<Vec3, 3> corners;
  };
  struct Polygon {
    std::vector<Vec3> corners;
  };
  /// Cones, rings and the inside of clear cylinders: drawn by area.
  struct Mantle {
    std::shared_ptr<const CurvedPatches> patches;  // aside: it is large, and the table should stay in cache
  };
  using Shape = std::variant<Rectangle, Triangle, Polygon, Sphere, Disk, Cylinder, Mantle>;

  double expected_near(const Vec3& x, const Vec3& n) const;
  double expected_far(const Vec3& to_centre, double height, double distance2) const;
  bool faces_away(const Vec3& x) const;

  Shape shape_;
  Vec3 centre_;   // of a sphere that holds the shape
  double reach_;  // its radius
  Vec3 front_;    // of flat shapes; the axis of mantles
  bool flat_ = true;
  bool is_clear_ = false;
  double area_ = 0;
  double exponent_ = 0;
};

}  // namespace reemit
