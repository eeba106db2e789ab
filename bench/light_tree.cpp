// The light tree against the other ways to choose one luminaire among many: time per choice, time to build,
// and how much one choice scatters the estimate of unoccluded irradiance.
#include "solver/emit/light_tree.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "bench/program_options.h"
#include "scenes/model/stopwatch.h"
#include "solver/emit/area_luminaire.h"
#include "solver/emit/selection.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"

namespace {

using namespace reemit;

class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : rng_(seed, RngPurpose::kProbe) {}
  double unit() {
    const auto bits = rng_.bits4(index_++, 0, 0);
    return static_cast<double>((std::uint64_t{bits[0]} << 21) | (bits[1] >> 11)) * 0x1p-53;
  }
  float between(float from, float to) { return from + (to - from) * static_cast<float>(unit()); }

 private:
  CounterRng rng_;
  std::uint64_t index_ = 0;
};

/// A square panel or, without corners, a sphere small enough that its irradiance is that of its middle.
struct Lamp {
  std::optional<AreaLuminaire> panel;
  Vec3f middle{0, 0, 0};
  float radius = 0;  // Of a sphere.
  float radiance = 1;
  LuminaireBounds bounds;

  double irradiance(const Vec3f& x, const Vec3f& n) const {
    if (panel)
      return static_cast<double>(radiance) * panel->expected_irradiance(x.cast<double>(), n.cast<double>());
    const Vec3f to = middle - x;
    const float distance2 = to.squaredNorm();
    return static_cast<double>(bounds.intensity * std::max(0.0F, n.dot(to)) /
                               (distance2 * std::sqrt(distance2)));
  }
};

/// Lamps in the upper nine tenths of the box [-1,1] x [0,1] x [-1,1], spaced out so that their sizes shrink
/// with their number; radiances over a range of 100.
std::vector<Lamp> random_lamps(std::size_t count, bool panels, bool clustered, std::uint64_t seed) {
  Numbers random(seed);
  std::vector<Lamp> lamps(count);
  const float spacing = 0.3F / std::cbrt(static_cast<float>(count));
  Vec3f centre(0, 0.5F, 0);
  for (std::size_t i = 0; i < count; ++i) {
    Lamp& lamp = lamps[i];
    const auto anywhere = [&] {
      const float x = random.between(-1, 1), y = random.between(0.1F, 1), z = random.between(-1, 1);
      return Vec3f(x, y, z);
    };
    if (i % 100 == 0) centre = anywhere();
    lamp.middle = clustered ? Vec3f(0.9F * centre + 0.1F * anywhere()) : anywhere();
    lamp.radiance = std::pow(10.0F, random.between(-1, 1));
    if (!panels) {
      lamp.radius = 0.1F * spacing;
      lamp.bounds = sphere_bounds(lamp.middle, lamp.radius,
                                  std::numbers::pi_v<float> * lamp.radius * lamp.radius * lamp.radiance);
      continue;
    }
    const Vec3f normal = sample_sphere(static_cast<float>(random.unit()), static_cast<float>(random.unit()));
    const Frame frame(normal);
    const float size = spacing * random.between(0.2F, 1);
    const Vec3f u = size * frame.tangent, v = size * frame.bitangent;
    const std::array corners{Vec3f(lamp.middle - 0.5F * (u + v)), Vec3f(lamp.middle + 0.5F * (u - v)),
                             Vec3f(lamp.middle + 0.5F * (u + v)), Vec3f(lamp.middle - 0.5F * (u - v))};
    const float area = size * size;
    std::vector<Vec3> exact;
    for (const Vec3f& c : corners) exact.push_back(c.cast<double>());
    lamp.panel.emplace(exact, normal.cast<double>(), 0.0);
    lamp.bounds = flat_bounds(corners, normal, lamp.radiance * area);
  }
  return lamps;
}

std::vector<LuminaireBounds> bounds_of(const std::vector<Lamp>& lamps) {
  std::vector<LuminaireBounds> bounds;
  for (const Lamp& lamp : lamps) bounds.push_back(lamp.bounds);
  return bounds;
}

/// The shortest of some runs: other work on the machine only ever adds time.
template <class Work>
double shortest_seconds(const Work& work) {
  constexpr int kRuns = 7;
  double shortest = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    work();
    shortest = std::min(shortest, seconds_since(start));
  }
  return shortest;
}

/// On the floor of the box.
Vec3f random_receiver(Numbers& random) {
  const float x = random.between(-1, 1), z = random.between(-1, 1);
  return {x, 0, z};
}

void print_times(std::size_t most, int receivers) {
  constexpr std::size_t kCandidates = 16;
  fmt::print(
      "| luminaires | build [ms] | pick [ns] | probability [ns] | one of {} at once [ns] | dead ends |\n"
      "|---|---|---|---|---|---|\n",
      kCandidates);
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (std::size_t count = 1; count <= most; count *= 4) {
    const auto bounds = bounds_of(random_lamps(count, true, false, count));
    const auto start = std::chrono::steady_clock::now();
    const LightTree tree(bounds);
    const double build = seconds_since(start);

    const Vec3f up = Vec3f::UnitY();
    Numbers random(1);
    std::vector<Vec3f> at;
    std::vector<double> u;
    for (int i = 0; i < receivers; ++i) {
      at.push_back(random_receiver(random));
      u.push_back(random.unit());
    }
    std::vector<Pick> picks(at.size());
    std::size_t missed = 0;
    const double pick = shortest_seconds([&] {
      missed = 0;
      for (std::size_t i = 0; i < at.size(); ++i) {
        double rest = u[i];
        missed += !tree.pick(at[i], up, rest, picks[i]);
      }
    });
    float kept = 0;
    const double probability = shortest_seconds([&] {
      for (std::size_t i = 0; i < at.size(); ++i) kept += tree.probability(picks[i].luminaire, at[i], up);
    });
    std::array<Pick, kCandidates> many;
    std::array<double, kCandidates> rest;
    const double together = shortest_seconds([&] {
      for (std::size_t i = 0; i < at.size(); i += kCandidates) tree.pick_many(at[i], up, u[i], many, rest);
    });

    const double each = 1e9 / static_cast<double>(receivers);
    fmt::print("| {} | {:.3g} | {:.0f} | {:.0f} | {:.0f} | {:.2f} % |\n", count, 1e3 * build, each * pick,
               kept >= 0 ? each * probability : 0.0, each * together,
               100 * static_cast<double>(missed) / static_cast<double>(receivers));
    std::fflush(stdout);
    if (count >= 16) {
      const double x = std::log2(static_cast<double>(count));
      n += 1;
      sum_x += x;
      sum_y += each * pick;
      sum_xx += x * x;
      sum_xy += x * each * pick;
    }
  }
  if (n >= 2) {
    const double slope = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
    fmt::print("\nFitted from 16 luminaires on: {:.0f} ns {:+.1f} ns per doubling.\n",
               (sum_y - slope * sum_x) / n, slope);
  }
}

/// Relative standard deviation of E_i / alpha_i over the choice of i, from sums over all luminaires; and of
/// the mean of 8 that are picked together, by repetition.
struct Scatter {
  double constant = 0, linear = 0, spatial = 0, together = 0;
};

Scatter scatter_at(const std::vector<Lamp>& lamps, const LightTree& tree, const Vec3f& x, Numbers& random) {
  constexpr std::size_t kTogether = 8;
  constexpr int kRepeats = 64;
  const Vec3f up = Vec3f::UnitY();
  const auto count = static_cast<double>(lamps.size());
  std::vector<double> irradiance(lamps.size());
  double total = 0;
  for (std::size_t i = 0; i < lamps.size(); ++i) total += irradiance[i] = lamps[i].irradiance(x, up);
  Scatter moment;
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    const double e = irradiance[i] / total;
    if (!(e > 0)) continue;
    moment.constant += e * e * count;
    moment.linear += e;
    moment.spatial += e * e / static_cast<double>(tree.probability(static_cast<std::uint32_t>(i), x, up));
  }
  std::array<Pick, kTogether> picks;
  std::array<double, kTogether> rest;
  for (int r = 0; r < kRepeats; ++r) {
    const std::size_t found = tree.pick_many(x, up, random.unit(), picks, rest);
    double estimate = 0;
    for (std::size_t k = 0; k < found; ++k)
      estimate += irradiance[picks[k].luminaire] / (total * static_cast<double>(picks[k].probability));
    const double deviation = estimate / kTogether - 1;
    moment.together += deviation * deviation / kRepeats;
  }
  return {moment.constant - 1, moment.linear - 1, moment.spatial - 1, moment.together};
}

void print_scatter(std::size_t most, int receivers) {
  fmt::print(
      "\n| scene | luminaires | {} | {} | {} | spatial, mean of 8 at once |\n|---|---|---|---|---|---|\n",
      name_of(Selection::kConstant), name_of(Selection::kLinear), name_of(Selection::kSpatial));
  for (const bool panels : {false, true}) {
    for (const bool clustered : {false, true}) {
      for (std::size_t count = 10; count <= std::min<std::size_t>(most, 10000); count *= 10) {
        const std::vector<Lamp> lamps = random_lamps(count, panels, clustered, 7);
        const LightTree tree(bounds_of(lamps));
        Numbers random(2);
        Scatter mean;
        for (int i = 0; i < receivers; ++i) {
          const Scatter s = scatter_at(lamps, tree, random_receiver(random), random);
          mean.constant += s.constant / receivers;
          mean.linear += s.linear / receivers;
          mean.spatial += s.spatial / receivers;
          mean.together += s.together / receivers;
        }
        const auto deviation = [](double variance) { return std::sqrt(std::max(0.0, variance)); };
        fmt::print("| {}{} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", panels ? "panels" : "spheres",
                   clustered ? ", clustered" : "", count, deviation(mean.constant), deviation(mean.linear),
                   deviation(mean.spatial), deviation(mean.together));
        std::fflush(stdout);
      }
    }
  }
  fmt::print(
      "\nRelative standard deviations of one choice (rms over receivers on the floor); the irradiance of the "
      "chosen"
      "\nluminaire is exact and nothing is in the way, so linear choice has none left.\n");
}

}  // namespace

int main(int argc, char** argv) {
  bench::ProgramOptions app("Time and scatter of choosing one luminaire among many");
  std::size_t most = 1048576;
  int picks = 100000;
  int receivers = 50;
  app.add_option("--most", most, "Largest number of luminaires").show_default().in_range(1, 1 << 26);
  app.add_option("--picks", picks, "Picks timed").show_default().in_range(1000, 100000000);
  app.add_option("--receivers", receivers, "Receivers of the table of deviations")
      .show_default()
      .in_range(1, 1000000);
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    print_times(most, picks);
    print_scatter(most, receivers);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}
