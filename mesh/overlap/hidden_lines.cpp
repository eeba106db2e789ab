#include "mesh/overlap/hidden_lines.h"

#include <algorithm>
#include <utility>

#include <boost/icl/continuous_interval.hpp>
#include <boost/icl/interval_set.hpp>

#include "mesh/pieces/contact_segments.h"

namespace reemit {
namespace {

// Along an edge, from 0 to 1.
using Parts = boost::icl::interval_set<double>;
using Part = boost::icl::continuous_interval<double>;

bool is_all(const Parts& parts) {
  constexpr double kRounding = 1e-12;  // of the place of an end
  return boost::icl::contains(parts, Part::closed(kRounding, 1 - kRounding));
}

}  // namespace

void HiddenLines::find(const VertexTable& vertices, const std::vector<FacePiece>& pieces, std::uint32_t piece,
                       std::span<const std::uint32_t> hiders) {
  // Areas of pieces with hidden lines are found by clipping them to triangles one by one, which does not pay
  // for longer outlines.
  constexpr std::size_t kMostCorners = 32;
  const FacePiece& hidden = pieces[piece];
  std::size_t corners = 0;
  for (const Loop& loop : hidden.loops) corners += loop.size();
  if (corners > kMostCorners) return;

  std::vector<std::pair<Vec3, Vec3>> edges;
  for (const Loop& loop : hidden.loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      edges.emplace_back(vertices[loop[i]], vertices[loop[(i + 1) % loop.size()]]);
  std::vector<Parts> covered(edges.size());
  std::vector<PlanarSegment> parts;
  std::size_t open = edges.size();  // edges of which something is still seen
  for (const std::uint32_t other : hiders) {
    if (open == 0) break;
    const PlaneFrame& plane = pieces[other].area >= hidden.area ? pieces[other].plane : hidden.plane;
    const PlanarLoops loops(vertices, pieces[other], plane);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (is_all(covered[e])) continue;
      const PlanarSegment edge{plane.project(edges[e].first), plane.project(edges[e].second)};
      parts.clear();
      clip_to_loops(edge, loops, margin(), parts);
      if (parts.empty()) continue;
      const Vec2 along = edge.to - edge.from;
      const double scale = 1 / along.squaredNorm();
      const auto place = [&](const Vec2& p) {
        return std::clamp((p - edge.from).dot(along) * scale, 0.0, 1.0);
      };
      for (const PlanarSegment& part : parts) covered[e] += Part::closed(place(part.from), place(part.to));
      if (is_all(covered[e])) --open;
    }
  }
  std::vector<Stretch> stretches;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [from, to] = edges[e];
    const double length = (to - from).norm();
    for (const Part& part : covered[e])
      stretches.push_back(
          {from + part.lower() * (to - from), (to - from) / length, (part.upper() - part.lower()) * length});
  }
  // Questions look at all stretches of a piece. One that comes out this often hides little.
  constexpr std::size_t kMostStretches = 64;
  if (!stretches.empty() && stretches.size() <= kMostStretches)
    stretches_.emplace(piece, std::move(stretches));
}

bool HiddenLines::hide(std::size_t piece, const Vec3& a, const Vec3& b, double slack) const {
  const auto found = stretches_.find(static_cast<std::uint32_t>(piece));
  if (found == stretches_.end()) return false;
  return std::any_of(found->second.begin(), found->second.end(), [&](const Stretch& s) {
    const auto within = [&](const Vec3& p) {
      const Vec3 offset = p - s.from;
      const double t = offset.dot(s.direction);
      return t >= -slack && t <= s.length + slack && (offset - t * s.direction).norm() <= margin();
    };
    return within(a) && within(b);
  });
}

}  // namespace reemit
