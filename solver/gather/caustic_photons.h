#pragma once
#include <cstdint>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/room/room.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {

/// Least cosine between normals of points of one face, or of faces that go on about as each other do.
inline constexpr float kSameFace = 0.8F;

/// Packets of luminaires that came to Lambertian surfaces over mirrors, glass or narrow gloss.
struct CausticPhotons {
  std::vector<Vec3f> places;          ///< Normalised.
  std::vector<Vec3f> normals;         ///< Unit, of the side that was met.
  std::vector<float> power;           ///< [photon * bands + band] [W]
  std::vector<TriangleId> triangles;  ///< That was met.
  std::vector<SurfaceId> luminaires;  ///< That they come from; not valid for lights without area.

  std::vector<std::uint8_t> radius_codes;  ///< Of the kernels, once they are set (photon_radii.h).

  std::size_t size() const { return places.size(); }
  void append(const CausticPhotons& more);
  /// True if photon i, within a radius of a place, met the face there or one that goes on as it does.
  bool is_on_face(std::uint32_t i, const Vec3f& normal, const Vec3f& place, float radius) const;
};

/// One estimate of the light from several, whose photons become parts of it.
CausticPhotons mean_of(std::vector<CausticPhotons> estimates);

/// Shoots such packets. One for a room; const members may be called from any thread.
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
    Marks* brought = nullptr;         ///< Receives which packets brought photons.
    const StopToken* stop = nullptr;  ///< When requested it ends early, with less light than there is.
  };
  /// What a batch of about so many packets over all luminaires brings, an estimate of all such light by
  /// itself.
  CausticPhotons shoot(std::uint32_t packets, std::uint32_t batch, const Options& options) const;

 private:
  /// Bit k: ray k of these meets a mirror, glass or gloss.
  std::uint32_t meet_mirrors(const Ray16& rays, int count) const;
  void follow(const Vec3f& origin, const Vec3f& direction, std::uint32_t id, std::uint32_t batch,
              SurfaceId luminaire, std::vector<float>& power, CausticPhotons& result) const;

  PacketRoom transport_;
  PacketSources emission_;
  std::uint64_t seed_;
};

}  // namespace reemit
