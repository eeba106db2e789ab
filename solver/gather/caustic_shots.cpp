#include "solver/gather/caustic_shots.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "solver/gather/photon_radii.h"

namespace reemit {
namespace {

constexpr std::uint32_t kProbe = 1U << 15;
constexpr double kLeastPackets = 1U << 18, kMostPackets = 1U << 23;
constexpr double kWantedPhotons = 800'000;
/// Packets of the pilot, which tells how dense photons are and is not counted itself, over those of all
/// parts.
constexpr double kPilotShare = 0.25;
/// Batches of the probe and the pilot; those of the parts are 0, 1, ...
constexpr std::uint32_t kProbeBatch = 1U << 20, kPilotBatch = kProbeBatch + 1;

/// Packets of all parts together; 0 if of a few none becomes a photon.
std::uint32_t packets_wanted(const CausticShooter& shooter, const StopToken* stop) {
  const std::size_t probed = shooter.shoot(kProbe, kProbeBatch, {.stop = stop}).size();
  if (probed == 0) return 0;
  return static_cast<std::uint32_t>(
      std::clamp(kWantedPhotons * kProbe / static_cast<double>(probed), kLeastPackets, kMostPackets));
}

CausticPhotons shoot_part(const CausticShooter& shooter, std::uint32_t packets, std::size_t part,
                          const CausticShooter::Options& options) {
  return shooter.shoot(packets / CausticShots::kParts, static_cast<std::uint32_t>(part), options);
}

std::size_t photon_count(const CausticShots& shots) {
  std::size_t count = 0;
  for (const CausticPhotons& part : shots.parts) count += part.size();
  return count;
}

/// Without `known`; which packets brought photons into `brings`, if given, by part.
CausticShots shoot_all(const CausticShooter& shooter, std::vector<CausticShooter::Marks>* brings,
                       const StopToken* stop) {
  CausticShots shots;
  shots.packets = packets_wanted(shooter, stop);
  if (shots.packets == 0) return shots;
  const auto of_pilot = static_cast<std::uint32_t>(kPilotShare * shots.packets);
  const PhotonRadii radii(shooter.shoot(of_pilot, kPilotBatch, {.stop = stop}),
                          static_cast<float>(kPilotShare));
  if (brings != nullptr) brings->resize(CausticShots::kParts);
  tbb::parallel_for(std::size_t{0}, CausticShots::kParts, [&](std::size_t p) {
    shots.parts[p] = shoot_part(shooter, shots.packets, p,
                                {.brought = brings != nullptr ? &(*brings)[p] : nullptr, .stop = stop});
  });
  radii.set(shots.parts, stop);
  return shots;
}

}  // namespace

CausticShots shoot_caustics(const CausticShooter& shooter, const CausticPackets* known,
                            const StopToken* stop) {
  if (known != nullptr && known->packets == 0) return {};
  if (known == nullptr || known->brings.size() != CausticShots::kParts || known->packets > kMostPackets)
    return shoot_all(shooter, nullptr, stop);
  CausticShots shots;
  shots.packets = known->packets;
  tbb::parallel_for(std::size_t{0}, CausticShots::kParts, [&](std::size_t p) {
    shots.parts[p] = shoot_part(shooter, known->packets, p, {.marked = &known->brings[p], .stop = stop});
  });
  if (photon_count(shots) != known->radius_codes.size()) return shoot_all(shooter, nullptr, stop);
  auto codes = known->radius_codes.begin();
  for (CausticPhotons& part : shots.parts) {
    const auto end = codes + static_cast<std::ptrdiff_t>(part.size());
    part.radius_codes.assign(codes, end);
    codes = end;
  }
  return shots;
}

CausticPackets find_caustic_packets(const CausticShooter& shooter, const StopToken* stop) {
  CausticPackets found;
  const CausticShots shots = shoot_all(shooter, &found.brings, stop);
  found.packets = shots.packets;
  for (const CausticPhotons& part : shots.parts)
    found.radius_codes.insert(found.radius_codes.end(), part.radius_codes.begin(), part.radius_codes.end());
  return found;
}

}  // namespace reemit
