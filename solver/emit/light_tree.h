#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/emit/light_node.h"
#include "solver/emit/luminaire_bounds.h"

namespace reemit {

/// One luminaire out of many and the probability with which it was chosen.
struct Pick {
  std::uint32_t luminaire = 0;  ///< Index into the span that the tree was built from.
  float probability = 0;        ///< In (0,1].
};

/// Chooses a luminaire for a shading point with a probability near its share of the unoccluded irradiance, in
/// a time that grows with the logarithm of their number: a tree of bounds, walked down from the root, where
/// every step chooses one of up to four children by their importance [CON18, sec. 4]. Lamps that shine to all
/// sides and are a far clump are chosen by intensity at once.
///
/// A luminaire that can light a point has a probability above 0 there: importance 0 is proof that a box lies
/// below the horizon or that nothing in it faces the point. The reverse does not hold, as the bounds of a
/// node may promise more than its children keep. A walk that runs into such a dead end picks nothing, and an
/// estimate that counts it as 0 is unbiased. The probabilities of all luminaires and of the dead ends sum
/// to 1.
///
/// Lights at infinity have no bounds; choose between them and the tree outside. Results depend on nothing but
/// the arguments; all methods may be called by many threads.
class LightTree {
 public:
  LightTree() = default;  ///< Without luminaires.
  /// O(N log N). Throws std::invalid_argument for luminaires that are not valid(), with the index, and for
  /// more than kMost.
  explicit LightTree(std::span<const LuminaireBounds> luminaires);

  static constexpr std::size_t kMost = std::size_t{1} << 30;

  std::size_t size() const { return trails_.size(); }
  bool empty() const { return trails_.empty(); }

  /// Picks by u in [0,1) for a point x with unit normal n (normalised; n = 0 for a point without a horizon)
  /// and stretches u over the interval that was hit, so that it can be used again ([SWZ96] Fig. 8): it is
  /// uniform in [0,1) and independent of the pick. False, and u as it was, if the walk ends where no
  /// luminaire can light x.
  ///
  /// Each pick uses up log2(1/probability) bits of u, 20 or more among a million. That is why u is a double:
  /// give it 53 random bits, or what is left over comes in steps.
  bool pick(const Vec3f& x, const Vec3f& n, double& u, Pick& result) const;

  /// The probability of that pick, the same bits as pick gives. Takes as long as a pick.
  float probability(std::uint32_t luminaire, const Vec3f& x, const Vec3f& n) const;

  /// Picks at the positions (i + u) / picks.size(), i = 0, 1, ..., in one walk that splits: each pick alone
  /// has probability(), together they are spread evenly. Returns how many did not run into a dead end; these
  /// come first. `rest`: of the same size, gets the stretched remainder of each position.
  std::size_t pick_many(const Vec3f& x, const Vec3f& n, double u, std::span<Pick> picks,
                        std::span<double> rest) const;

 private:
  std::uint32_t pick_in_clump(std::uint32_t begin, std::uint32_t end, double& u, double& product) const;
  double share_of(std::size_t place, std::uint32_t begin, std::uint32_t end) const;

  std::vector<LightNode> nodes_;       // The root is the first.
  std::vector<std::uint64_t> trails_;  // Per luminaire: the children to take from the root on, 2 bits each.
  std::vector<std::uint32_t> order_;   // Luminaires so that those below a node are neighbours.
  std::vector<std::uint32_t> place_;   // Of each in order_.
  std::vector<double> intensity_to_;   // Of those before a place, and of all.
  std::vector<std::uint32_t> guide_;   // Place of the k-th part of the whole intensity.
};

}  // namespace reemit
