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

/// A product of many shares can be less than a float holds; 0 would mean that it cannot happen.
float as_probability(double product) {
  return std::max(static_cast<float>(product), std::numeric_limits<float>::min());
}

/// Turns the binary tree into one of four children per node.
class Widener {
 public:
  Widener(std::vector<LightSplit> splits, std::size_t luminaires, std::vector<LightNode>& nodes,
          std::vector<std::uint64_t>& trails)
      : splits_(std::move(splits)), nodes_(nodes), trails_(trails) {
    trails_.resize(luminaires);
    if (splits_[0].is_luminaire()) {
      nodes_.push_back({});
      set_child(nodes_[0], 0, splits_[0].bounds, LightNode::kLeaf + splits_[0].right);
    } else {
      widen(0, 0, 0);
    }
  }

 private:
  double total_intensity() const {
    return std::max(static_cast<double>(splits_[0].bounds.intensity), 1e-300);
  }

  std::uint32_t widen(std::uint32_t split, std::uint64_t trail, int level) {
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
      if (part.is_luminaire()) {
        trails_[part.right] = on;
      } else {
        target = widen(child[i], on, level + 1);
      }
      set_child(nodes_[index], i, part.bounds, target);
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
  Widener(split_luminaires(shares), shares.size(), nodes_, trails_);
  nodes_.shrink_to_fit();
}

bool LightTree::pick(const Vec3f& x, const Vec3f& n, double& u, Pick& result) const {
  if (empty()) return false;
  const Receiver at(x, n);
  double product = 1;
  double rest = u;
  for (std::uint32_t node = 0;;) {
    fetch_children(nodes_, node);
    const Shares shares(nodes_[node], at);
    if (shares.dead_end()) return false;
    const double position = shares.position(rest);
    const std::size_t lane = shares.lane_at(position);
    rest = shares.stretched(position, lane);
    product *= shares.probability(lane);
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
        node[i] = nodes_[node[i]].child[lane];
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
