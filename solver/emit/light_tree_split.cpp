#include "solver/emit/light_tree_split.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace reemit {
namespace {

/// Solid angle that a cone of normals lights, weighed by the cosine beyond it, for Lambertian sides
/// [CON18, eq. 1] over the cosine of its half angle; by table, as it is needed hundreds of times per
/// luminaire.
class SpreadMeasure {
 public:
  SpreadMeasure() {
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const double cosine = 2 * static_cast<double>(i) / kCells - 1;
      const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
      const double sine = std::sin(angle);
      const double limit = std::min(angle + std::numbers::pi / 2, std::numbers::pi);
      table_[i] = static_cast<float>(
          2 * std::numbers::pi * (1 - cosine) +
          std::numbers::pi / 2 *
              (2 * limit * sine - std::cos(angle - 2 * limit) - 2 * angle * sine + cosine));
    }
  }
  float operator()(float cosine) const {
    const float at = std::clamp((cosine + 1) * kHalfCells, 0.0F, static_cast<float>(kCells));
    const auto cell = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kCells - 1));
    return std::lerp(table_[cell], table_[cell + 1], at - static_cast<float>(cell));
  }

 private:
  static constexpr int kCells = 64;
  static constexpr int kHalfCells = kCells / 2;
  std::array<float, kCells + 1> table_;
};

float spread(float cosine) {
  static const SpreadMeasure measure;
  return measure(cosine);
}

/// A luminaire as the search for splits sees it.
struct Item {
  Vec3f min, max;
  Vec3f direction;  ///< Axis times the mean cosine to it over the cone of normals.
  float intensity;
  std::uint32_t luminaire;

  float middle(int axis) const { return 0.5F * (min[axis] + max[axis]); }
};

/// Some luminaires together. The spread of their normals is read off the length of the mean direction: the
/// cone with evenly spread normals that has the same mean.
struct Gathered {
  Vec3f min = Vec3f::Constant(std::numeric_limits<float>::infinity());
  Vec3f max = Vec3f::Constant(-std::numeric_limits<float>::infinity());
  Vec3f direction{0, 0, 0};
  float intensity = 0;
  float count = 0;

  void add(const Item& item) {
    min = min.cwiseMin(item.min);
    max = max.cwiseMax(item.max);
    direction += item.direction;
    intensity += item.intensity;
    count += 1;
  }
  void add(const Gathered& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
    direction += other.direction;
    intensity += other.intensity;
    count += other.count;
  }
  float cost() const {
    return intensity * (max - min).squaredNorm() * spread(2 * direction.norm() / count - 1);
  }
};

class Splitter {
 public:
  explicit Splitter(std::span<const LuminaireBounds> luminaires) : luminaires_(luminaires) {
    items_.reserve(luminaires.size());
    for (std::size_t i = 0; i < luminaires.size(); ++i) {
      const LuminaireBounds& l = luminaires[i];
      const float mean_cosine = (1 + l.cos_normals) / 2;
      items_.push_back({l.min, l.max, mean_cosine * l.axis, l.intensity, static_cast<std::uint32_t>(i)});
    }
    nodes_.reserve(2 * luminaires.size() - 1);
  }

  std::vector<LightSplit> run() {
    build(items_, kMostLevels);
    return std::move(nodes_);
  }

 private:
  static constexpr int kBins = 12;

  std::uint32_t build(std::span<Item> items, int levels_left) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    if (items.size() == 1) {
      nodes_[index].bounds = luminaires_[items[0].luminaire];
      nodes_[index].right = items[0].luminaire;
      return index;
    }
    const std::size_t half = split(items, levels_left);
    const std::uint32_t left = build(items.first(half), levels_left - 1);
    const std::uint32_t right = build(items.subspan(half), levels_left - 1);
    nodes_[index] = {merged(nodes_[left].bounds, nodes_[right].bounds), left, right};
    return index;
  }

  /// Puts the items of one side first and returns their number, between 1 and all but one.
  static std::size_t split(std::span<Item> items, int levels_left) {
    const std::size_t middle = items.size() / 2;
    if (items.size() == 2) return middle;
    Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity());
    Vec3f high = -low;
    for (const Item& item : items) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], item.middle(axis));
        high[axis] = std::max(high[axis], item.middle(axis));
      }
    }
    Eigen::Index longest = 0;
    const float length = (high - low).maxCoeff(&longest);
    if (!(length > 0)) return middle;
    if (static_cast<int>(std::bit_width(items.size() - 1)) >= levels_left) {
      const int axis = static_cast<int>(longest);
      std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                       [axis](const Item& a, const Item& b) {
                         const float ma = a.middle(axis);
                         const float mb = b.middle(axis);
                         return ma < mb || (ma == mb && a.luminaire < b.luminaire);
                       });
      return middle;
    }
    const Cut cut = best_cut(items, low, high);
    const auto second = std::partition(items.begin(), items.end(), [&](const Item& item) {
      return bin_of(item, cut.axis, low, high) < cut.bin;
    });
    return static_cast<std::size_t>(second - items.begin());
  }

  struct Cut {
    float cost = std::numeric_limits<float>::infinity();
    int axis = 0;
    int bin = 1;  // The first of the second side.
  };

  static int bin_of(const Item& item, int axis, const Vec3f& low, const Vec3f& high) {
    const float at = (item.middle(axis) - low[axis]) / (high[axis] - low[axis]);
    return std::min(static_cast<int>(at * kBins), kBins - 1);
  }

  /// The first bin holds the lowest middle and the last one the highest, so no side is ever empty.
  static Cut best_cut(std::span<const Item> items, const Vec3f& low, const Vec3f& high) {
    Cut best;
    const float longest = (high - low).maxCoeff();
    for (int axis = 0; axis < 3; ++axis) {
      const float length = high[axis] - low[axis];
      if (!(length > 0)) continue;
      std::array<Gathered, kBins> bins;
      for (const Item& item : items) bins[static_cast<std::size_t>(bin_of(item, axis, low, high))].add(item);
      std::array<float, kBins> above{};  // Cost of this bin and all after it.
      Gathered side;
      for (std::size_t b = kBins - 1; b > 0; --b) {
        side.add(bins[b]);
        above[b] = side.cost();
      }
      side = bins[0];
      for (std::size_t b = 1; b < kBins; ++b) {
        // Thin slabs make poor boxes: cuts across the longest axis are favoured [CON18, sec. 4.4].
        const float cost = longest / length * (side.cost() + above[b]);
        if (bins[b - 1].count > 0 && cost < best.cost) best = {cost, axis, static_cast<int>(b)};
        side.add(bins[b]);
      }
    }
    return best;
  }

  std::span<const LuminaireBounds> luminaires_;
  std::vector<Item> items_;
  std::vector<LightSplit> nodes_;
};

}  // namespace

float cost(const LuminaireBounds& bounds) {
  return bounds.intensity * (bounds.max - bounds.min).squaredNorm() * spread(bounds.cos_normals);
}

std::vector<LightSplit> split_luminaires(std::span<const LuminaireBounds> luminaires) {
  return Splitter(luminaires).run();
}

}  // namespace reemit
