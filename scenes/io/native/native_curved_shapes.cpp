#include <cmath>
#include <numbers>
#include <utility>

#include "scenes/io/common/surface_geometry.h"
#include "scenes/io/native/native_shapes.h"
#include "scenes/model/limits.h"

namespace reemit {

namespace {

using Index = std::uint32_t;

constexpr int kDefaultSegments = 24;
constexpr int kMostSegments = 1024;

int read_segments(const JsonCursor& at) {
  const auto segments = at.find("segments");
  return segments ? segments->integer_in(3, kMostSegments) : kDefaultSegments;
}

bool is_inward(const JsonCursor& at) {
  const auto inward = at.find("inward");
  return inward && inward->boolean();
}

void flip_if_inward(const JsonCursor& at, Surface& shape) {
  if (is_inward(at)) flip_surface(shape);
}

/// A shape that is kept as it is; with a number of segments it would become flat faces.
Surface exact(const CurvedShape& shape) {
  Surface surface;
  surface.shapes.push_back(shape);
  return surface;
}

/// Two unit vectors u, v with u x v = axis (unit).
std::pair<Vec3, Vec3> frame_around(const Vec3& axis) {
  const Vec3 u = axis.unitOrthogonal();
  return {u, axis.cross(u)};
}

Vec3 direction_at(const std::pair<Vec3, Vec3>& frame, int i, int segments) {
  const double angle = 2 * std::numbers::pi * i / segments;
  return std::cos(angle) * frame.first + std::sin(angle) * frame.second;
}

/// A ring of `segments` vertices; returns the index of the first.
Index append_ring(Surface& shape, const Vec3& centre, const std::pair<Vec3, Vec3>& frame, double radius,
                  int segments) {
  const Index first = static_cast<Index>(shape.positions.size());
  for (int i = 0; i < segments; ++i) {
    shape.positions.push_back(centre + radius * direction_at(frame, i, segments));
  }
  return first;
}

std::vector<Index> ring_loop(Index first, int segments, bool reversed) {
  std::vector<Index> loop(static_cast<std::size_t>(segments));
  for (std::size_t i = 0; i < loop.size(); ++i) {
    loop[reversed ? loop.size() - 1 - i : i] = first + static_cast<Index>(i);
  }
  return loop;
}

/// A cylinder or cone; a tip has no cap.
struct GivenCylinder {
  Vec3 base{0, 0, 0}, top{0, 0, 1};
  double radius = 1, top_radius = 1;
  bool base_cap = true, top_cap = true;

  double height() const { return (top - base).norm(); }
  Vec3 axis() const { return (top - base) / height(); }
};

Surface exact(const GivenCylinder& given) {
  Surface shape = given.top_radius == given.radius
                      ? exact(Cylinder{given.base, given.top, given.radius, false})
                      : exact(Cone{given.base, given.top, given.radius, given.top_radius, false});
  if (given.base_cap) shape.shapes.emplace_back(Disk{given.base, -given.axis(), given.radius, 0});
  if (given.top_cap) shape.shapes.emplace_back(Disk{given.top, given.axis(), given.top_radius, 0});
  return shape;
}

Surface tessellated(const GivenCylinder& given, int segments) {
  const Vec3 axis = given.axis();
  const auto frame = frame_around(axis);
  Surface shape;
  const Index lower = append_ring(shape, given.base, frame, given.radius, segments);
  const bool pointed = given.top_radius == 0;
  const Index upper = static_cast<Index>(shape.positions.size());
  if (pointed) {
    shape.positions.push_back(given.top);
  } else {
    append_ring(shape, given.top, frame, given.top_radius, segments);
  }
  for (int i = 0; i < segments; ++i) {
    // The mantle rises by height while the radius changes, so its normal leans by their ratio.
    shape.normals.push_back(
        (direction_at(frame, i, segments) * given.height() + axis * (given.radius - given.top_radius))
            .normalized());
  }
  for (int i = 0; i < segments; ++i) {
    const auto here = static_cast<Index>(i);
    const auto next = static_cast<Index>((i + 1) % segments);
    if (pointed) {
      const auto apex_normal = static_cast<Index>(shape.normals.size());
      shape.normals.push_back((shape.normals[here] + shape.normals[next]).normalized());
      shape.faces.push_back({{lower + here, lower + next, upper}, {}, {here, next, apex_normal}, 0});
    } else {
      shape.faces.push_back(
          {{lower + here, lower + next, upper + next, upper + here}, {}, {here, next, next, here}, 0});
    }
  }
  if (given.base_cap) shape.faces.push_back({ring_loop(lower, segments, true), {}, {}, 0});
  if (given.top_cap) shape.faces.push_back({ring_loop(upper, segments, false), {}, {}, 0});
  return shape;
}

}  // namespace

Surface read_sphere(const JsonCursor& at) {
  at.expect_object({"center", "radius", "segments", "rings", "inward"});
  const Vec3 centre = at.at("center").place();
  const double radius = at.at("radius").length();
  if (!at.find("segments") && !at.find("rings")) return exact(Sphere{centre, radius, is_inward(at)});
  const int segments = read_segments(at);
  const auto given_rings = at.find("rings");
  const int rings = given_rings ? given_rings->integer_in(2, kMostSegments) : std::max(2, segments / 2);
  Surface shape;
  // Poles on the y axis; vertex k of the inner rings stands at 1 + (ring - 1) * segments + segment.
  shape.normals.push_back(Vec3::UnitY());
  for (int ring = 1; ring < rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int i = 0; i < segments; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / segments;
      shape.normals.emplace_back(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                 std::sin(polar) * std::cos(azimuth));
    }
  }
  shape.normals.push_back(-Vec3::UnitY());
  for (const Vec3& normal : shape.normals) shape.positions.push_back(centre + radius * normal);
  const auto south = static_cast<Index>(shape.positions.size() - 1);
  const auto vertex = [&](int ring, int i) {
    if (ring == 0) return Index{0};
    if (ring == rings) return south;
    return static_cast<Index>(1 + (ring - 1) * segments + i % segments);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < segments; ++i) {
      std::vector<Index> loop{vertex(ring, i), vertex(ring + 1, i)};
      if (ring + 1 < rings) loop.push_back(vertex(ring + 1, i + 1));
      if (ring > 0) loop.push_back(vertex(ring, i + 1));
      if (ring == 0) loop = {vertex(0, i), vertex(1, i), vertex(1, i + 1)};
      shape.faces.push_back({loop, {}, loop, 0});
    }
  }
  flip_if_inward(at, shape);
  return shape;
}

Surface read_cylinder(const JsonCursor& at) {
  at.expect_object({"base", "top", "radius", "top_radius", "segments", "caps", "inward"});
  GivenCylinder given;
  given.base = at.at("base").place();
  given.top = at.at("top").place();
  if (!((given.top - given.base).norm() > 0))
    at.at("top").fail("base and top are the same point", "Give the ends of the axis.");
  given.radius = at.at("radius").length();
  const auto top_radius = at.find("top_radius");
  given.top_radius = top_radius ? top_radius->number_in(0, limits::kFarthest) : given.radius;
  const auto given_caps = at.find("caps");
  const std::string caps = given_caps ? given_caps->choice({"both", "base", "top", "none"}) : "both";
  given.base_cap = caps == "both" || caps == "base";
  given.top_cap = (caps == "both" || caps == "top") && given.top_radius > 0;
  Surface shape = at.find("segments") ? tessellated(given, read_segments(at)) : exact(given);
  flip_if_inward(at, shape);
  return shape;
}

Surface read_disk(const JsonCursor& at) {
  at.expect_object({"center", "normal", "radius", "inner_radius", "segments"});
  const Vec3 centre = at.at("center").place();
  const Vec3 normal = at.at("normal").vec3();
  if (!(normal.norm() > 0)) at.at("normal").fail("the normal has no length", "Give a direction.");
  const double radius = at.at("radius").length();
  const auto inner = at.find("inner_radius");
  const double inner_radius = inner ? inner->length() : 0;
  if (inner_radius >= radius)
    inner->fail("the hole is as large as the disk", "Make it smaller than the radius.");
  if (!at.find("segments")) return exact(Disk{centre, normal.normalized(), radius, inner_radius});
  const int segments = read_segments(at);
  const auto frame = frame_around(normal.normalized());
  Surface shape;
  Face face;
  face.outer = ring_loop(append_ring(shape, centre, frame, radius, segments), segments, false);
  if (inner) {
    face.holes.push_back(
        ring_loop(append_ring(shape, centre, frame, inner_radius, segments), segments, true));
  }
  shape.faces.push_back(std::move(face));
  return shape;
}

}  // namespace reemit
