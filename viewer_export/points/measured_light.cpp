#include "viewer_export/points/measured_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "scenes/model/error.h"
#include "scenes/model/interrupted.h"
#include "scenes/model/limits.h"
#include "scenes/model/memory.h"
#include "solver/gather/gather_batch.h"
#include "solver/gather/replicate_gather.h"
#include "solver/solution/room_of_solution.h"
#include "solver/solution/thread_count.h"
#include "solver/tally/replicates.h"
#include "viewer_export/output/refinement.h"

namespace reemit {
namespace {

/// Independent estimates of each point, each from its own part of the zone solution.
constexpr std::size_t kReplicates = ZoneSums::kGroups;
/// Fixed, so that packets of rays are the same for any number of threads.
constexpr std::size_t kPointsOfTask = 16;
constexpr int kMostPlaces = 1 << 14;
/// Shadow rays end where their own error is so small a share of what is asked for, but not before so many
/// places: light that few of them meet is not to be missed.
constexpr double kLeastOfDirect = 0.35;
constexpr int kLeastWithShadowRays = 64;
/// Where nothing was found at any point of a set light may come through a small opening: up to so many places
/// a replicate, and gather rays of all points, are looked from before it is given up.
constexpr int kMostInTheDark = 1024;
constexpr double kMostRaysInTheDark = 2e7;
/// Noise is that of the zones where rays have less than so much of it.
constexpr double kRaysOfStalled = 0.7;

void check(const PointSet& set) {
  const auto fail = [&](const std::string& problem, const char* advice) {
    throw InputError(set.name.empty() ? "measure" : set.name, problem, advice);
  };
  if (set.size() == 0) fail("no points", "Leave the set out, or give it points.");
  if (set.normals.size() != set.size())
    fail(fmt::format("{} points and {} normals", set.size(), set.normals.size()),
         "Give one normal for each.");
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (const std::string problem = place_problem(set.places[i]); !problem.empty())
      fail(fmt::format("point {}: {}", i + 1, problem), kLengthAdvice);
    if (!(std::abs(set.normals[i].squaredNorm() - 1) < 1e-6))
      fail(fmt::format("point {}: its normal is not of length 1", i + 1), "Divide it by its length.");
  }
}

void check(const MeasureSettings& s, std::size_t points) {
  const auto require = [](bool good, const char* problem, const char* advice) {
    if (!good) throw InputError("measure", problem, advice);
  };
  require(points > 0, "no points", "Give a grid or a file of points.");
  require(s.gather_rays >= 1 && s.gather_rays <= 1 << 20, "number of gather rays is out of range",
          "Choose 1 to 1048576.");
  require(s.light_samples >= 1 && s.light_samples <= 1 << 16, "number of light samples is out of range",
          "Choose 1 to 65536.");
  require(s.error_target >= 0 && s.error_target < 1, "error is out of range",
          "Choose a share below 1, such as 1%.");
  require(s.threads >= 0, "number of threads is out of range", "Choose 0 (all cores) or more.");
}

/// Of all sets, in their order.
std::vector<MeasuringPoint> points_of(const RayTracer& rays, const std::vector<PointSet>& sets) {
  std::vector<MeasuringPoint> points;
  for (const PointSet& set : sets)
    for (std::size_t i = 0; i < set.size(); ++i)
      points.push_back(
          measuring_point(rays, set.places[i], set.normals[i], static_cast<std::uint32_t>(points.size())));
  return points;
}

/// Gathers at points and keeps what each replicate of each has brought.
class Measurer {
 public:
  Measurer(const Room& room, const Solution& solution, const std::vector<PointSet>& sets,
           const MeasureSettings& settings, const StopToken& stop)
      : room_(room),
        settings_(settings),
        stop_(stop),
        field_(room, solution, kReplicates),
        direct_(room),
        points_(points_of(room.rays(), sets)),
        gather_(
            field_, direct_,
            GatherSettings{
                .caustics = true, .in_air = points_, .seed = settings.seed, .plan = &solution.gather_plan},
            &stop_),
        bands_(room.band_count()) {}

  void gather_all(const std::vector<PointSet>& sets, const MeasureProgress& progress);
  MeasuredLight result(std::vector<PointSet> sets) const;

 private:
  /// Direct irradiance, and mean radiance over the hemisphere, of a replicate of a point.
  struct Part {
    const float* direct;
    const float* indirect;
  };
  Part part(std::size_t point, std::size_t replicate) const {
    const float* values = &means_[(point * kReplicates + replicate) * 2 * bands_];
    return {values, values + bands_};
  }
  double irradiance(std::size_t point, std::size_t replicate, std::size_t band) const {
    const Part values = part(point, replicate);
    return static_cast<double>(values.direct[band]) +
           std::numbers::pi * static_cast<double>(values.indirect[band]);
  }
  template <class Value>
  ReplicateMean mean(Value&& value) const {
    return mean_of_replicates(kReplicates, field_.parts(), value);
  }
  /// Mean and error of a number made of the bands of one point.
  template <class OfBands>
  Irradiance combined(std::size_t point, OfBands&& of_bands) const;
  SetSummary summary(std::size_t first, std::size_t last, const std::vector<Irradiance>& illuminance) const;
  ReplicateEffort effort() const {
    return ReplicateEffort::of(settings_.gather_rays, settings_.light_samples, static_cast<int>(kReplicates));
  }
  int most_places() const;
  /// Standard errors of points relative to their light, rms, worst band: of all of it, of what is direct, and
  /// what of the first is noise of rays, as the last doubling of them tells.
  struct Noise {
    double all = 0;
    double direct = 0;
    double rays = 0;

    void take(const Noise& other) {
      if (other.all > all) {
        all = other.all;
        rays = other.rays;
      }
      direct = std::max(direct, other.direct);
    }
  };
  Noise noise_of(std::size_t first, std::size_t last) const;
  Noise worst_noise(const std::vector<PointSet>& sets) const;
  void gather(std::size_t first, std::size_t last, int first_place, int places);
  /// Whether no ray has found light at any point of some set.
  bool any_is_dark(const std::vector<PointSet>& sets) const;

  const Room& room_;
  const MeasureSettings& settings_;
  StopToken stop_;
  RadianceField field_;
  DirectLight direct_;
  std::vector<MeasuringPoint> points_;
  HemisphereGather gather_;
  std::size_t bands_;
  std::vector<float> means_;  // by point, replicate, direct and indirect, band
  int most_with_shadow_rays_ = std::numeric_limits<int>::max();  // places; others only gather
  // What of the squared errors is noise of rays: the squares of the changes by the last doubling, as the two
  // halves of the rays are independent. Too much where sequences are even.
  std::vector<double> of_rays_;  // by point, band
  bool limited_by_zones_ = false;
};

int Measurer::most_places() const {
  if (settings_.error_target == 0) return effort().points;
  const auto of_numbers = std::bit_floor(PathKey::kMostPaths / static_cast<unsigned>(effort().gathers));
  return std::max(1, std::min(kMostPlaces, static_cast<int>(of_numbers)));
}

void Measurer::gather(std::size_t first, std::size_t last, int first_place, int places) {
  const std::size_t values = 2 * bands_;
  std::vector<float> found((last - first) * kReplicates * values, 0.0F);
  GatherBatch batch(gather_, effort().gathers);
  const bool with_shadow_rays = first_place < most_with_shadow_rays_;
  const ReplicateEffort of_replicate{places, effort().gathers, first_place, with_shadow_rays};
  const int log2_places = std::countr_zero(static_cast<unsigned>(most_places()));
  const std::vector<float> over_pi(bands_, std::numbers::inv_pi_v<float>);  // to mean radiance
  float* next = found.data();
  for (std::size_t i = first; i < last; ++i)
    for (std::size_t r = 0; r < kReplicates; ++r, next += values) {
      if (stop_.requested()) return;
      const PointSampler sampler(settings_.seed, RngPurpose::kMeasuringPoint, i, static_cast<int>(r),
                                 log2_places);
      const PathKey key{i, static_cast<std::uint32_t>(r), 0, static_cast<std::uint32_t>(r % field_.parts())};
      add_replicate(
          direct_, sampler, of_replicate, key, [&](const std::array<float, 2>&) { return points_[i]; }, batch,
          next, next + bands_);
      gather_.caustics().add_irradiance(points_[i], key.part, over_pi.data(), next + bands_);
    }
  batch.flush();
  const float share = static_cast<float>(places) / static_cast<float>(first_place + places);
  float* means = &means_[first * kReplicates * values];
  std::fill_n(&of_rays_[first * bands_], (last - first) * bands_, 0.0);
  for (std::size_t r = 0; r < (last - first) * kReplicates; ++r)
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t direct = r * values + b;
      const std::size_t indirect = direct + bands_;
      const float more_direct = with_shadow_rays ? share * (found[direct] - means[direct]) : 0;
      const float more_indirect = share * (found[indirect] - means[indirect]);
      means[direct] += more_direct;
      means[indirect] += more_indirect;
      const double change =
          static_cast<double>(more_direct) + std::numbers::pi * static_cast<double>(more_indirect);
      of_rays_[(first + r / kReplicates) * bands_ + b] += change * change / (kReplicates * kReplicates);
    }
}

void Measurer::gather_all(const std::vector<PointSet>& sets, const MeasureProgress& progress) {
  const std::size_t values = points_.size() * kReplicates * 2 * bands_;
  check_memory(fmt::format("{} points", points_.size()), static_cast<double>(values * sizeof(float)),
               available_memory());
  means_.assign(values, 0.0F);
  of_rays_.assign(points_.size() * bands_, 0.0);
  const std::size_t chunks = (points_.size() + kPointsOfTask - 1) / kPointsOfTask;
  const bool has_target = settings_.error_target > 0;
  const double rays_of_place = static_cast<double>(points_.size() * kReplicates) * effort().gathers;
  const int most_in_the_dark =
      static_cast<int>(std::clamp(kMostRaysInTheDark / rays_of_place, 1.0, double{kMostInTheDark}));
  double share_done = 0;
  std::mutex progress_mutex;
  RefinedPart all;  // of which there is one: every point gets the same samples
  for (int done = 0; all.is_active() && done < most_places();) {
    const int more = has_target ? std::max(1, done) : effort().points;
    std::size_t chunks_done = 0;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
      gather(c * kPointsOfTask, std::min((c + 1) * kPointsOfTask, points_.size()), done, more);
      const std::lock_guard lock(progress_mutex);
      ++chunks_done;
      if (progress)
        progress(has_target ? share_done : static_cast<double>(chunks_done) / static_cast<double>(chunks));
    });
    if (stop_.requested()) throw Interrupted("measuring was interrupted");
    done += more;
    if (!has_target) return;
    const Noise noise = worst_noise(sets);
    const double excess = std::pow(noise.all / RefinedPart::aim(settings_.error_target), 2);
    const bool looks_into_the_dark = done < most_in_the_dark && any_is_dark(sets);
    share_done =
        looks_into_the_dark ? static_cast<double>(done) / most_in_the_dark : std::min(1.0, 1 / excess);
    if (done >= kLeastWithShadowRays && done < most_with_shadow_rays_ &&
        noise.direct < kLeastOfDirect * settings_.error_target)
      most_with_shadow_rays_ = done;
    if (looks_into_the_dark) continue;
    all.look(excess, excess, noise.rays < kRaysOfStalled * noise.all);
  }
  limited_by_zones_ = all.is_stalled();
}

Measurer::Noise Measurer::noise_of(std::size_t first, std::size_t last) const {
  Noise worst;
  for (std::size_t b = 0; b < bands_; ++b) {
    double all = 0;
    double direct = 0;
    double rays = 0;
    double values = 0;
    for (std::size_t i = first; i < last; ++i) {
      const ReplicateMean light = mean([&](std::size_t r) { return irradiance(i, r, b); });
      all += light.squared_error;
      values += light.mean * light.mean;
      direct += mean([&](std::size_t r) { return static_cast<double>(part(i, r).direct[b]); }).squared_error;
      rays += of_rays_[i * bands_ + b];
    }
    if (!(values > 0)) continue;
    worst.take({std::sqrt(all / values), std::sqrt(direct / values), std::sqrt(rays / values)});
  }
  return worst;
}

Measurer::Noise Measurer::worst_noise(const std::vector<PointSet>& sets) const {
  Noise worst;
  std::size_t first = 0;
  for (const PointSet& set : sets) {
    worst.take(noise_of(first, first + set.size()));
    first += set.size();
  }
  return worst;
}

bool Measurer::any_is_dark(const std::vector<PointSet>& sets) const {
  std::size_t first = 0;
  for (const PointSet& set : sets) {
    const auto begin = means_.begin() + static_cast<std::ptrdiff_t>(first * kReplicates * 2 * bands_);
    first += set.size();
    const auto end = means_.begin() + static_cast<std::ptrdiff_t>(first * kReplicates * 2 * bands_);
    if (std::all_of(begin, end, [](float light) { return light == 0; })) return true;
  }
  return false;
}

template <class OfBands>
Irradiance Measurer::combined(std::size_t point, OfBands&& of_bands) const {
  const auto all =
      mean([&](std::size_t r) { return of_bands([&](std::size_t b) { return irradiance(point, r, b); }); });
  const auto direct = mean([&](std::size_t r) {
    return of_bands([&](std::size_t b) { return static_cast<double>(part(point, r).direct[b]); });
  });
  return {static_cast<float>(all.mean), static_cast<float>(std::sqrt(all.squared_error)),
          static_cast<float>(direct.mean)};
}

SetSummary Measurer::summary(std::size_t first, std::size_t last,
                             const std::vector<Irradiance>& illuminance) const {
  const Spectrum& efficacy = room_.scene().bands.efficacy_lm_per_w();
  const auto [mean_of_set, squared_error] = mean([&](std::size_t r) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t b = 0; b < bands_; ++b)
        sum += efficacy[static_cast<Eigen::Index>(b)] * irradiance(i, r, b);
    return sum / static_cast<double>(last - first);
  });
  const auto [least, most] =
      std::minmax_element(illuminance.begin() + static_cast<std::ptrdiff_t>(first),
                          illuminance.begin() + static_cast<std::ptrdiff_t>(last),
                          [](const Irradiance& a, const Irradiance& b) { return a.all < b.all; });
  SetSummary summary{mean_of_set, std::sqrt(squared_error),  least->all,
                     most->all,   noise_of(first, last).all, {}};
  for (std::size_t i = first; i < last; ++i)
    if (!(illuminance[i].all > 0)) summary.dark_points.push_back(i - first);
  // Rays that find nothing do not tell how much light they missed.
  if (summary.dark_points.size() == last - first)
    summary.standard_error = summary.error = std::numeric_limits<double>::infinity();
  return summary;
}

MeasuredLight Measurer::result(std::vector<PointSet> sets) const {
  const Spectrum& efficacy = room_.scene().bands.efficacy_lm_per_w();
  MeasuredLight light;
  light.bands = room_.scene().bands;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t b = 0; b < bands_; ++b)
      light.irradiance.push_back(combined(i, [b](auto&& value) { return value(b); }));
    light.illuminance.push_back(combined(i, [&](auto&& value) {
      double sum = 0;
      for (std::size_t b = 0; b < bands_; ++b) sum += efficacy[static_cast<Eigen::Index>(b)] * value(b);
      return sum;
    }));
  }
  std::size_t first = 0;
  for (const PointSet& set : sets) {
    light.summaries.push_back(summary(first, first + set.size(), light.illuminance));
    light.info.error = std::max(light.info.error, light.summaries.back().error);
    first += set.size();
  }
  light.sets = std::move(sets);
  light.limited_by_zones = limited_by_zones_;
  light.has_photons = gather_.caustics().exists();
  return light;
}

void describe(const Scene& scene, const Solution& solution, const MeasureSettings& settings,
              MeasuredLight& light) {
  ExportInfo& info = light.info;
  state_origin(scene, solution, info);
  info.zones = solution.record.gather_bias;
  if (scene.sky) info.settings.emplace_back("sky", scene.sky->description);
  if (settings.error_target == 0) {
    info.settings.emplace_back("gather rays", static_cast<std::uint64_t>(settings.gather_rays));
    info.settings.emplace_back("light samples", static_cast<std::uint64_t>(settings.light_samples));
  }
  info.settings.emplace_back("gather seed", settings.seed);
  if (scene.sky && scene.sky->kind != SkyKind::kNone)
    light.outside =
        (scene.bands.efficacy_lm_per_w() * horizontal_sky_irradiance(*scene.sky, scene.bands)).sum();
}

}  // namespace

MeasuredLight measure_light(const Room& room, const Solution& solution, std::vector<PointSet> sets,
                            const MeasureSettings& settings, const MeasureProgress& progress,
                            const std::atomic<bool>& interrupt) {
  std::size_t points = 0;
  for (const PointSet& set : sets) points += set.size();
  check(settings, points);
  for (const PointSet& set : sets) check(set);
  check_is_room_of(solution, room.scene(), room.mesh());
  MeasuredLight light;
  tbb::task_arena arena(thread_count(settings.threads));
  arena.execute([&] {
    if (progress) progress(0);  // photons may take a while
    Measurer measurer(room, solution, sets, settings, StopToken(interrupt));
    measurer.gather_all(sets, progress);
    light = measurer.result(std::move(sets));
  });
  describe(room.scene(), solution, settings, light);
  if (!light.info.error_is_known)
    for (SetSummary& of_set : light.summaries)
      of_set.standard_error = of_set.error = std::numeric_limits<double>::infinity();
  return light;
}

}  // namespace reemit
