#include "solver/gather/caustic_shots.h"

#include <algorithm>
#include <utility>

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
std::uint32_t packets_wanted(const CausticShooter& shooter, const AirSheets* sheets, const StopToken* stop) {
  const PhotonCatch probe =
      shooter.shoot(kProbe, kProbeBatch, {.stop = stop, .sheets = sheets, .reach = kLargestPhotonRadius});
  const std::size_t on_surfaces = probe.on_surfaces.size();
  const std::size_t probed = on_surfaces > 0 ? on_surfaces : probe.in_air.size();
  if (probed == 0) return 0;
  return static_cast<std::uint32_t>(
      std::clamp(kWantedPhotons * kProbe / static_cast<double>(probed), kLeastPackets, kMostPackets));
}

PhotonCatch shoot_part(const CausticShooter& shooter, std::uint32_t packets, std::size_t part,
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
                       const StopToken* stop, const AirSheets* sheets = nullptr, int rounds = 1) {
  CausticShots shots;
  shots.packets = packets_wanted(shooter, sheets, stop);
  if (shots.packets == 0) return shots;
  const auto of_pilot = static_cast<std::uint32_t>(kPilotShare * shots.packets);
  PhotonCatch pilot =
      shooter.shoot(of_pilot, kPilotBatch, {.stop = stop, .sheets = sheets, .reach = kPilotReach});
  const PhotonRadii radii(std::move(pilot.on_surfaces), static_cast<float>(kPilotShare));
  if (brings != nullptr) brings->resize(CausticShots::kParts);
  tbb::parallel_for(std::size_t{0}, CausticShots::kParts, [&](std::size_t p) {
    PhotonCatch part = shoot_part(shooter, shots.packets, p,
                                  {.brought = brings != nullptr ? &(*brings)[p] : nullptr,
                                   .stop = stop,
                                   .sheets = sheets,
                                   .reach = kLargestPhotonRadius});
    shots.parts[p] = std::move(part.on_surfaces);
    std::vector<CausticPhotons> in_air{std::move(part.in_air)};
    for (int round = 1; round < rounds; ++round)
      in_air.push_back(shoot_part(shooter, shots.packets,
                                  p + static_cast<std::size_t>(round) * CausticShots::kParts,
                                  {.stop = stop, .sheets = sheets, .reach = kLargestPhotonRadius})
                           .in_air);
    shots.in_air[p] = mean_of(std::move(in_air));
  });
  radii.set(shots.parts, stop);
  if (sheets != nullptr)
    PhotonRadii(std::move(pilot.in_air), static_cast<float>(kPilotShare)).set(shots.in_air, stop);
  return shots;
}

}  // namespace

CausticPhotons mean_of_parts(std::array<CausticPhotons, CausticShots::kParts>& all, std::size_t p,
                             std::size_t parts) {
  std::vector<CausticPhotons> together;
  for (std::size_t k = p; k < CausticShots::kParts; k += parts) together.push_back(std::move(all[k]));
  return mean_of(std::move(together));
}

CausticShots shoot_caustics(const CausticShooter& shooter, const CausticPackets* known,
                            const StopToken* stop) {
  if (known != nullptr && known->packets == 0) return {};
  if (known == nullptr || known->brings.size() != CausticShots::kParts || known->packets > kMostPackets)
    return shoot_all(shooter, nullptr, stop);
  CausticShots shots;
  shots.packets = known->packets;
  tbb::parallel_for(std::size_t{0}, CausticShots::kParts, [&](std::size_t p) {
    shots.parts[p] =
        shoot_part(shooter, known->packets, p, {.marked = &known->brings[p], .stop = stop}).on_surfaces;
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

CausticShots shoot_caustics(const CausticShooter& shooter, const AirSheets& sheets, int rounds,
                            const StopToken* stop) {
  return shoot_all(shooter, nullptr, stop, &sheets, rounds);
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
