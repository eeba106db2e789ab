#include "mesh/pieces/contact_segments.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace reemit {

void section_with_plane(const VertexTable& vertices, const FacePiece& piece, const PlaneFrame& plane,
                        double contact, std::vector<PlanarSegment>& out) {
  std::vector<std::vector<double>> heights;
  bool any_above = false;
  bool any_below = false;
  bool any_on = false;
  for (const Loop& loop : piece.loops) {
    std::vector<double>& h = heights.emplace_back();
    for (const std::uint32_t v : loop) {
      double height = plane.height(vertices[v]);
      if (std::abs(height) <= contact) height = 0;
      any_above |= height > 0;
      any_below |= height < 0;
      any_on |= height == 0;
      h.push_back(height);
    }
  }
  if (!any_on && !(any_above && any_below)) return;

  const bool pierces = any_above && any_below;
  const Vec3 line = plane.normal.cross(piece.plane.normal);
  std::vector<std::pair<double, Vec3>> crossings;
  for (std::size_t l = 0; l < piece.loops.size(); ++l) {
    const Loop& loop = piece.loops[l];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::size_t next = (i + 1) % loop.size();
      const double a = heights[l][i];
      const double b = heights[l][next];
      const Vec3& pa = vertices[loop[i]];
      const Vec3& pb = vertices[loop[next]];
      if (a == 0 && b == 0) out.push_back({plane.project(pa), plane.project(pb)});
      // Corners on the plane count as above it, so that every loop crosses an even number of times.
      if (!pierces || (a >= 0) == (b >= 0)) continue;
      const Vec3 p = pa + a / (a - b) * (pb - pa);
      crossings.emplace_back(line.dot(p), p);
    }
  }
  std::sort(crossings.begin(), crossings.end(),
            [](const auto& x, const auto& y) { return x.first < y.first; });
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    out.push_back({plane.project(crossings[i].second), plane.project(crossings[i + 1].second)});
}

void clip_to_loops(const PlanarSegment& segment, const PlanarLoops& loops, double clearance,
                   std::vector<PlanarSegment>& out) {
  const Vec2 low = segment.from.cwiseMin(segment.to);
  const Vec2 high = segment.from.cwiseMax(segment.to);
  if ((low.array() > loops.max.array()).any() || (high.array() < loops.min.array()).any()) return;
  const Vec2 along = segment.to - segment.from;
  const double length = along.norm();
  if (length <= clearance) return;
  std::vector<double> cuts{0, 1};
  for (const auto& loop : loops.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2& a = loop[i];
      const Vec2 edge = loop[(i + 1) % loop.size()] - a;
      const double parallel = along.x() * edge.y() - along.y() * edge.x();
      if (parallel == 0) continue;
      const Vec2 d = a - segment.from;
      const double t = (d.x() * edge.y() - d.y() * edge.x()) / parallel;
      const double s = (d.x() * along.y() - d.y() * along.x()) / parallel;
      if (t > 0 && t < 1 && s > -1e-9 && s < 1 + 1e-9) cuts.push_back(t);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if ((cuts[i + 1] - cuts[i]) * length <= clearance) continue;
    const Vec2 middle = segment.from + 0.5 * (cuts[i] + cuts[i + 1]) * along;
    if (!loops.contains(middle) || loops.distance_to_boundary(middle) <= clearance) continue;
    out.push_back({segment.from + cuts[i] * along, segment.from + cuts[i + 1] * along});
  }
}

}  // namespace reemit
