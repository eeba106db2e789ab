#pragma once
#include <cstdint>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/room/room.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {

/// Packets of luminaires that came to Lambertian surfaces over mirrors, glass or narrow gloss.
struct CausticPhotons {
  std::vector<Vec3f> places;          ///< Normalised.
  std::vector<Vec3f> normals;         ///< Unit, of the side that was met.
  std::vector<float> power;           ///< [photon * bands + band] [W]
  std::vector<TriangleId> triangles;  ///< That was met.
  std::vector<SurfaceId> luminaires;  ///< That they come from; not valid for lights without area.

  std::size_t size() const { return places.size(); }
};

/// Shoots such packets. One for a room; const members may be called from any thread.
class CausticShooter {
 public:
  /// The room must outlive it.
  CausticShooter(const Room& room, std::uint64_t seed);

  /// Packets of a batch of `packets` that each square unit (normalised) of a surface emits; 0 where it emits
  /// nothing.
  std::vector<float> density_of_surfaces(double packets) const;
  /// What a batch of about so many packets over all luminaires brings, an estimate of all such light by
  /// itself. Ends early, with less light than there is, when `stop` (may be null) is requested.
  CausticPhotons shoot(std::uint32_t packets, std::uint32_t batch, const StopToken* stop) const;

 private:
  void follow(const Vec3f& origin, const Vec3f& direction, std::uint32_t id, std::uint32_t batch,
              SurfaceId luminaire, std::vector<float>& power, CausticPhotons& result) const;

  PacketRoom transport_;
  PacketSources emission_;
  std::uint64_t seed_;
};

}  // namespace reemit
