// The room whose luminaires are 7,381 spheres against the same room with one of them.
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/convergence/jobs.h"
#include "bench/many_luminaires/irradiance_error.h"
#include "bench/many_luminaires/lit_room.h"
#include "bench/many_luminaires/parts.h"
#include "bench/many_luminaires/sample_cost.h"
#include "scenes/io/scene_reader.h"

namespace reemit::bench {
namespace {

constexpr const char* kSphereflake = "sphereflake";
constexpr const char* kFlakeCamera = "floor";
/// Constant selection scatters so much more than the others that its error at the same points takes this many
/// times their samples to measure; at few points even more.
constexpr int kForConstant = 16;
constexpr int kForConstantAtFew = 64;

struct FlakeEffort {
  int width = 96;  // of the picture whose pixels are the points
  int height = 72;
  int rounds = 15;
  int samples_timed = 8;  // per point and round
  int samples = 256;      // per point, of which the error is asked for
  int reference_samples = 16384;
  std::size_t linear_stride = 64;  // linear selection looks at 7,381 luminaires: few points
  int linear_samples = 64;
};

FlakeEffort flake_effort(const RunSettings& settings) {
  if (!settings.quick) return {};
  return {.width = 48, .height = 36, .rounds = 5, .samples = 64, .reference_samples = 2048};
}

/// A set of points, the same in both rooms.
struct Subject {
  std::string name;
  std::vector<SurfacePoint> all_lamps;
  std::vector<SurfacePoint> one_lamp;
};

std::size_t luminaires_of(const Scene& scene) {
  std::size_t count = 0;
  for (const Surface& s : scene.surfaces)
    if (scene.material_of(s).emits()) count += s.faces.size() + s.shapes.size();
  return count;
}

std::vector<Subject> subjects_of(const LitRoom& all_lamps, const LitRoom& one_lamp,
                                 const FlakeEffort& effort) {
  const auto points_of = [&](const LitRoom& room) {
    return seen_points(room, camera_named(room.scene(), kFlakeCamera), effort.width, effort.height);
  };
  std::vector<Subject> subjects{
      {"all points", points_of(all_lamps), points_of(one_lamp)}, {"floor", {}, {}}, {"spheres", {}, {}}};
  const Subject& all = subjects.front();
  if (all.all_lamps.size() != all.one_lamp.size()) throw std::runtime_error("the two rooms differ in shape");
  for (std::size_t i = 0; i < all.all_lamps.size(); ++i) {
    const auto place = [](const LitRoom& room, const SurfacePoint& x) {
      return room.rays().point(x.triangle, x.u, x.v);
    };
    const SurfacePoint& a = all.all_lamps[i];
    const SurfacePoint& b = all.one_lamp[i];
    if ((place(all_lamps, a) - place(one_lamp, b)).norm() > 1e-4F)
      throw std::runtime_error("the two rooms differ in shape");
    Subject& kind = subjects[all_lamps.rays().is_curved(a.triangle) ? 2 : 1];
    kind.all_lamps.push_back(a);
    kind.one_lamp.push_back(b);
  }
  return subjects;
}

class Sphereflake {
 public:
  Sphereflake(const RunSettings& settings, Figures& figures, const LitRoom& all_lamps,
              const LitRoom& one_lamp)
      : settings_(settings),
        effort_(flake_effort(settings)),
        figures_(figures),
        all_lamps_(all_lamps),
        one_lamp_(one_lamp),
        count_(luminaires_of(all_lamps.scene())),
        subjects_(subjects_of(all_lamps, one_lamp, effort_)),
        few_{"few points", every(subjects_.front().all_lamps, effort_.linear_stride), {}} {
    for (const Selection s : kSelections) {
      const double seconds = seconds_of([&] { lights_.push_back(all_lamps.light(s)); });
      add("all points", name_of(s), "table built in [ms]", spread_of({1e3 * seconds}));
    }
    figures.notes.push_back(
        fmt::format("sphereflake: {} luminaires of {} spheres; {} points that camera '{}' sees at {}x{} px, "
                    "{} of them on the "
                    "floor; every {}th of them for linear selection",
                    count_, luminaires_of(all_lamps.scene()), subjects_[0].all_lamps.size(), kFlakeCamera,
                    effort_.width, effort_.height, subjects_[1].all_lamps.size(), effort_.linear_stride));
  }

  void run() {
    measure_times();
    measure_errors();
  }

 private:
  void add(const std::string& subject, std::string_view selection, const std::string& quantity,
           const Spread& value) {
    figures_.add(
        {kSphereflake, subject, selection == kOneLamp ? 1 : count_, std::string(selection), quantity, value});
  }

  const DirectLight& light(Selection s) const { return lights_[static_cast<std::size_t>(s)]; }

  void measure_times() {
    const DirectLight one = one_lamp_.light(std::nullopt);
    std::vector<Candidate> candidates;
    for (const Subject& s : subjects_) {
      candidates.push_back({&one, &s.one_lamp, effort_.samples_timed});
      candidates.push_back({&light(Selection::kConstant), &s.all_lamps, effort_.samples_timed});
      candidates.push_back({&light(Selection::kSpatial), &s.all_lamps, effort_.samples_timed});
    }
    candidates.push_back({&light(Selection::kLinear), &few_.all_lamps, 1});
    candidates.push_back({&light(Selection::kConstant), &few_.all_lamps, 16 * effort_.samples_timed});
    const auto times = sample_times_ns(candidates, effort_.rounds);
    for (std::size_t i = 0; i < subjects_.size(); ++i) {
      const std::string& name = subjects_[i].name;
      const auto& of_one = times[3 * i];
      const auto& of_constant = times[3 * i + 1];
      const auto& of_spatial = times[3 * i + 2];
      add(name, kOneLamp, "time per sample [ns]", spread_of(of_one));
      add(name, name_of(Selection::kConstant), "time per sample [ns]", spread_of(of_constant));
      add(name, name_of(Selection::kSpatial), "time per sample [ns]", spread_of(of_spatial));
      add(name, name_of(Selection::kConstant), "time over that of one lamp",
          spread_of(ratios(of_constant, of_one)));
      add(name, name_of(Selection::kSpatial), "time over that of one lamp",
          spread_of(ratios(of_spatial, of_one)));
      spatial_over_constant_.push_back(spread_of(ratios(of_spatial, of_constant)).median);
    }
    const auto& of_linear = times[times.size() - 2];
    add(few_.name, name_of(Selection::kLinear), "time per sample [ns]", spread_of(of_linear));
    linear_over_constant_ = spread_of(ratios(of_linear, times.back())).median;
  }

  void measure_errors() {
    for (std::size_t i = 0; i < subjects_.size(); ++i)
      errors_at(subjects_[i], Selection::kSpatial, {kForConstant * effort_.samples, effort_.samples},
                spatial_over_constant_[i]);
    errors_at(few_, Selection::kLinear, {kForConstantAtFew * effort_.linear_samples, effort_.linear_samples},
              linear_over_constant_);
  }

  /// Errors of constant selection and of another one at the same points, with so many samples at each.
  void errors_at(const Subject& subject, Selection other, const std::array<int, 2>& samples_of,
                 double time_over_constant) {
    const std::vector<float> weights = illuminance_weights(all_lamps_.scene());
    const PointValues reference =
        reference_values(light(Selection::kSpatial), subject.all_lamps, weights, effort_.reference_samples,
                         kReferenceSeed, settings_.threads);
    const double own = rms_relative_error(reference);
    add(subject.name, "reference", "its own error", spread_of({own}));
    std::vector<double> factors;
    std::vector<std::vector<double>> variances(2);
    for (std::size_t k = 0; k < 2; ++k) {
      const Selection selection = k == 0 ? Selection::kConstant : other;
      const int samples = samples_of[k];
      std::vector<double> errors;
      std::vector<double> biases;
      for (int seed = 1; seed <= settings_.seeds; ++seed) {
        const PointValues values = sampled_values(light(selection), subject.all_lamps, weights, samples,
                                                  static_cast<std::uint64_t>(seed), settings_.threads);
        const double measured = rms_relative_error(values, reference);
        const double variance = samples * (measured * measured - own * own);
        variances[k].push_back(variance);
        errors.push_back(std::sqrt(std::max(0.0, variance / samples)));
        biases.push_back(mean_difference(values, reference));
      }
      add(subject.name, name_of(selection), fmt::format("error of {} samples", samples), spread_of(errors));
      add(subject.name, name_of(selection), "variance of a sample", spread_of(variances[k]));
      add(subject.name, name_of(selection), "mean off by", spread_of(biases));
    }
    for (std::size_t s = 0; s < variances[0].size(); ++s)
      factors.push_back(std::sqrt(variances[0][s] / (variances[1][s] * time_over_constant)));
    add(subject.name, name_of(other), "error of constant over this at equal time", spread_of(factors));
  }

  const RunSettings& settings_;
  FlakeEffort effort_;
  Figures& figures_;
  const LitRoom& all_lamps_;
  const LitRoom& one_lamp_;
  std::size_t count_;
  std::vector<Subject> subjects_;  // all, floor, spheres
  Subject few_;
  std::vector<DirectLight> lights_;            // as Selection
  std::vector<double> spatial_over_constant_;  // times, as subjects_
  double linear_over_constant_ = 1;
};

}  // namespace

void measure_sphereflake(const RunSettings& settings, Figures& figures) {
  const std::filesystem::path library = std::filesystem::path(REEMIT_SOURCE_DIR) / "scenes/library";
  const LitRoom all_lamps(read_scene(library / "sphereflake.json"));
  const LitRoom one_lamp(read_scene(library / "sphereflake_one_lamp.json"));
  Sphereflake(settings, figures, all_lamps, one_lamp).run();
}

}  // namespace reemit::bench
