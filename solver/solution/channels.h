#pragma once
#include <cstddef>

#include "scenes/model/scene.h"

namespace reemit {

/// The values that every zone, surface and packet has: one for each band of each light group, that is of each
/// set of luminaires whose light is kept apart from that of the others. Arrays of books and sums are indexed
/// [item * count() + channel], the channels of a group one after the other. What surfaces do with light is
/// known by band and is the same for all groups.
class Channels {
 public:
  explicit constexpr Channels(std::size_t bands, std::size_t groups = 1) : bands_(bands), groups_(groups) {}

  constexpr std::size_t bands() const { return bands_; }
  constexpr std::size_t groups() const { return groups_; }
  /// Values of each item.
  constexpr std::size_t count() const { return groups_ * bands_; }
  constexpr std::size_t channel(std::size_t group, std::size_t band) const { return group * bands_ + band; }

  /// Calls visit(channel, band) for every channel in order.
  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    for (std::size_t group = 0, channel = 0; group < groups_; ++group)
      for (std::size_t band = 0; band < bands_; ++band, ++channel) visit(channel, band);
  }

  /// Sum over the groups of value(channel), in one band.
  template <class Value>
  constexpr double over_groups(std::size_t band, Value&& value) const {
    double sum = 0;
    for (std::size_t group = 0; group < groups_; ++group) sum += value(channel(group, band));
    return sum;
  }

  friend constexpr bool operator==(const Channels&, const Channels&) = default;

 private:
  std::size_t bands_;
  std::size_t groups_;
};

/// Those of a room. All luminaires are one group.
inline Channels channels_of(const Scene& scene) {
  return Channels(scene.bands.count());
}

}  // namespace reemit
