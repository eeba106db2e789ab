#pragma once
#include "scenes/model/scene.h"
#include "scenes/model/work_watch.h"
#include "solver/room/room.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/solution.h"

namespace reemit {

/// The room of a solution as packets meet it. Scene and solution must stay where they are as long as it
/// lives.
struct PreparedRoom {
  /// `preparing` is told 0 before the tree for rays is built and 1 at the end. Notes in the audit what a
  /// quantum is worth, and in the record that nothing emits where that is so. Throws what
  /// refuse_closed_perfect_reflector does.
  PreparedRoom(const Scene& scene, Solution& solution, const WorkWatch& preparing);
  PreparedRoom(const PreparedRoom&) = delete;
  PreparedRoom& operator=(const PreparedRoom&) = delete;

  /// Nothing emits.
  bool is_dark() const { return emission.sources.empty(); }

  Room room;
  PacketRoom transport;
  PacketSources emission;
};

}  // namespace reemit
