#pragma once
#include <array>
#include <optional>

#include "solver/sampling/shapes/polygon_sampler.h"
#include "solver/sampling/shapes/shape_density.h"

namespace reemit {

/// Rectangle, front side emitting: p5 (kArea), p6 (kSolidAngle, the map of [URE13]) and p7 (kCosine) of
/// [SWZ96] sec. 3.3.3. kVisibleArea and kCosine, and kSolidAngle where the horizon cuts the rectangle or x is
/// so near its plane that the map loses its digits, are those of ConvexPolygonSampler.
class RectangleSampler {
 public:
  /// `edge_u` and `edge_v` leave `corner` at right angles; `front`: unit normal of the emitting side.
  RectangleSampler(const Vec3& corner, const Vec3& edge_u, const Vec3& edge_v, const Vec3& front,
                   const Vec3& x, const Vec3& n, Density density);

  bool lights() const { return lights_; }
  Density density() const { return density_; }
  ShapePoint sample(double u0, double u1) const;
  double pdf_per_sr(const Vec3& point) const;
  std::array<double, 2> invert(const Vec3& point) const;
  double irradiance() const;  ///< Lambert's formula [sr].

 private:
  bool set_up_solid_angle();
  double slab_angle(double sine) const;

  Vec3 corner_, edge_u_, edge_v_, front_, x_, n_;
  bool lights_ = false;
  Density density_;
  double height_ = 0;  // of x above the plane
  double extent_ = 0;  // area [m2] or solid angle [sr]
  // The rectangle in coordinates of its plane about the foot point of x [m].
  Vec3 unit_u_, unit_v_;
  double u_low_ = 0, u_high_ = 0, v_low_ = 0, v_high_ = 0;
  double b_low_ = 0, b_high_ = 0;  // v / hypot(v, height)
  double angle_low_ = 0;           // of the slab u < u_low
  std::optional<ConvexPolygonSampler> polygon_;
};

}  // namespace reemit
