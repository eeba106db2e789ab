#include "solver/zoning/refine_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <queue>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mesh/zones/zone_cost.h"

namespace reemit {
namespace {

/// Of all cells that there are, the share that is cut before the others are looked at again.
constexpr std::size_t kShareAtOnce = 16;

/// What the cut of a half saves, as a share of what both halves cost, is taken to be this before it is looked
/// at; its turn to be looked at comes by that, and for many that become zones it never does.
constexpr double kExpectedShare = 0.5;

struct Node {
  SideCell cell;
  CellCut cut;
  std::unique_ptr<CellLooks> looks;  // as long as they are of use for it and its halves
  bool is_seen = false;              // or else `cut` is a guess
  std::size_t halves = 0;            // the first of them; 0: it is not cut
};

struct Candidate {
  double saved;
  std::size_t node;
  bool operator<(const Candidate& other) const {
    return saved != other.saved ? saved < other.saved : node > other.node;
  }
};

class Refinement {
 public:
  Refinement(const PilotLight& pilot, const CellBudget& budget) : pilot_(pilot), budget_(budget) {}

  void add_roots(SideId side, std::uint32_t divisions) {
    for (std::uint32_t c = 0; c < divisions * divisions; ++c)
      nodes_.push_back(
          {{triangle_of(side), is_front(side), grid_cell(divisions, c)}, {}, std::make_unique<CellLooks>()});
  }

  void cut(const WorkWatch& watch) {
    std::vector<std::size_t> unseen(nodes_.size());
    std::iota(unseen.begin(), unseen.end(), std::size_t{0});
    look_at(unseen);
    auto cells = static_cast<double>(nodes_.size());
    const double missing = budget_.cells - cells;
    while (cells < budget_.cells && !open_.empty()) {
      watch.at(1 - (budget_.cells - cells) / missing);
      const auto left = static_cast<std::size_t>(std::ceil(budget_.cells - cells));
      const std::size_t at_once = std::min(left, static_cast<std::size_t>(cells) / kShareAtOnce + 1);
      unseen.clear();
      for (std::size_t i = 0; i < at_once && !open_.empty(); ++i) {
        const std::size_t node = open_.top().node;
        open_.pop();
        if (nodes_[node].is_seen) {
          cut_node(node);
          ++cells;
        } else {
          unseen.push_back(node);
        }
      }
      look_at(unseen);
    }
  }

  /// Appends what CellSplits::cuts says of `count` roots from `first` on.
  void append_cuts(std::size_t first, std::size_t count, std::vector<std::uint8_t>& cuts) const {
    for (std::size_t i = first; i < first + count; ++i) append_node(i, cuts);
  }
  bool is_cut(std::size_t first, std::size_t count) const {
    return std::any_of(nodes_.begin() + static_cast<std::ptrdiff_t>(first),
                       nodes_.begin() + static_cast<std::ptrdiff_t>(first + count),
                       [](const Node& node) { return node.halves != 0; });
  }

 private:
  void cut_node(std::size_t node) {
    SideCell half = nodes_[node].cell;
    const CellCut cut = nodes_[node].cut;
    const CellHalves halves = halves_of(half.corners, cut.corner);
    nodes_[node].halves = nodes_.size();
    auto [first, second] = looks_of_halves(*nodes_[node].looks, cut.corner);
    nodes_[node].looks.reset();
    const auto add = [&](const CellCorners& corners, CellLooks& looks) {
      half.corners = corners;
      open_.push({kExpectedShare * (cut.cost - cut.saved), nodes_.size()});
      nodes_.push_back({half, {}, std::make_unique<CellLooks>(std::move(looks))});
    };
    add(halves.first, first);
    add(halves.second, second);
  }

  /// Finds out what these nodes cost.
  void look_at(const std::vector<std::size_t>& unseen) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, unseen.size(), 16), [&](const auto& range) {
      PilotLight::Looker looker(pilot_);
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        Node& node = nodes_[unseen[i]];
        node.cut = best_cut(node.cell, budget_.scale, pilot_, looker, *node.looks);
        node.is_seen = true;
      }
    });
    for (const std::size_t i : unseen) {
      const CellCut& cut = nodes_[i].cut;
      if (cut.cost > kCellCost * budget_.scale.zone_area * budget_.scale.zone_area && cut.saved > 0)
        open_.push({cut.saved, i});
      else
        nodes_[i].looks.reset();
    }
  }

  void append_node(std::size_t node, std::vector<std::uint8_t>& cuts) const {
    const std::size_t halves = nodes_[node].halves;
    cuts.push_back(halves == 0 ? CellSplits::kNotCut
                               : static_cast<std::uint8_t>(nodes_[node].cut.corner + 1));
    for (std::size_t k = 0; halves != 0 && k < 2; ++k) append_node(halves + k, cuts);
  }

  const PilotLight& pilot_;
  CellBudget budget_;
  std::vector<Node> nodes_;
  std::priority_queue<Candidate> open_;
};

}  // namespace

CellSplits refine_cells(const PilotLight& pilot, const BaseMesh& base, const std::vector<SideId>& sides,
                        const CellBudget& budget, const WorkWatch& watch) {
  Refinement refinement(pilot, budget);
  for (const SideId side : sides)
    refinement.add_roots(side, base.triangles[triangle_of(side).index()].divisions);
  refinement.cut(watch);
  CellSplits splits;
  std::size_t first = 0;
  for (const SideId side : sides) {
    const std::size_t n = base.triangles[triangle_of(side).index()].divisions;
    if (refinement.is_cut(first, n * n)) {
      splits.sides.push_back(side);
      refinement.append_cuts(first, n * n, splits.cuts);
    }
    first += n * n;
  }
  return splits;
}

}  // namespace reemit
