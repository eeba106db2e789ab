#include "solver/emit/light_tree.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "solver/emit/light_tree_split.h"

namespace reemit {
namespace {

/// The greatest double below 1.
constexpr double kBelowOne = 1 - 0x1p-53;

/// The shares of a node's children of the unit interval, not yet divided by their sum. Without branches where
/// the outcome is random.
struct Shares {
  Importance weight;
  std::array<double, LightNode::kWidth + 1> edge;  // Child i has the positions from edge[i] to edge[i+1].

  Shares() = default;
  Shares(const LightNode& node, const Receiver& at) : weight(importance(node, at)) {
    const auto w = [this](std::size_t i) { return static_cast<double>(weight[i]); };
    edge = {0, w(0), w(0) + w(1), (w(0) + w(1)) + w(2), (w(0) + w(1)) + (w(2) + w(3))};
  }
  double total() const { return edge.back(); }
  bool dead_end() const { return !(total() > 0); }
  double probability(std::size_t lane) const { return static_cast<double>(weight[lane]) / total(); }

  /// The child that holds a position; never one of weight 0, as its edges are the same.
  std::size_t lane_at(double position) const {
    return static_cast<std::size_t>(position >= edge[1]) + static_cast<std::size_t>(position >= edge[2]) +
           static_cast<std::size_t>(position >= edge[3]);
  }
  double position(double u) const { return std::min(u * total(), kBelowOne * total()); }
  double stretched(double position, std::size_t lane) const {
    return std::min((position - edge[lane]) / static_cast<double>(weight[lane]), kBelowOne);
  }
};

/// Of its even share, what a lamp weighs at least when its clump is chosen from.
constexpr double kLeastTreeShare = 1e-4;

constexpr std::size_t kNodesInCache = 8192;  // 2 MB

/// Starts to load the children while their parent is looked at: saves a quarter of the time of a pick among a
/// million luminaires. Inlined by force: a function that does nothing else is taken for one without effect.
#if defined(__GNUC__)
[[gnu::always_inline]] inline void fetch_children(const std::vector<LightNode>& nodes, std::uint32_t node) {
  constexpr std::size_t kCacheLine = 64;
  for (const std::uint32_t child : nodes[node].child) {
    if (child & LightNode::kLeaf) continue;
    const char* bytes = reinterpret_cast<const char*>(&nodes[child]);
    for (std::size_t at = 0; at < sizeof(LightNode); at += kCacheLine) __builtin_prefetch(bytes + at);
  }
}
#else
void fetch_children(const std::vector<LightNode>&, std::uint32_t) {}
#endif

/// A clump of lamps that shine to all sides is far from this many of its radii on: then what its lamps send
/// differs little but for their strength, and no more steps are needed to choose among them.
constexpr float kFarClumpRadii = 2;

bool is_far_clump(const LightNode& node, std::size_t lane, const Receiver& at) {
  if (node.begin[lane] == node.end[lane]) return false;
  float distance2 = 0;
  float radius2 = 0;
  float height = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = node.centre[axis][lane] - at.x[axis];
    const float h = node.half[axis][lane];
    distance2 += d * d;
    radius2 += h * h;
    height += at.n[axis] * d;
  }
  // Well above the horizon, or at a point without one.
  return distance2 > kFarClumpRadii * kFarClumpRadii * radius2 &&
         (height * height > radius2 || at.abs_n.isZero()) && height >= 0;
}

/// A product of many shares can be less than a float holds; 0 would mean that it cannot happen.
float as_probability(double product) {
  return std::max(static_cast<float>(product), std::numeric_limits<float>::min());
}

/// Turns the binary tree into one of four children per node.
class Widener {
 public:
  Widener(std::vector<LightSplit> splits, std::size_t luminaires, std::vector<LightNode>& nodes,
          std::vector<std::uint64_t>& trails, std::vector<std::uint32_t>& order)
      : splits_(std::move(splits)), nodes_(nodes), trails_(trails), order_(order) {
    trails_.resize(luminaires);
    order_.reserve(luminaires);
    if (splits_[0].is_luminaire()) {
      nodes_.push_back({});
      set_child(nodes_[0], 0, splits_[0].bounds, LightNode::kLeaf + splits_[0].right);
      order_.push_back(splits_[0].right);
    } else {
      bool all_round = true;
      widen(0, 0, 0, all_round);
    }
  }

 private:
  double total_intensity() const {
    return std::max(static_cast<double>(splits_[0].bounds.intensity), 1e-300);
  }

  /// `all_round` becomes false if any luminaire below shines to some sides only.
  std::uint32_t widen(std::uint32_t split, std::uint64_t trail, int level, bool& all_round) {
    assert(level < kMostLevels);
    std::array<std::uint32_t, LightNode::kWidth> child{splits_[split].left, splits_[split].right};
    std::size_t count = 2;
    while (count < child.size()) {
      // The worst stand-in for what it holds gives way to its parts.
      std::size_t worst = count;
      float most = -1;
      for (std::size_t i = 0; i < count; ++i) {
        if (splits_[child[i]].is_luminaire()) continue;
        const float value = cost(splits_[child[i]].bounds);
        if (value > most) {
          most = value;
          worst = i;
        }
      }
      if (worst == count) break;
      child[count++] = splits_[child[worst]].right;
      child[worst] = splits_[child[worst]].left;
    }
    const std::size_t index = nodes_.size();
    nodes_.push_back({});
    for (std::size_t i = 0; i < count; ++i) {
      const LightSplit& part = splits_[child[i]];
      const std::uint64_t on = trail | std::uint64_t{i} << (2 * level);
      std::uint32_t target = LightNode::kLeaf + part.right;
      const auto begin = static_cast<std::uint32_t>(order_.size());
      bool part_all_round = true;
      if (part.is_luminaire()) {
        trails_[part.right] = on;
        order_.push_back(part.right);
        part_all_round = part.bounds.cos_normals <= -1;
      } else {
        target = widen(child[i], on, level + 1, part_all_round);
      }
      set_child(nodes_[index], i, part.bounds, target);
      if (part_all_round && !part.is_luminaire()) {
        nodes_[index].begin[i] = begin;
        nodes_[index].end[i] = static_cast<std::uint32_t>(order_.size());
      }
      all_round = all_round && part_all_round;
    }
    return static_cast<std::uint32_t>(index);
  }

  static void set_child(LightNode& node, std::size_t lane, const LuminaireBounds& bounds,
                        std::uint32_t target) {
    for (int axis = 0; axis < 3; ++axis) {
      // The box about the rounded middle holds the given one.
      const float middle = 0.5F * bounds.min[axis] + 0.5F * bounds.max[axis];
      const float half = std::max(bounds.max[axis] - middle, middle - bounds.min[axis]);
      node.centre[axis][lane] = middle;
      node.half[axis][lane] = half > 0 ? std::nextafter(half, std::numeric_limits<float>::infinity()) : 0.0F;
      node.axis[axis][lane] = bounds.axis[axis];
    }
    node.cos_normals[lane] = bounds.cos_normals;
    node.sin_normals[lane] = std::sqrt(std::max(0.0F, 1 - bounds.cos_normals * bounds.cos_normals));
    node.cos_emission[lane] = bounds.cos_emission;
    node.intensity[lane] = bounds.intensity;
    node.child[lane] = target;
  }

  std::vector<LightSplit> splits_;
  std::vector<LightNode>& nodes_;
  std::vector<std::uint64_t>& trails_;
  std::vector<std::uint32_t>& order_;
};

}  // namespace

LightTree::LightTree(std::span<const LuminaireBounds> luminaires) {
  if (luminaires.empty()) return;
  if (luminaires.size() > kMost) throw std::invalid_argument("light tree: more than 2^30 luminaires");
  double total = 0;
  for (std::size_t i = 0; i < luminaires.size(); ++i) {
    if (!valid(luminaires[i]))
      throw std::invalid_argument("light tree: bad bounds of luminaire " + std::to_string(i));
    total += static_cast<double>(luminaires[i].intensity);
  }
  // Shares of the sum, so that no unit can make a product overflow or vanish.
  std::vector<LuminaireBounds> shares(luminaires.begin(), luminaires.end());
  for (LuminaireBounds& bounds : shares)
    bounds.intensity = std::max(static_cast<float>(static_cast<double>(bounds.intensity) / total), 1e-30F);
  const Widener widened(split_luminaires(shares), shares.size(), nodes_, trails_, order_);
  nodes_.shrink_to_fit();
  // The weakest lamp of a clump must not vanish in the running sum, or it would never be picked.
  const double least = kLeastTreeShare / static_cast<double>(order_.size());
  intensity_to_.assign(1, 0.0);
  place_.resize(order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const LuminaireBounds& bounds = shares[order_[i]];
    place_[order_[i]] = static_cast<std::uint32_t>(i);
    intensity_to_.push_back(intensity_to_.back() + std::max(static_cast<double>(bounds.intensity), least));
  }
  guide_.resize(order_.size());
  std::uint32_t place = 0;
  for (std::size_t k = 0; k < guide_.size(); ++k) {
    const double position =
        intensity_to_.back() * static_cast<double>(k) / static_cast<double>(guide_.size());
    while (place + 1 < order_.size() && intensity_to_[place + 1] <= position) ++place;
    guide_[k] = place;
  }
}

double LightTree::share_of(std::size_t place, std::uint32_t begin, std::uint32_t end) const {
  return (intensity_to_[place + 1] - intensity_to_[place]) / (intensity_to_[end] - intensity_to_[begin]);
}

std::uint32_t LightTree::pick_in_clump(std::uint32_t begin, std::uint32_t end, double& u,
                                       double& product) const {
  const double first = intensity_to_[begin];
  const double position = first + u * (intensity_to_[end] - first);
  // The guide says where to begin to look; there are as many entries as luminaires, so a step or two follow.
  const double scaled = position / intensity_to_.back() * static_cast<double>(guide_.size());
  std::size_t place = guide_[std::min(static_cast<std::size_t>(scaled), guide_.size() - 1)];
  while (place + 1 < end && intensity_to_[place + 1] <= position) ++place;
  while (place > begin && intensity_to_[place] > position) --place;
  const double width = intensity_to_[place + 1] - intensity_to_[place];
  u = std::clamp((position - intensity_to_[place]) / width, 0.0, kBelowOne);
  product *= share_of(place, begin, end);
  return order_[place];
}

bool LightTree::pick(const Vec3f& x, const Vec3f& n, double& u, Pick& result) const {
  if (empty()) return false;
  const Receiver at(x, n);
  double product = 1;
  double rest = u;
  for (std::uint32_t node = 0;;) {
    if (nodes_.size() > kNodesInCache) fetch_children(nodes_, node);
    const Shares shares(nodes_[node], at);
    if (shares.dead_end()) return false;
    const double position = shares.position(rest);
    const std::size_t lane = shares.lane_at(position);
    rest = shares.stretched(position, lane);
    product *= shares.probability(lane);
    if (is_far_clump(nodes_[node], lane, at)) {
      const std::uint32_t luminaire =
          pick_in_clump(nodes_[node].begin[lane], nodes_[node].end[lane], rest, product);
      result = {luminaire, as_probability(product)};
      u = rest;
      return true;
    }
    node = nodes_[node].child[lane];
    if (node & LightNode::kLeaf) {
      result = {node - LightNode::kLeaf, as_probability(product)};
      u = rest;
      return true;
    }
  }
}

float LightTree::probability(std::uint32_t luminaire, const Vec3f& x, const Vec3f& n) const {
  const Receiver at(x, n);
  double product = 1;
  std::uint64_t trail = trails_[luminaire];
  for (std::uint32_t node = 0; !(node & LightNode::kLeaf); trail >>= 2) {
    const Shares shares(nodes_[node], at);
    const auto lane = static_cast<std::size_t>(trail & 3);
    if (!(shares.weight[lane] > 0)) return 0;
    product *= shares.probability(lane);
    if (is_far_clump(nodes_[node], lane, at))
      return as_probability(product *
                            share_of(place_[luminaire], nodes_[node].begin[lane], nodes_[node].end[lane]));
    node = nodes_[node].child[lane];
  }
  return as_probability(product);
}

std::size_t LightTree::pick_many(const Vec3f& x, const Vec3f& n, double u, std::span<Pick> picks,
                                 std::span<double> rest) const {
  assert(rest.size() == picks.size());
  if (empty()) return 0;
  constexpr std::size_t kSideBySide = 64;
  constexpr std::uint32_t kDead = 0xFFFFFFFFU;
  std::array<std::uint32_t, kSideBySide> node;
  std::array<double, kSideBySide> left, product;
  const Receiver at(x, n);
  const std::size_t count = picks.size();
  std::size_t found = 0;
  for (std::size_t first = 0; first < count; first += kSideBySide) {
    // All take one step, then all the next. Neighbours are often at the same node, which is looked at once;
    // for the rest the processor need not finish one before it starts the next.
    const std::size_t many = std::min(kSideBySide, count - first);
    for (std::size_t i = 0; i < many; ++i) {
      node[i] = 0;
      product[i] = 1;
      left[i] = std::min((static_cast<double>(first + i) + u) / static_cast<double>(count), kBelowOne);
    }
    for (bool moved = true; moved;) {
      moved = false;
      Shares shares;
      std::uint32_t seen = kDead;
      for (std::size_t i = 0; i < many; ++i) {
        if (node[i] & LightNode::kLeaf) continue;
        moved = true;
        if (node[i] != seen) shares = Shares(nodes_[seen = node[i]], at);
        if (shares.dead_end()) {
          node[i] = kDead;
          continue;
        }
        const double position = shares.position(left[i]);
        const std::size_t lane = shares.lane_at(position);
        left[i] = shares.stretched(position, lane);
        product[i] *= shares.probability(lane);
        const LightNode& here = nodes_[node[i]];
        node[i] =
            is_far_clump(here, lane, at)
                ? LightNode::kLeaf + pick_in_clump(here.begin[lane], here.end[lane], left[i], product[i])
                : here.child[lane];
      }
    }
    for (std::size_t i = 0; i < many; ++i) {
      if (node[i] == kDead) continue;
      picks[found] = {node[i] - LightNode::kLeaf, as_probability(product[i])};
      rest[found++] = left[i];
    }
  }
  return found;
}

}  // namespace reemit
