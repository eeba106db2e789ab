// Stills of a yard with a hundred panels: direct light alone, one shadow ray per camera ray.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/convergence/jobs.h"
#include "bench/many_luminaires/direct_picture.h"
#include "bench/many_luminaires/lit_room.h"
#include "bench/many_luminaires/parts.h"
#include "bench/many_luminaires/side_by_side.h"
#include "scenes/io/scene_reader.h"
#include "viewer_export/output/tone_map.h"

namespace reemit::bench {
namespace {

constexpr const char* kPanels = "panels";
constexpr const char* kPanelsCamera = "middle court";
/// The share of the picture's mean luminance that errors are compared with where it is black.
constexpr double kFloor = 0.01;

struct PanelsEffort {
  int width = 480;
  int height = 320;
  std::vector<int> samples{4, 16, static_cast<int>(kShownSamples), 196};
  int reference_samples = 4096;
};

PanelsEffort panels_effort(const RunSettings& settings) {
  if (!settings.quick) return {};
  return {.width = 240, .height = 160, .samples = {4, 16, kShownSamples, 196}, .reference_samples = 512};
}

/// How far the reflected light of two pictures is apart, in luminance.
struct Deviation {
  double rms = 0;     ///< sqrt(mean of (difference/(L + f))^2)
  double median = 0;  ///< Of |difference|/(L + f).
  double mean = 0;    ///< Sum of the differences over the sum of L.
};

Deviation deviation(const DirectPicture& picture, const DirectPicture& reference) {
  const auto luminances = [](const DirectPicture& p) {
    std::vector<double> values;
    for (std::size_t i = 0; i < p.reflected.size(); i += 3)
      values.push_back(luminance({p.reflected[i], p.reflected[i + 1], p.reflected[i + 2]}));
    return values;
  };
  const std::vector<double> a = luminances(picture);
  const std::vector<double> r = luminances(reference);
  double total = 0;
  for (const double v : r) total += v;
  const double floor = kFloor * total / static_cast<double>(r.size());
  Deviation d;
  std::vector<double> relative;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double off = a[i] - r[i];
    relative.push_back(std::abs(off) / (r[i] + floor));
    d.rms += relative.back() * relative.back();
    d.mean += off / total;
  }
  d.rms = std::sqrt(d.rms / static_cast<double>(a.size()));
  d.median = spread_of(relative).median;
  return d;
}

/// Times and errors of one number of samples, one value per seed.
struct LevelRuns {
  std::vector<double> seconds, rms, median, mean;
};
using LevelOfAll = std::array<LevelRuns, kSelections.size()>;

class Panels {
 public:
  Panels(const RunSettings& settings, Figures& figures, const LitRoom& room)
      : settings_(settings),
        effort_(panels_effort(settings)),
        figures_(figures),
        room_(room),
        camera_(camera_named(room.scene(), kPanelsCamera)) {
    for (const Selection s : kSelections) lights_.push_back(room.light(s));
  }

  void run() {
    // Two independent halves: each is the measure of the other's error, and their mean is the reference.
    const int half = effort_.reference_samples / 2;
    reference_ = render(Selection::kSpatial, half, kReferenceSeed);
    const DirectPicture other = render(Selection::kSpatial, half, kReferenceSeed + 1);
    const Deviation between = deviation(other, reference_);
    for (std::size_t i = 0; i < other.reflected.size(); ++i) {
      reference_.reflected[i] = 0.5F * (reference_.reflected[i] + other.reflected[i]);
      reference_.emitted[i] = 0.5F * (reference_.emitted[i] + other.emitted[i]);
    }
    reference_error_ = {between.rms / 2, between.median / 2, 0};
    figures_.notes.push_back(fmt::format(
        "panels: camera '{}', {}x{} px, {} thread{}; reference: {} samples per pixel, spatial selection, "
        "{:.2g} % "
        "median, {:.2g} % rms",
        kPanelsCamera, effort_.width, effort_.height, settings_.threads, settings_.threads == 1 ? "" : "s",
        effort_.reference_samples, 100 * reference_error_.median, 100 * reference_error_.rms));
    for (const int samples : effort_.samples) measure(samples);
    compare();
    write_side_by_side({shown_[0], shown_[1], shown_[2], reference_}, settings_.folder / "images" / kPicture);
  }

 private:
  DirectPicture render(Selection s, int samples, std::uint64_t seed) const {
    return render_direct(room_, lights_[static_cast<std::size_t>(s)], camera_, effort_.width, effort_.height,
                         samples, seed, settings_.threads);
  }

  void measure(int samples) {
    LevelOfAll runs;
    for (int seed = 1; seed <= settings_.seeds; ++seed)
      for (std::size_t k = 0; k < kSelections.size(); ++k) {
        DirectPicture picture = render(kSelections[k], samples, static_cast<std::uint64_t>(seed));
        const Deviation d = deviation(picture, reference_);
        runs[k].seconds.push_back(picture.seconds);
        runs[k].rms.push_back(without(d.rms, reference_error_.rms));
        runs[k].median.push_back(without(d.median, reference_error_.median));
        runs[k].mean.push_back(d.mean);
        if (samples == static_cast<int>(kShownSamples) && seed == 1) shown_[k] = std::move(picture);
      }
    for (std::size_t k = 0; k < kSelections.size(); ++k) {
      add(samples, kSelections[k], "wall time [s]", spread_of(runs[k].seconds));
      add(samples, kSelections[k], "rms error", spread_of(runs[k].rms));
      add(samples, kSelections[k], "median error", spread_of(runs[k].median));
      add(samples, kSelections[k], "mean off by", spread_of(runs[k].mean));
    }
    levels_.push_back(std::move(runs));
  }

  /// What spatial selection does better in the time that another one takes, where that lies between levels.
  void compare() {
    constexpr auto kSpatial = static_cast<std::size_t>(Selection::kSpatial);
    for (std::size_t level = 0; level < levels_.size(); ++level)
      for (const Selection s : {Selection::kConstant, Selection::kLinear}) {
        const LevelRuns& other = levels_[level][static_cast<std::size_t>(s)];
        std::vector<double> rms, median;
        for (std::size_t seed = 0; seed < other.seconds.size(); ++seed) {
          std::vector<double> seconds, spatial_rms, spatial_median;
          for (const LevelOfAll& runs : levels_) {
            seconds.push_back(runs[kSpatial].seconds[seed]);
            spatial_rms.push_back(runs[kSpatial].rms[seed]);
            spatial_median.push_back(runs[kSpatial].median[seed]);
          }
          const double time = other.seconds[seed];
          if (time < seconds.front() || time > seconds.back()) continue;
          rms.push_back(other.rms[seed] / error_at(time, seconds, spatial_rms));
          median.push_back(other.median[seed] / error_at(time, seconds, spatial_median));
        }
        if (rms.empty()) continue;
        add(effort_.samples[level], s, "rms error over that of spatial at equal time", spread_of(rms));
        add(effort_.samples[level], s, "median error over that of spatial at equal time", spread_of(median));
      }
  }

  /// Error at a time, straight in log-log between levels. Pre: the time lies between the first and the last.
  static double error_at(double time, const std::vector<double>& seconds, const std::vector<double>& error) {
    std::size_t next = 1;
    while (next + 1 < seconds.size() && seconds[next] < time) ++next;
    const double share = std::log(time / seconds[next - 1]) / std::log(seconds[next] / seconds[next - 1]);
    return error[next - 1] * std::pow(error[next] / error[next - 1], share);
  }

  static double without(double measured, double of_reference) {
    return std::sqrt(std::max(0.0, measured * measured - of_reference * of_reference));
  }

  void add(int samples, Selection s, const std::string& quantity, const Spread& value) {
    figures_.add(
        {kPanels, "still", static_cast<std::size_t>(samples), std::string(name_of(s)), quantity, value});
  }

  const RunSettings& settings_;
  PanelsEffort effort_;
  Figures& figures_;
  const LitRoom& room_;
  const Camera& camera_;
  std::vector<DirectLight> lights_;  // as Selection
  DirectPicture reference_;
  Deviation reference_error_;
  std::array<DirectPicture, kSelections.size()> shown_;
  std::vector<LevelOfAll> levels_;  // as PanelsEffort::samples
};

}  // namespace

void measure_panels(const RunSettings& settings, Figures& figures) {
  const LitRoom room(
      read_scene(std::filesystem::path(REEMIT_SOURCE_DIR) / "scenes/library/hundred_panels.json"));
  Panels(settings, figures, room).run();
}

}  // namespace reemit::bench
