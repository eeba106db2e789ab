#include "solver/gather/discretisation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <tbb/parallel_for.h>

#include "solver/gather/gather_batch.h"
#include "solver/gather/replicate_gather.h"
#include "solver/gather/zone_probes.h"

namespace reemit {
namespace {

constexpr std::size_t kFieldHalves = 2;
constexpr ReplicateEffort kEffort{16, 4};
constexpr std::size_t kProbesPerTask = 64;
/// An estimate that may as well be this many times larger says nothing, unless all it can be is small.
constexpr double kMostUncertain = 2;
constexpr double kSmallEnough = 0.03;
/// Added to the number of a half: random numbers of what is gathered on the other side of a sheet.
constexpr int kOfOtherSide = 4;

/// What of the light on its other side comes through diffusely, by band; null: nothing does.
const float* diffuse_transmittance(const Room& room, const SurfacePoint& x) {
  if (!room.surfaces().is_specular(x.triangle, x.front)) return nullptr;
  const SpecularSurface& surface = room.surfaces().specular(x.triangle);
  return surface.diffuses() ? surface.diffuse_transmittance().data() : nullptr;
}

}  // namespace

std::optional<double> discretisation_error(const Room& room, const Solution& solution, const StopToken& stop,
                                           std::size_t probe_count) {
  if (stop.requested()) return std::nullopt;
  const RadianceField field(room, solution, kFieldHalves);
  if (field.parts() != kFieldHalves || field.has_light_that_rays_miss()) return std::nullopt;
  const std::size_t bands = room.band_count();
  const std::uint64_t seed = solution.settings.seed;
  const DirectLight direct(room);
  const HemisphereGather gather(field, direct, GatherSettings{.continue_uneven = false, .seed = seed});
  const CounterRng rng(seed, RngPurpose::kDiscretisation);
  constexpr std::uint32_t kOfProbes = kFieldHalves;  // batches of numbers that no half of the field uses
  const std::vector<ZoneProbe> probes =
      choose_probes(solution, probe_count, static_cast<double>(rng.uniform4(0, kOfProbes + 1, 0)[0]));

  // By probe and band: product of the two differences, product of the two zone values.
  std::vector<double> differences(probes.size() * bands);
  std::vector<double> values(probes.size() * bands);
  const std::size_t chunks = (probes.size() + kProbesPerTask - 1) / kProbesPerTask;
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    if (stop.requested()) return;
    const std::size_t first = c * kProbesPerTask;
    const std::size_t last = std::min(first + kProbesPerTask, probes.size());
    // By probe, half and side: direct, indirect, by band.
    std::vector<float> found((last - first) * kFieldHalves * 4 * bands, 0.0F);
    std::vector<const float*> through(last - first, nullptr);
    GatherBatch batch(gather, kEffort.gathers);
    float* next = found.data();
    for (std::size_t i = first; i < last; ++i) {
      const std::array<float, 4> u = rng.uniform4(i, kOfProbes, 0);
      const SurfacePoint x = point_in_zone(room, probes[i].zone, {u[0], u[1]});
      through[i - first] = diffuse_transmittance(room, x);
      const auto gather_at = [&](const SurfacePoint& at, int replicate, std::uint32_t part, float* light) {
        const PointSampler sampler(seed, RngPurpose::kDiscretisation, i, replicate,
                                   std::countr_zero(static_cast<unsigned>(kEffort.points)));
        add_replicate(
            direct, sampler, kEffort, {i, static_cast<std::uint32_t>(replicate), 0, part},
            [&](const auto&) { return at; }, batch, light, light + bands);
      };
      for (int half = 0; half < static_cast<int>(kFieldHalves); ++half, next += 4 * bands) {
        const auto part = static_cast<std::uint32_t>(half);
        gather_at(x, half, part, next);
        if (through[i - first] != nullptr)
          gather_at(other_side(room.rays(), x), half + kOfOtherSide, part, next + 2 * bands);
      }
    }
    batch.flush();
    for (std::size_t i = first; i < last; ++i) {
      const float* reflectance = room.zone_reflectance(probes[i].zone);
      for (std::size_t b = 0; b < bands; ++b) {
        double difference = probes[i].area;
        double value = probes[i].area;
        for (std::size_t half = 0; half < kFieldHalves; ++half) {
          const float* light = &found[((i - first) * kFieldHalves + half) * 4 * bands];
          const auto radiance = [&](const float* of_side) {
            return static_cast<double>(of_side[b]) / std::numbers::pi +
                   static_cast<double>(of_side[bands + b]);
          };
          double at_point = static_cast<double>(reflectance[b]) * radiance(light);
          if (const float* share = through[i - first]; share != nullptr)
            at_point += static_cast<double>(share[b]) * radiance(light + 2 * bands);
          const double of_zone = static_cast<double>(field.reflected(probes[i].zone, half)[b]);
          difference *= at_point - of_zone;
          value *= of_zone;
        }
        differences[i * bands + b] = difference;
        values[i * bands + b] = value;
      }
    }
  });

  if (stop.requested()) return std::nullopt;
  std::optional<double> worst;
  for (std::size_t b = 0; b < bands; ++b) {
    double difference = 0;
    double squares = 0;
    double value = 0;
    for (std::size_t k = b; k < values.size(); k += bands) {
      difference += differences[k];
      squares += differences[k] * differences[k];
      value += values[k];
    }
    if (!(value > 0)) continue;
    // The sum over the probes has about this standard error.
    const double low = std::sqrt(std::max(0.0, difference) / value);
    const double high = std::sqrt((std::max(0.0, difference) + 2 * std::sqrt(squares)) / value);
    const bool is_certain = high <= kMostUncertain * low;
    if (!is_certain && high > kSmallEnough) return std::nullopt;
    worst = std::max(worst.value_or(0), is_certain ? low : high);
  }
  return worst;
}

}  // namespace reemit
