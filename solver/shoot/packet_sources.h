#pragma once
#include <cstdint>
#include <variant>
#include <vector>

#include "solver/shoot/packet_room.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// A luminaire, or the part of one that lies in a zone, as packets see it.
struct PacketSource {
  ZoneId zone;              ///< Valid for surfaces that emit.
  std::uint32_t light = 0;  ///< Else index into Scene::lights, or beyond these a cell of the sky.
  float exponent = 0;       ///< Of a surface: Material::emission_exponent.
};

/// All that emits, with its power in quanta: the sources of one band share kBatchQuanta exactly.
struct PacketSources {
  std::vector<PacketSource> sources;
  std::vector<std::int64_t> quanta;  ///< [source * bands + band]
  /// By source, its share of the packets; empty: in proportion to power. A sky sends most of its power past
  /// what anyone wants to know.
  std::vector<double> packet_share;
  std::vector<double> watts;              ///< Emitted power of the room per band [W].
  std::vector<double> watts_per_quantum;  ///< Per band [W]; 0 for a band in which nothing emits.
};

PacketSources collect_packet_sources(const PacketRoom& transport);

}  // namespace reemit
