#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "solver/emit/luminaire_table.h"
#include "solver/emit/selection.h"

namespace reemit {

/// Choice of one luminaire for a shading point ([SWZ96, sec. 4]). Linear: in proportion to the unoccluded
/// irradiance of all of them. Spatial: a few candidates out of the light tree, then in proportion to their
/// unoccluded irradiance over the probability of having been drawn, which keeps the estimate unbiased
/// [TCE05]. Constant: all alike, with no look at the point.
class LuminaireChoice {
 public:
  /// Linear looks at no more than this many; rooms with more are spatial by default.
  static constexpr std::size_t kMostLinear = 24;
  /// Candidates out of the tree. One alone makes a sample a third cheaper, but its scatter is 3 to 5 times
  /// larger where nothing hides the luminaires; more gain little.
  static constexpr std::size_t kCandidates = 4;

  /// What a room with so many luminaires gets unless asked otherwise.
  static Selection default_for(std::size_t luminaires) {
    return luminaires <= kMostLinear ? Selection::kLinear : Selection::kSpatial;
  }

  /// `u` in [0,1) places the candidates of the tree.
  LuminaireChoice(const LuminaireTable& table, Selection selection, const Vec3f& x, const Vec3f& n, float u);

  /// Linear by these weights, found beforehand, one for each entry of the table; entries of weight 0 keep a
  /// part of the even share. Not all may be 0. Pre: as many as the table has, kMostLinear at most.
  LuminaireChoice(const LuminaireTable& table, std::span<const float> weights);

  /// Picks an entry by u in [0,1) and stretches u over the interval that was hit, so that it can be used
  /// again ([SWZ96] Fig. 8). `inverse_probability` weighs a sample of it. False if no luminaire lights x.
  bool pick(float& u, std::size_t& entry, float& inverse_probability) const;

 private:
  /// Share of the choice that goes evenly to all candidates: bounds the weight of a luminaire whose stronger
  /// neighbours turn out to be hidden.
  static constexpr float kEvenShare = 0.1F;
  static constexpr std::size_t kMostAtInfinity = kMostLinear - kCandidates;

  void weigh_all();
  void weigh_tree(float u);
  bool pick_evenly(float& u, std::size_t& entry, float& inverse_probability) const;
  bool pick_among_all(float& u, std::size_t& entry, float& inverse_probability) const;
  void add(std::size_t entry, float draw_weight);

  const LuminaireTable& table_;
  Selection selection_;
  Vec3f x_{0, 0, 0}, n_{0, 0, 0};
  std::size_t count_ = 0;
  float total_ = 0;
  std::array<std::uint32_t, kMostLinear> entry_;
  std::array<float, kMostLinear> weight_;
  std::array<float, kMostLinear> draw_weight_;
};

}  // namespace reemit
