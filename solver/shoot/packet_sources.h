#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "solver/shoot/packet_room.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// A luminaire, or the part of one that lies in a zone, as packets see it.
struct PacketSource {
  ZoneId zone;              ///< Valid for surfaces that emit.
  std::uint32_t light = 0;  ///< Else index into Scene::lights, or beyond these a cell of the sky.
  float exponent = 0;       ///< Of a surface: Material::emission_exponent.
  std::uint32_t group = 0;  ///< Light group (Channels): its packets have power in the channels of that alone.
};

/// All that emits, with its power in quanta: the sources of one channel share kBatchQuanta exactly.
struct PacketSources {
  explicit PacketSources(Channels of_packets) : channels(of_packets) {}

  Channels channels;
  std::vector<PacketSource> sources;
  std::vector<std::int64_t> quanta;  ///< [source * channels + channel]
  /// By source, its share of the packets; empty: in proportion to power. A sky sends most of its power past
  /// what anyone wants to know.
  std::vector<double> packet_share;
  std::vector<double> watts_per_quantum;  ///< Per channel [W]; 0 for one in which nothing emits.

  std::span<const std::int64_t> quanta_of(std::size_t source) const {
    return {&quanta[source * channels.count()], channels.count()};
  }
  double watts_of(std::size_t source) const;  ///< Power of a source in all bands together [W].
};

/// Luminaires with their power [W], watts[source * channels.bands() + band], as packets.
PacketSources make_packet_sources(std::vector<PacketSource> sources, const std::vector<double>& watts,
                                  Channels channels);

/// All luminaires of a room, as one group.
PacketSources collect_packet_sources(const PacketRoom& transport);

}  // namespace reemit
