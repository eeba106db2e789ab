#include "solver/emit/luminaire_choice.h"

#include <algorithm>
#include <cmath>

#include "solver/sampling/warp.h"

namespace reemit {
LuminaireChoice::LuminaireChoice(const LuminaireTable& table, Selection selection, const Vec3f& x,
                                 const Vec3f& n, float u)
    : table_(table), selection_(selection), x_(x), n_(n) {
  if (selection == Selection::kLinear && table.size() == 1) {
    entry_[0] = 0;
    draw_weight_[0] = weight_[0] = total_ = 1;
    count_ = 1;
  } else if (selection == Selection::kLinear && table.size() <= kMostLinear) {
    weigh_all();
  }
  if (selection == Selection::kSpatial) weigh_tree(u);
}

LuminaireChoice::LuminaireChoice(const LuminaireTable& table, std::span<const float> weights)
    : table_(table), selection_(Selection::kLinear), count_(weights.size()) {
  for (std::size_t i = 0; i < count_; ++i) {
    entry_[i] = static_cast<std::uint32_t>(i);
    draw_weight_[i] = 1;
    weight_[i] = weights[i];
    total_ += weights[i];
  }
}

void LuminaireChoice::add(std::size_t entry, float draw_weight) {
  const float weight = draw_weight * table_.brightness(entry) * table_.unoccluded(entry, x_, n_);
  if (!(weight > 0) || !std::isfinite(weight)) return;
  entry_[count_] = static_cast<std::uint32_t>(entry);
  draw_weight_[count_] = draw_weight;
  weight_[count_++] = weight;
  total_ += weight;
}

void LuminaireChoice::weigh_all() {
  for (std::size_t i = 0; i < table_.size(); ++i) add(i, 1);
}

void LuminaireChoice::weigh_tree(float u) {
  std::array<Pick, kCandidates> picks;
  std::array<double, kCandidates> rest;
  const std::size_t found = table_.tree().pick_many(x_, n_, static_cast<double>(u), picks, rest);
  for (std::size_t i = 0; i < found; ++i)
    add(table_.entry_of_tree(picks[i].luminaire), 1 / (kCandidates * picks[i].probability));
  const auto& far = table_.entries_at_infinity();
  if (far.size() <= kMostAtInfinity) {
    for (const std::uint32_t entry : far) add(entry, 1);
    return;
  }
  const auto count = static_cast<float>(far.size());
  for (std::size_t i = 0; i < kCandidates; ++i) {
    const float at = (static_cast<float>(i) + u) / kCandidates * count;
    add(far[std::min(static_cast<std::size_t>(at), far.size() - 1)], count / kCandidates);
  }
}

bool LuminaireChoice::pick(float& u, std::size_t& entry, float& inverse_probability) const {
  if (selection_ == Selection::kConstant) return pick_evenly(u, entry, inverse_probability);
  if (selection_ == Selection::kLinear && table_.size() > kMostLinear)
    return pick_among_all(u, entry, inverse_probability);
  if (count_ == 0) return false;
  const float even = kEvenShare / static_cast<float>(count_);
  float low = 0;
  std::size_t i = 0;
  float probability = 0;
  for (;; ++i) {
    probability = (1 - kEvenShare) * weight_[i] / total_ + even;
    if (i + 1 == count_ || u < low + probability) break;
    low += probability;
  }
  u = stretched(u, low, probability);
  entry = entry_[i];
  inverse_probability = draw_weight_[i] / probability;
  return true;
}

bool LuminaireChoice::pick_evenly(float& u, std::size_t& entry, float& inverse_probability) const {
  if (table_.empty()) return false;
  const auto count = static_cast<float>(table_.size());
  const float at = u * count;
  entry = std::min(static_cast<std::size_t>(at), table_.size() - 1);
  u = stretched(at, static_cast<float>(entry), 1);
  inverse_probability = count;
  return true;
}

bool LuminaireChoice::pick_among_all(float& u, std::size_t& entry, float& inverse_probability) const {
  const auto weight = [&](std::size_t i) {
    const auto w = static_cast<double>(table_.brightness(i) * table_.unoccluded(i, x_, n_));
    return w > 0 && std::isfinite(w) ? w : 0.0;
  };
  double total = 0;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const double w = weight(i);
    total += w;
    if (w > 0) ++lit;
  }
  if (lit == 0) return false;
  constexpr auto kEven = static_cast<double>(kEvenShare);
  double low = 0;
  double probability = 0;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const double w = weight(i);
    if (!(w > 0)) continue;
    low += probability;
    probability = (1 - kEven) * w / total + kEven / static_cast<double>(lit);
    entry = i;
    if (static_cast<double>(u) < low + probability) break;
  }
  u = static_cast<float>(std::clamp((static_cast<double>(u) - low) / probability, 0.0, 1 - 0x1p-24));
  inverse_probability = static_cast<float>(1 / probability);
  return true;
}

}  // namespace reemit
