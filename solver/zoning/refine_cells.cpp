#include "solver/zoning/refine_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mesh/zones/zone_cost.h"
#include "solver/zoning/light_level.h"

namespace reemit {
namespace {

constexpr LookEffort kCellEffort{16, 2, 4};
/// Of all cells that there are, the share that is cut before the others are looked at again.
constexpr std::size_t kShareAtOnce = 16;

struct Node {
  SideCell cell;
  double cost = 0;
  std::size_t parts = 0;  // first of four; 0: it is not cut
};

struct Costly {
  double cost;
  std::size_t node;
  bool operator<(const Costly& other) const {
    return cost != other.cost ? cost < other.cost : node > other.node;
  }
};

class Refinement {
 public:
  Refinement(const PilotLight& pilot, const CellBudget& budget) : pilot_(pilot), budget_(budget) {}

  void add_roots(SideId side, std::uint32_t divisions) {
    for (std::uint32_t c = 0; c < divisions * divisions; ++c)
      nodes_.push_back({{triangle_of(side), is_front(side), divisions, c}});
  }

  void cut(const WorkWatch& watch) {
    look_at(0);
    auto cells = static_cast<double>(nodes_.size());
    const double missing = budget_.cells - cells;
    while (cells < budget_.cells && !open_.empty()) {
      watch.at(1 - (budget_.cells - cells) / missing);
      const std::size_t first = nodes_.size();
      const auto left = static_cast<std::size_t>((budget_.cells - cells) / (kCellParts - 1)) + 1;
      const std::size_t at_once = std::min(left, static_cast<std::size_t>(cells) / kShareAtOnce + 1);
      for (std::size_t i = 0; i < at_once && !open_.empty(); ++i) {
        const std::size_t node = open_.top().node;
        open_.pop();
        cut_node(node);
        cells += kCellParts - 1;
      }
      look_at(first);
    }
  }

  /// Appends what CellSplits::is_split says of `count` roots from `first` on.
  void append_splits(std::size_t first, std::size_t count, std::vector<std::uint8_t>& is_split) const {
    for (std::size_t i = first; i < first + count; ++i) append_node(i, is_split);
  }
  bool is_cut(std::size_t first, std::size_t count) const {
    return std::any_of(nodes_.begin() + static_cast<std::ptrdiff_t>(first),
                       nodes_.begin() + static_cast<std::ptrdiff_t>(first + count),
                       [](const Node& node) { return node.parts != 0; });
  }

 private:
  void cut_node(std::size_t node) {
    const SideCell cell = nodes_[node].cell;
    nodes_[node].parts = nodes_.size();
    const ZoneCell place = zone_cell(cell.divisions, cell.number);
    const std::uint32_t divisions = 2 * cell.divisions;
    for (std::uint32_t k = 0; k < kCellParts; ++k)
      nodes_.push_back({{cell.triangle, cell.front, divisions, cell_number(divisions, cell_part(place, k))}});
  }

  /// Finds out what the nodes from `first` on cost.
  void look_at(std::size_t first) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, nodes_.size(), 64), [&](const auto& range) {
      PilotLight::Looker looker(pilot_);
      for (std::size_t i = range.begin(); i != range.end(); ++i)
        nodes_[i].cost = cost_of(nodes_[i].cell, looker);
    });
    for (std::size_t i = first; i < nodes_.size(); ++i)
      if (nodes_[i].cost > kCellCost * budget_.zone_area * budget_.zone_area &&
          nodes_[i].cell.divisions < ZoneMesh::kMostDivisions / 2)
        open_.push({nodes_[i].cost, i});
  }

  double cost_of(const SideCell& cell, PilotLight::Looker& looker) const {
    const double n = cell.divisions;
    const double area = pilot_.mesh().triangle_area(cell.triangle) / (n * n);
    const LightSpread light = looker.look(cell, kCellEffort);
    return area * (kCellCost * area + kUnevenWeight * unevenness(light, pilot_.mean()) * budget_.zone_area);
  }

  void append_node(std::size_t node, std::vector<std::uint8_t>& is_split) const {
    const std::size_t parts = nodes_[node].parts;
    is_split.push_back(parts != 0 ? 1 : 0);
    for (std::size_t k = 0; parts != 0 && k < kCellParts; ++k) append_node(parts + k, is_split);
  }

  const PilotLight& pilot_;
  CellBudget budget_;
  std::vector<Node> nodes_;
  std::priority_queue<Costly> open_;
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
      refinement.append_splits(first, n * n, splits.is_split);
    }
    first += n * n;
  }
  return splits;
}

}  // namespace reemit
