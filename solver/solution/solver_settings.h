#pragma once
#include <cstdint>
#include <string>

namespace reemit {

/// How the light of zones is found.
enum class SolveMethod { kShooting, kWalk, kMatrix };
/// Where the numbers of packets come from: independent ones, or sequences of low discrepancy.
enum class SamplingKind { kRandom, kSobol };
/// Where packets leave a zone that reflects them: where light met it, or anywhere in it with equal odds, as
/// the matrix method has it.
enum class Reemission { kFromHits, kFromZones };
/// How shooting finds the direct light of zones: by shadow rays where that pays (SampledDirectLight), or by
/// packets in any case, as walks do.
enum class DirectSource { kBest, kPackets };

/// Packets of one batch are counted in 32 bits.
inline constexpr std::uint64_t kMostBatchPackets = std::uint64_t{1} << 31;

/// Settings of the zone solution. A limit of 0 means that this rule does not stop the run; the
/// matrix method has no stopping rules.
struct SolverSettings {
  SolveMethod method = SolveMethod::kShooting;
  SamplingKind sampling = SamplingKind::kSobol;  ///< Of points and directions of each flight.
  Reemission reemission = Reemission::kFromHits;
  DirectSource direct = DirectSource::kBest;
  double error_target = 0;  ///< Relative rms standard error of radiosity, worst band, as a fraction [0,1).
  double time_limit_s = 0;  ///< Wall time of all sittings of the solve [s], >= 0.
  // Without any of error, time and packets it goes on until it is interrupted.
  /// Packets of all batches together, into which the power of luminaires is dealt out equally. Where direct
  /// light is sampled several of them travel together at first (BatchTask::first_together).
  std::uint64_t packets = 0;
  std::uint64_t batch_packets = 0;  ///< Of one batch, up to kMostBatchPackets; 0 = from the number of zones.
  int smallest_batch_count = 16;    ///< Batches before an error is believed [2, 65536].
  double stop_share = 1e-5;  ///< Shooting: walks take over when unshot/emitted falls below this (0, 0.1].
  /// Zones too small to meet enough packets get their light by gathering when the packets are done.
  bool gather_small_zones = true;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0 = all cores; more than there are cores means all.
};

/// Throws InputError for a number out of its range, with the range.
void check(const SolverSettings& settings);

std::string to_string(SolveMethod method);     ///< "shooting", "walk" or "matrix".
std::string to_string(SamplingKind sampling);  ///< "random" or "sobol".
std::string to_string(Reemission reemission);  ///< "hits" or "zones".
std::string to_string(DirectSource direct);    ///< "best" or "packets".

}  // namespace reemit
