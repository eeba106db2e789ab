#include "mesh/contact/group_outlines.h"

#include <algorithm>
#include <utility>

#include "mesh/pieces/plane_boxes.h"

namespace reemit {
namespace {

// Corners from which on a loop is worth sorting. Welding puts the ends of all cuts and overlaps into it.
constexpr std::size_t kLong = 32;

}  // namespace

GroupOutlines::GroupOutlines(const VertexTable& vertices, const std::vector<FacePiece>& pieces,
                             const PieceGroup& group) {
  loops_.reserve(group.pieces.size());
  for (const std::size_t p : group.pieces) loops_.emplace_back(vertices, pieces[p], group.plane);
  bins_.resize(loops_.size());
  for (std::size_t k = 0; k < loops_.size(); ++k) {
    const std::vector<std::vector<Vec2>>& loops = loops_[k].loops;
    if (std::none_of(loops.begin(), loops.end(), [](const auto& l) { return l.size() > kLong; })) continue;
    for (const std::vector<Vec2>& loop : loops) bins_[k].emplace_back(loop);
  }
  if (loops_.size() == 1) return;
  std::vector<IndexedBox> boxes;
  boxes.reserve(loops_.size());
  for (const PlanarLoops& l : loops_) boxes.push_back(box_in_plane(l.min, l.max, boxes.size()));
  tree_ = BoxTree(std::move(boxes));
}

bool GroupOutlines::contains(std::size_t k, const Vec2& p) const {
  if (bins_[k].empty()) return loops_[k].contains(p);
  const std::vector<LoopBins>& bins = bins_[k];
  return bins[0].winding(p) != 0 && std::none_of(bins.begin() + 1, bins.end(),
                                                 [&](const LoopBins& hole) { return hole.winding(p) != 0; });
}

void GroupOutlines::near(const Vec2& low, const Vec2& high, std::vector<std::size_t>& out) const {
  out.clear();
  if (loops_.size() == 1) {
    out.push_back(0);
    return;
  }
  tree_.visit(NearRectangle(low, high), [&](std::uint32_t k) { out.push_back(k); });
  std::sort(out.begin(), out.end());
}

void GroupOutlines::covering(const Vec2& p, std::vector<std::size_t>& out) const {
  near(p, p, out);
  std::erase_if(out, [&](std::size_t k) { return !contains(k, p); });
}

bool GroupOutlines::cover(const Vec2& p) const {
  if (loops_.size() == 1) return contains(0, p);
  bool found = false;
  const NearRectangle at_p(p, p);
  tree_.visit([&](const Vec3& min, const Vec3& max) { return !found && at_p(min, max); },
              [&](std::uint32_t k) { found = found || contains(k, p); });
  return found;
}

}  // namespace reemit
