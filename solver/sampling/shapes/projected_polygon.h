#pragma once
#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "scenes/model/vec.h"
#include "solver/sampling/shapes/clipped_polygon.h"

namespace reemit {

/// Lambert's formula [sr]: irradiance per radiance of a polygon with these corners relative to the receiver,
/// none below its horizon (normal n); lengths of the corner vectors do not matter.
double lambert_irradiance(std::span<const Vec3> corners, const Vec3& n);

/// Directions to a convex polygon above the horizon, uniform in cos(theta) d omega, that is in the
/// orthographic projection on the tangent plane [PET21]; successor of p7 and p9 of [SWZ96]. Edges project to
/// arcs of ellipses about the origin, and the sector between such an arc and the origin has the area (term of
/// Lambert's formula) 1/2 n . m times the angle of the edge, m the unit normal of its plane through x. If the
/// zenith is inside, sectors are chosen by area and a point of the edge uniformly in angle. If not, azimuth
/// intervals with one outer and one inner arc are chosen, the azimuth by inverting the difference of two
/// sectors, the squared radius uniformly between the arcs.
class ProjectedPolygon {
 public:
  /// `n`: unit normal at the shading point that `polygon` is relative to.
  ProjectedPolygon(const ClippedPolygon& polygon, const Vec3& n);

  /// Lambert's formula [sr]; 0 if nothing is left.
  double projected_solid_angle() const { return total_; }
  Vec3 sample(double u0, double u1) const;  ///< Unit.
  std::array<double, 2> invert(const Vec3& direction) const;

 private:
  using Vec2 = Eigen::Vector2d;

  /// Zenith inside: the arc from `start` (unit) along the tangent `along` (unit).
  struct Sector {
    Vec3 start, along;
    double angle, area_to;
  };
  /// Zenith outside: azimuths from direction d0 over `width` radians. The plane of an edge is
  /// z = slope . (x, y).
  struct Strip {
    Vec2 d0, outer, inner;
    double width, area_to, area;
  };
  // Either kind has at most one part per corner, and one more for a zero-width start.
  static constexpr std::size_t kMostParts = kMostCorners + 2;

  void add_sectors(const std::array<Vec3, kMostCorners + 1>& q, std::size_t count);
  void add_strips(const std::array<Vec3, kMostCorners + 1>& q, std::size_t count);
  Vec3 to_world(const Vec3& local) const { return local.x() * e1_ + local.y() * e2_ + local.z() * n_; }

  Vec3 e1_, e2_, n_;
  std::size_t count_ = 0;
  bool zenith_inside_ = false;
  double total_ = 0;
  std::array<Sector, kMostParts> sectors_;
  std::array<Strip, kMostParts> strips_;
};

}  // namespace reemit
