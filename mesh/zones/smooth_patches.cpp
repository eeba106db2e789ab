#include "mesh/zones/smooth_patches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "mesh/geometry/disjoint_sets.h"

namespace reemit {
namespace {

struct TriangleEdge {
  std::uint64_t key;
  std::uint32_t triangle;
  int edge;
  bool forward;  // from the smaller to the larger vertex index
};

std::vector<TriangleEdge> sorted_edges(const BaseMesh& base) {
  std::vector<TriangleEdge> uses;
  uses.reserve(3 * base.triangles.size());
  for (std::size_t t = 0; t < base.triangles.size(); ++t) {
    const auto& v = base.triangles[t].vertex;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = v[k];
      const std::uint64_t b = v[(k + 1) % 3];
      uses.push_back({(std::min(a, b) << 32) | std::max(a, b), static_cast<std::uint32_t>(t),
                      static_cast<int>(k), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const TriangleEdge& x, const TriangleEdge& y) {
    return x.key != y.key ? x.key < y.key : x.triangle < y.triangle;
  });
  return uses;
}

// Normal of a corner on the front: the shading normal if there is one.
Vec3 front_normal(const ZoneMesh& mesh, TriangleId t, std::size_t k) {
  const std::uint32_t n = mesh.triangle(t).normal[k];
  return n == BaseTriangle::kFlat ? mesh.triangle_normal(t) : mesh.base().normals[n];
}

bool is_shaded(const ZoneMesh& mesh, TriangleId t) {
  return mesh.triangle(t).normal[0] != BaseTriangle::kFlat;
}

class EdgeJoint {
 public:
  EdgeJoint(const ZoneMesh& mesh, const TriangleEdge& a, const TriangleEdge& b, double crease_angle_deg)
      : mesh_(mesh),
        a_(a),
        b_(b),
        crease_cosine_(std::cos(crease_angle_deg * std::numbers::pi / 180) - 1e-12) {}

  // The sides given lie on the same side of the surface; is it smooth there?
  bool is_smooth(bool a_front, bool b_front) const {
    const TriangleId ta(a_.triangle);
    const TriangleId tb(b_.triangle);
    const double sign = a_front == b_front ? 1 : -1;
    if (sign * mesh_.triangle_normal(ta).dot(mesh_.triangle_normal(tb)) >= crease_cosine_) return true;
    if (!is_shaded(mesh_, ta) || !is_shaded(mesh_, tb)) return false;
    constexpr double kAgree = 0.9998;  // cos of about 1 degree
    for (int end = 0; end < 2; ++end) {
      const Vec3 na = front_normal(mesh_, ta, corner(a_, end));
      const Vec3 nb = front_normal(mesh_, tb, corner(b_, a_.forward == b_.forward ? end : 1 - end));
      if (sign * na.dot(nb) < kAgree) return false;
    }
    return true;
  }

 private:
  static std::size_t corner(const TriangleEdge& use, int end) {
    return static_cast<std::size_t>((use.edge + end) % 3);
  }

  const ZoneMesh& mesh_;
  const TriangleEdge& a_;
  const TriangleEdge& b_;
  double crease_cosine_;
};

double angle_at(const ZoneMesh& mesh, TriangleId t, int k) {
  const Vec3 a = mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k);
  const Vec3 b = mesh.corner(t, (k + 2) % 3) - mesh.corner(t, k);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

SmoothPatches::SmoothPatches(const ZoneMesh& mesh, double crease_angle_deg) {
  join_edges(mesh, crease_angle_deg);
  number_corners(mesh);
}

void SmoothPatches::join_edges(const ZoneMesh& mesh, double crease_angle_deg) {
  neighbour_.assign(6 * mesh.triangle_count(), kNone);
  const std::vector<TriangleEdge> uses = sorted_edges(mesh.base());
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].key == uses[begin].key) ++end;
    // A third triangle stands there: light ends on the line, whatever surface it is of.
    if (end - begin != 2) continue;
    const TriangleEdge& a = uses[begin];
    const TriangleEdge& b = uses[begin + 1];
    const EdgeJoint joint(mesh, a, b, crease_angle_deg);
    for (const bool a_front : {true, false}) {
      // Patches on one side run along their common edge in opposite senses; a back runs against its triangle.
      const bool b_front = a.forward != b.forward ? a_front : !a_front;
      if (!a_front && !mesh.triangle(TriangleId(a.triangle)).two_sided) continue;
      if (!b_front && !mesh.triangle(TriangleId(b.triangle)).two_sided) continue;
      if (mesh.surface(TriangleId(a.triangle), a_front) != mesh.surface(TriangleId(b.triangle), b_front))
        continue;
      if (!joint.is_smooth(a_front, b_front)) continue;
      const std::size_t slot_a = slot(side_of(TriangleId(a.triangle), a_front), a.edge);
      const std::size_t slot_b = slot(side_of(TriangleId(b.triangle), b_front), b.edge);
      neighbour_[slot_a] = static_cast<std::uint32_t>(slot_b);
      neighbour_[slot_b] = static_cast<std::uint32_t>(slot_a);
    }
  }
}

void SmoothPatches::number_corners(const ZoneMesh& mesh) {
  DisjointSets sets(6 * mesh.triangle_count());
  const auto vertex_at = [&](std::size_t s) { return mesh.base().triangles[s / 6].vertex[s % 3]; };
  for (std::size_t s = 0; s < neighbour_.size(); ++s) {
    const std::size_t other = neighbour_[s];
    if (neighbour_[s] == kNone || other < s) continue;
    const auto next = [](std::size_t corner) { return corner - corner % 3 + (corner + 1) % 3; };
    const bool same_sense = vertex_at(s) == vertex_at(other);
    sets.join(s, same_sense ? other : next(other));
    sets.join(next(s), same_sense ? next(other) : other);
  }
  corner_vertex_.assign(6 * mesh.triangle_count(), kNone);
  for (std::size_t s = 0; s < corner_vertex_.size(); ++s) {
    const TriangleId t(s / 6);
    const bool front = s % 6 < 3;
    if (!front && !mesh.triangle(t).two_sided) continue;
    const std::size_t root = sets.find(s);
    if (root == s) {
      corner_vertex_[s] = static_cast<std::uint32_t>(corner_normal_.size());
      corner_normal_.emplace_back(Vec3::Zero());
    } else {
      corner_vertex_[s] = corner_vertex_[root];
    }
    const auto k = static_cast<int>(s % 3);
    corner_normal_[corner_vertex_[s]] +=
        (front ? 1 : -1) * angle_at(mesh, t, k) * front_normal(mesh, t, static_cast<std::size_t>(k));
  }
  for (Vec3& n : corner_normal_) {
    const double length = n.norm();
    n = length > 0 ? Vec3(n / length) : Vec3(Vec3::UnitZ());
  }
}

}  // namespace reemit
