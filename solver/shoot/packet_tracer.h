#pragma once
#include <cstdint>

#include "solver/shoot/packet_batch.h"
#include "solver/shoot/packet_books.h"
#include "solver/shoot/specular_packets.h"

namespace reemit {

/// Packets that have come to something, 16 at most.
struct PacketArrivals {
  const PacketBlock& block;
  const Hit16& hits;
  std::uint32_t zones[16] = {};  ///< ZoneMesh::kNone where a packet met none.
  std::uint32_t in_zones = 0;    ///< Lanes, as bits, of packets that met a zone: the others are settled.
  std::uint32_t specular = 0;    ///< Of these, those that SpecularPackets::lanes names.
};

/// Traces the packets of one task in blocks of 16, together with those that wait for their second look or go
/// on from mirrors and panes: as soon as these fill a block, it is traced. Packets that end in no zone are
/// booked here; what becomes of the others is up to the caller.
class PacketTracer {
 public:
  PacketTracer(const BatchTask& task, BatchBooks& books);

  /// Sends a block on its way in sweep or bounce `step`, and calls `arrive(PacketArrivals)` for it and for
  /// all blocks that have become full since.
  template <class Arrive>
  void trace(PacketBlock& block, std::uint32_t step, const Arrive& arrive) {
    send(block, step, arrive);
    send_waiting(16, step, arrive);
  }
  /// Sends what waits. Packets of another step come after it.
  template <class Arrive>
  void finish(std::uint32_t step, const Arrive& arrive) {
    send_waiting(1, step, arrive);
  }

  SpecularPackets& specular() { return specular_; }
  WaitingPackets& carried() { return carried_; }  ///< Those that go on from mirrors and panes.
  std::uint64_t rays() const { return rays_; }    ///< Sent so far; second looks do not count.

 private:
  template <class Arrive>
  void send(PacketBlock& block, std::uint32_t step, const Arrive& arrive) {
    rays_ += static_cast<std::uint64_t>(block.count);
    if (observer_ != nullptr) (*observer_)({block.rays, block.count, block.id, step});
    arrive(look(block, false));
  }
  /// Sends those that wait while there are so many of a kind.
  template <class Arrive>
  void send_waiting(std::size_t least, std::uint32_t step, const Arrive& arrive) {
    while (doubtful_.count() >= least || carried_.count() >= least)
      if (doubtful_.count() >= least) {
        doubtful_.take(waiting_);
        arrive(look(waiting_, true));
      } else {
        carried_.take(waiting_);
        send(waiting_, step, arrive);
      }
  }
  PacketArrivals look(PacketBlock& block, bool second_look);
  void settle_outside_zones(PacketBlock& block, int lane, bool second_look);

  const PacketRoom& transport_;
  const RayObserver* observer_;
  BatchBooks& books_;
  LocalBooks local_;
  SpecularPackets specular_;
  WaitingPackets doubtful_;
  WaitingPackets carried_;
  PacketBlock waiting_;
  Hit16 hits_{};
  std::uint64_t rays_ = 0;
};

}  // namespace reemit
