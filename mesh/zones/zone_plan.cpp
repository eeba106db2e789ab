#include "mesh/zones/zone_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <queue>
#include <tuple>
#include <utility>

#include "mesh/zones/zone_cost.h"
#include "mesh/zones/zone_sizing.h"

namespace reemit {
namespace {

/// Zones over those wanted up to which nothing is put together.
constexpr double kEnough = 1.5;
/// Place over the length of a zone, then normal and light: in these, sides that lie close are alike.
constexpr std::size_t kFeatures = 7;
using Features = std::array<float, kFeatures>;

struct Member {
  SideId side;
  float area;
  Features features;
};

/// Members first .. last-1 of all.
struct Cluster {
  std::size_t first, last;
  double cost;  // area times the variance of the features
  int axis;     // of the largest variance
  double mean;  // along it
};

struct IsCheaper {
  bool operator()(const Cluster& a, const Cluster& b) const {
    return a.cost != b.cost ? a.cost < b.cost : a.first > b.first;
  }
};

class Grouping {
 public:
  Grouping(const ZoneMesh& mesh, double zone_area) : mesh_(mesh), per_length_(1 / std::sqrt(zone_area)) {}

  void add(SideId side, float light) {
    const TriangleId t = triangle_of(side);
    const Vec3 p = per_length_ * mesh_.point(t, 1.0 / 3, 1.0 / 3);
    const Vec3 n = kNormalWeight * mesh_.side_normal(side);
    Member m{side, static_cast<float>(mesh_.triangle_area(t)), {}};
    for (std::size_t k = 0; k < 3; ++k) {
      m.features[k] = static_cast<float>(p[static_cast<Eigen::Index>(k)]);
      m.features[k + 3] = static_cast<float>(n[static_cast<Eigen::Index>(k)]);
    }
    m.features[6] = static_cast<float>(kLightWeight) * light;
    members_.push_back(m);
  }

  /// Cuts until there are `most` groups and none costs more than `cost`, or all are single sides.
  void divide(double most, double cost) {
    const auto kind = [&](const Member& m) {
      return std::tuple(mesh_.surface(m.side), !is_front(m.side), !mesh_.shows_front(m.side));
    };
    std::stable_sort(members_.begin(), members_.end(),
                     [&](const Member& a, const Member& b) { return kind(a) < kind(b); });
    std::priority_queue<Cluster, std::vector<Cluster>, IsCheaper> open;
    const auto add = [&](const Cluster& cluster) {
      if (cluster.cost > 0) open.push(cluster);
    };
    for (std::size_t first = 0; first < members_.size();) {
      std::size_t last = first + 1;
      while (last < members_.size() && kind(members_[last]) == kind(members_[first])) ++last;
      starts_.push_back(first);
      add(measured(first, last));
      first = last;
    }
    while (!open.empty() &&
           (static_cast<double>(starts_.size() + cuts_.size()) < most || open.top().cost > cost)) {
      const Cluster c = open.top();
      open.pop();
      const auto axis = static_cast<std::size_t>(c.axis);
      const auto begin = members_.begin();
      const auto middle = std::stable_partition(
          begin + static_cast<std::ptrdiff_t>(c.first), begin + static_cast<std::ptrdiff_t>(c.last),
          [&](const Member& m) { return static_cast<double>(m.features[axis]) < c.mean; });
      const auto cut = static_cast<std::size_t>(middle - begin);
      if (cut == c.first || cut == c.last) continue;  // they differ by less than rounding
      cuts_.push_back({cut, c.cost});
      add(measured(c.first, cut));
      add(measured(cut, c.last));
    }
  }

  /// Groups and single sides when only what costs more than `cost` is cut. A part never costs more than the
  /// whole, so cuts come in the order of costs.
  std::size_t count(double cost) const { return starts_.size() + cuts_above(cost); }

  /// Numbers the groups, from groups.count on. A single side needs none unless it has several cells.
  void number(double cost, ZoneGroups& groups) const {
    std::vector<std::size_t> starts = starts_;
    for (std::size_t i = 0; i < cuts_above(cost); ++i) starts.push_back(cuts_[i].place);
    std::sort(starts.begin(), starts.end());
    starts.push_back(members_.size());
    // By their first sides, so that neighbours in memory are neighbours in the room.
    std::vector<std::pair<SideId, std::size_t>> order;
    for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
      SideId least = members_[starts[i]].side;
      if (starts[i + 1] - starts[i] == 1 && mesh_.triangle(triangle_of(least)).divisions == 1) continue;
      for (std::size_t m = starts[i]; m < starts[i + 1]; ++m) least = std::min(least, members_[m].side);
      order.emplace_back(least, i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [side, i] : order) {
      for (std::size_t m = starts[i]; m < starts[i + 1]; ++m)
        groups.of_side[members_[m].side.index()] = groups.count;
      ++groups.count;
    }
  }

 private:
  Cluster measured(std::size_t first, std::size_t last) const {
    Cluster c{first, last, 0, 0, 0};
    if (last - first < 2) return c;
    double area = 0;
    std::array<double, kFeatures> sum{};
    for (std::size_t i = first; i < last; ++i) {
      const auto a = static_cast<double>(members_[i].area);
      area += a;
      for (std::size_t k = 0; k < kFeatures; ++k) sum[k] += a * static_cast<double>(members_[i].features[k]);
    }
    std::array<double, kFeatures> spread{};  // area times variance
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t k = 0; k < kFeatures; ++k) {
        const double d = static_cast<double>(members_[i].features[k]) - sum[k] / area;
        spread[k] += static_cast<double>(members_[i].area) * d * d;
      }
    const auto largest =
        static_cast<std::size_t>(std::max_element(spread.begin(), spread.end()) - spread.begin());
    for (const double s : spread) c.cost += s;
    c.axis = static_cast<int>(largest);
    c.mean = sum[largest] / area;
    return c;
  }

  std::size_t cuts_above(double cost) const {
    const auto end =
        std::partition_point(cuts_.begin(), cuts_.end(), [&](const Cut& c) { return c.cost > cost; });
    return static_cast<std::size_t>(end - cuts_.begin());
  }

  struct Cut {
    std::size_t place;  // the first member behind it
    double cost;        // of what was cut
  };

  const ZoneMesh& mesh_;
  double per_length_;
  std::vector<Member> members_;
  std::vector<std::size_t> starts_;  // of the members of each surface and side
  std::vector<Cut> cuts_;
};

/// One group for the sealed sides of each surface, fronts and backs apart, and fronts on backs of triangles.
void group_sealed(const ZoneMesh& mesh, const std::vector<SideUse>& uses, ZoneGroups& groups) {
  constexpr std::uint32_t kOwn = ZoneGroups::kOwn;
  std::vector<std::array<std::uint32_t, 3>> of_surface;  // front, back, front on the back of a triangle
  for (std::size_t s = 0; s < uses.size(); ++s) {
    if (uses[s] != SideUse::kSealed) continue;
    const SideId side(s);
    const std::size_t surface = mesh.surface(side).index();
    if (surface >= of_surface.size()) of_surface.resize(surface + 1, {kOwn, kOwn, kOwn});
    std::uint32_t& group = of_surface[surface][is_front(side) ? 0 : mesh.shows_front(side) ? 2 : 1];
    if (group == kOwn) group = groups.count++;
    groups.of_side[s] = group;
  }
  groups.sealed = groups.count;
}

/// Whether a side may be in one zone whole: it is one cell, or a patch of several cells, for the sake of its
/// vertices, that costs no more than one.
bool may_share(const ZoneMesh& mesh, TriangleId t, double zone_area) {
  if (mesh.triangle(t).divisions == 1) return true;
  constexpr double kLargestPatch = kCellCost / (kNormalWeight * kNormalWeight * kPatchNormals);
  return mesh.triangle(t).is_curved() && mesh.triangle_area(t) <= kLargestPatch * zone_area;
}

/// Cells of sides of these areas [m2] when zones have `zone_area`.
double cells_of(const std::vector<double>& areas, double zone_area) {
  double cells = 0;
  for (const double area : areas) {
    const double n = divisions_at_least(wanted_divisions(area, zone_area));
    cells += n * n;
  }
  return cells;
}

}  // namespace

ZonePlan plan_zones(const ZoneMesh& mesh, const std::vector<SideUse>& uses, const std::vector<float>& light,
                    double wanted, double zone_area, double largest_zone_area) {
  ZonePlan plan{zone_area, {}};
  plan.groups.of_side.assign(mesh.side_count(), ZoneGroups::kOwn);
  group_sealed(mesh, uses, plan.groups);
  Grouping grouping(mesh, zone_area);
  std::vector<double> large;  // areas of sides that share nothing
  double zones_now = 0;
  for (std::size_t s = 0; s < uses.size(); ++s) {
    const SideId side(s);
    if (uses[s] == SideUse::kSealed || !mesh.has_zones(side)) continue;
    const TriangleId t = triangle_of(side);
    const double n = mesh.triangle(t).divisions;
    zones_now += n * n;
    if (uses[s] == SideUse::kOwn || !may_share(mesh, t, zone_area))
      large.push_back(mesh.triangle_area(t));
    else
      grouping.add(side, light.empty() ? 0.0F : light[s]);
  }
  if (zones_now > kEnough * wanted) {
    grouping.divide(wanted, kCellCost * largest_zone_area);
    const auto zones = [&](double area) {
      return cells_of(large, area) + static_cast<double>(grouping.count(kCellCost * area));
    };
    // By bisection of the logarithm, as counts fall with the area.
    constexpr int kSteps = 30;
    double low = zone_area;
    double high = largest_zone_area;
    for (int i = 0; i < kSteps && zones(low) > wanted; ++i) {
      const double middle = std::sqrt(low * high);
      (zones(middle) > wanted ? low : high) = middle;
    }
    plan.zone_area = zones(low) > wanted ? high : low;
    grouping.number(kCellCost * plan.zone_area, plan.groups);
  }
  if (plan.groups.count == 0) plan.groups.of_side.clear();
  return plan;
}

}  // namespace reemit
