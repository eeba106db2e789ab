#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "solver/emit/luminaire_bounds.h"

namespace reemit {

/// A node of a binary tree over luminaires, or one luminaire.
struct LightSplit {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  LuminaireBounds bounds;
  std::uint32_t left = kNone;   ///< Index of a child, kNone for a luminaire.
  std::uint32_t right = kNone;  ///< Index of the other child, or the index of the luminaire.
  bool is_luminaire() const { return left == kNone; }
};

/// What a node costs as a stand-in for its luminaires: intensity x size x spread of directions, the measure
/// of the surface area orientation heuristic [CON18, eq. 2] with the squared diagonal of the box in place of
/// its surface, which is 0 for a row of points.
float cost(const LuminaireBounds& bounds);

/// Binary tree with one luminaire per leaf; children come after their parent, the root is the first. Splits
/// minimise the sum of cost() over both sides among bins of three axes [CON18, sec. 4.4]; where this would
/// let the tree grow deeper than kMostLevels steps, and where all are in one place, they halve the number.
/// Pre: at least one, at most 2^30; all valid().
std::vector<LightSplit> split_luminaires(std::span<const LuminaireBounds> luminaires);

inline constexpr int kMostLevels = 32;

}  // namespace reemit
