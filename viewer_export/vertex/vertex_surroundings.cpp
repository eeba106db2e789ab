#include "viewer_export/vertex/vertex_surroundings.h"

namespace reemit {

const Surrounding& Surroundings::of(std::size_t v) {
  /// Least cosine to the normal of the vertex.
  constexpr double kSameWay = 0.8;
  found_.vertices.assign(1, static_cast<std::uint32_t>(v));
  ++visit_;
  seen_in_[v] = visit_;
  found_.upto[0] = 1;
  const Vec3& normal = rings_.normals()[v];
  std::size_t next = 0;
  for (std::size_t hop = 1; hop <= Surrounding::kHops; ++hop) {
    for (const std::size_t end = found_.vertices.size(); next < end; ++next)
      for (const std::uint32_t q : neighbours_.of(found_.vertices[next])) {
        if (seen_in_[q] == visit_) continue;
        seen_in_[q] = visit_;
        if (rings_.normals()[q].dot(normal) > kSameWay) found_.vertices.push_back(q);
      }
    found_.upto[hop] = found_.vertices.size();
  }
  const Vec3 along = normal.unitOrthogonal();
  const Vec3 across = normal.cross(along);
  found_.x.clear();
  found_.y.clear();
  for (const std::uint32_t q : found_.vertices) {
    const Vec3 d = rings_.positions()[q] - rings_.positions()[v];
    found_.x.push_back(d.dot(along));
    found_.y.push_back(d.dot(across));
  }
  return found_;
}

}  // namespace reemit
