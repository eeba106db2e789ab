#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// Where curved shapes stand on flat triangles, so that neither carries light to the wrong side. Lengths are
/// those of the corners and shapes given, normalised as in RayTracer.
///
/// A mantle (cylinder, cone) stands on a circle, but the face below is cut along a polygon inscribed in it,
/// so a triangle outside the polygon reaches under the mantle by a circle's segment. It stays on one side all
/// the same: what arrives within the mantle belongs to the triangles within the polygon, and rays leave from
/// points beside the mantle.
///
/// A sphere touches a face, a disk or another sphere in a point, and a mantle that lies on a face or a disk
/// does so in a line. There the gap is narrower than the distance by which rays start off their surface: they
/// leave from where it is wide enough, on either surface.
class ShapeFeet {
 public:
  ShapeFeet() = default;
  /// `corners`: three per triangle of the mesh. `shapes`: as BaseMesh::shapes.
  ShapeFeet(const ZoneMesh& mesh, const std::vector<Vec3f>& corners, std::span<const CurvedShape> shapes);

  /// Flat triangles under or beside which a shape stands.
  const std::vector<std::uint32_t>& triangles() const { return triangles_; }
  /// Whether a flat triangle is one of them.
  bool is_foot_at(std::size_t triangle) const {
    return triangle < index_.size() && index_[triangle] != kNowhere;
  }
  /// Start of a ray that leaves one of triangles() at about `start`: clear of the shapes on it.
  Vec3f clear_of_shapes(std::size_t triangle, const Vec3f& start) const;

  struct Place {
    std::uint32_t triangle;
    float u, v;
  };
  /// Where a hit of one of triangles() belongs, of a ray that came `distance` along `direction` (unit).
  Place place_of(const Place& hit, const Vec3& origin, const Vec3& direction, double distance) const;

  /// Whether faces or other shapes touch the shape, so that clear_of_others() may move points.
  bool touches_others(std::size_t shape) const {
    return shape < resting_.size() && !(resting_[shape].empty() && touched_[shape].empty());
  }
  /// A point of the shape, moved along it until nothing that touches it is nearer than a ray start needs.
  Vec3 clear_of_others(std::size_t shape, const Vec3& point) const;

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffff;

  using Corners = std::array<Vec3, 3>;
  struct Target {
    std::uint32_t triangle;
    Corners corners;
  };
  /// Circle in which a mantle stands on a plane.
  struct Foot {
    Vec3 centre;
    Vec3 up;  // unit, into the mantle
    Vec3 u;   // unit, towards a corner of the inscribed polygon
    double radius;
    double height;
    double widening;             // of the radius per height
    std::vector<Target> within;  // triangles inside the polygon
  };
  /// Point or line in which a shape touches a plane, as the plane sees it.
  struct Touch {
    Vec3 from;
    Vec3 along;    // to the end of the line; 0 for a point
    Vec3 normal;   // of the plane, unit
    Vec3 aside;    // unit, in the plane, across the line
    double clear;  // distance at which the gap is wide enough
  };
  /// The same as the shape sees it.
  struct Resting {
    Vec3 base;         // the centre of a sphere, or a point of the axis
    Vec3 axis;         // unit; 0 for spheres
    Vec3 low;          // unit, across the axis, to where it touches
    double steepness;  // height over the plane per distance against `low`
  };
  struct OnTriangle {
    std::vector<std::uint32_t> beside;   // feet that it reaches under from outside
    std::vector<std::uint32_t> touched;  // by which touches
  };

  void add_mantle(const Frustum& f, const ZoneMesh& mesh, std::span<const Target> near);
  void add_foot(Foot foot, const ZoneMesh& mesh, std::span<const Target> near);
  /// How a shape touches a plane through `on_plane`.
  struct Contact {
    Resting resting;
    Touch touch;
  };
  static std::optional<Contact> contact(const CurvedShape& s, const Vec3& on_plane, const Vec3& normal);
  /// Notes the contact of a shape with a part of a plane, whose distance from a point is given, and returns
  /// the number of the touch as the plane sees it; nothing if the two do not meet.
  template <class Distance>
  std::optional<std::uint32_t> rest(std::size_t shape, const CurvedShape& s, const Vec3& on_plane,
                                    const Vec3& normal, Distance&& distance);
  void add_resting(std::size_t shape, const CurvedShape& s, const Target& face, const Vec3& normal);
  void add_resting_on_disk(std::size_t shape, const CurvedShape& s, std::size_t disk_shape, const Disk& disk);
  void add_spheres(std::size_t a, const Sphere& sphere_a, std::size_t b, const Sphere& sphere_b);
  Vec3 clear_of(const std::vector<std::uint32_t>& touches, Vec3 point) const;
  OnTriangle& at(std::uint32_t triangle);

  std::vector<Foot> feet_;
  std::vector<Touch> touches_;
  std::vector<std::vector<Resting>> resting_;        // by shape
  std::vector<std::vector<std::uint32_t>> touched_;  // by shape: touches of disks that others rest on
  std::vector<std::uint32_t> triangles_;
  std::vector<OnTriangle> on_;        // as triangles_
  std::vector<std::uint32_t> index_;  // by triangle, in triangles_
};

}  // namespace reemit
