#pragma once
#include <cstdint>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/gather/caustic_photons.h"
#include "solver/room/room.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/trace/air_sheets.h"
#include "solver/trace/face_sieve.h"

namespace reemit {

/// Shoots packets of luminaires and keeps those that become CausticPhotons. One for a room; const members may
/// be called from any thread.
class CausticShooter {
 public:
  /// The room must outlive it.
  CausticShooter(const Room& room, std::uint64_t seed);

  /// Packets of a batch of `packets` that each square unit (normalised) of a surface emits; 0 where it emits
  /// nothing.
  std::vector<float> density_of_surfaces(double packets) const;
  /// One bit for each packet of a batch, as in CausticPackets::brings.
  using Marks = std::vector<std::uint8_t>;
  /// All may be null.
  struct Options {
    /// Those alone set out; all that bring photons have to be among them. Marks of a batch of another size
    /// are not heeded.
    const Marks* marked = nullptr;
    Marks* brought = nullptr;           ///< Receives which packets brought photons.
    const StopToken* stop = nullptr;    ///< When requested it ends early, with less light than there is.
    const AirSheets* sheets = nullptr;  ///< Which packets are caught on, too, while they fly on.
    float reach = 0;                    ///< As AirSheets::crossings has it.
  };
  /// What a batch of about so many packets over all luminaires brings, an estimate of all such light by
  /// itself.
  PhotonCatch shoot(std::uint32_t packets, std::uint32_t batch, const Options& options) const;

 private:
  class Task;
  /// A side from which a packet may go on: of a mirror, glass or narrow gloss.
  static bool is_mirror(const SurfaceModel& surfaces, TriangleId t, bool front);
  static std::vector<bool> mirrors_of(const Room& room);
  /// Bit k: ray k of these, of packets with these numbers, may go on from what it meets.
  std::uint32_t go_on(const Ray16& rays, int count, const std::uint32_t* id, std::uint32_t batch) const;
  /// A packet that leaves a luminaire, whose power changes on the way.
  struct Packet {
    Vec3f origin, direction;
    std::uint32_t id, batch;
    SurfaceId luminaire;
  };
  void follow(const Packet& packet, std::vector<float>& power, const Options& options,
              PhotonCatch& result) const;

  PacketRoom transport_;
  PacketSources emission_;
  std::uint64_t seed_;
  FaceSieve mirrors_;
};

}  // namespace reemit
