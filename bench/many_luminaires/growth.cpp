// Time per sample over the number of luminaires.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/convergence/jobs.h"
#include "bench/many_luminaires/lamp_boxes.h"
#include "bench/many_luminaires/lit_room.h"
#include "bench/many_luminaires/parts.h"
#include "bench/many_luminaires/sample_cost.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"

namespace reemit::bench {
namespace {

constexpr const char* kGrowth = "growth";
constexpr std::size_t kSheetSide = 100;
constexpr std::size_t kMostLinear = 10'000;
/// Samples of a round of linear selection, times luminaires: it takes time for each of them.
constexpr std::size_t kLinearWork = 2'000'000;

struct GrowthEffort {
  std::size_t points = 4000;
  int samples = 8;
  int rounds = 15;
  int builds = 5;
  std::size_t most = 100'000;
};

GrowthEffort growth_effort(const RunSettings& settings) {
  if (!settings.quick) return {};
  return {.points = 1000, .samples = 4, .rounds = 5, .builds = 1, .most = 10'000};
}

/// Where rays from the middle of the box in all directions meet its floor, walls and ceiling.
std::vector<SurfacePoint> wall_points(const LitRoom& room, std::size_t count) {
  const CounterRng rng(2, RngPurpose::kProbe);
  const Box box = bounds(room.scene());
  const Vec3f middle = room.rays().normalised(box.centre());
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; points.size() < count; ++i) {
    const std::array<float, 4> u = rng.uniform4(i, 0, 0);
    Hit hit;
    const Vec3f direction = sample_sphere(u[0], u[1]);
    if (!room.rays().closest(middle, direction, hit)) continue;
    if (room.rays().mesh().triangle(hit.triangle).surface.index() != 0) continue;
    points.push_back(surface_point(room.rays(), hit, direction));
  }
  return points;
}

struct Timed {
  std::size_t luminaires;
  double constant;
  double spatial;
};

Timed measure(const std::string& kind, std::size_t count, const Scene& scene, const GrowthEffort& effort,
              Figures& figures) {
  const LitRoom room(scene);
  const std::vector<SurfacePoint> points = wall_points(room, effort.points);
  std::vector<DirectLight> lights;
  std::vector<double> build_ms;
  for (const Selection s : kSelections) {
    if (s == Selection::kLinear && count > kMostLinear) continue;
    lights.push_back(room.light(s));
  }
  for (int i = 0; i < effort.builds; ++i)
    build_ms.push_back(1e3 * seconds_of([&] { static_cast<void>(room.light(Selection::kSpatial)); }));
  std::vector<Candidate> candidates{{&lights.front(), &points, effort.samples},
                                    {&lights.back(), &points, effort.samples}};
  const std::size_t few = std::clamp<std::size_t>(kLinearWork / count, 50, points.size());
  const std::vector<SurfacePoint> few_points = every(points, points.size() / few);
  const bool linear = lights.size() == kSelections.size();
  if (linear) candidates.push_back({&lights[1], &few_points, 1});
  const auto times = sample_times_ns(candidates, effort.rounds);
  const auto add = [&](Selection s, const std::string& quantity, const std::vector<double>& values) {
    figures.add({kGrowth, kind, count, std::string(name_of(s)), quantity, spread_of(values)});
  };
  add(Selection::kConstant, "time per sample [ns]", times[0]);
  if (linear) add(Selection::kLinear, "time per sample [ns]", times[2]);
  add(Selection::kSpatial, "time per sample [ns]", times[1]);
  add(Selection::kSpatial, "table built in [ms]", build_ms);
  return {count, spread_of(times[0]).median, spread_of(times[1]).median};
}

/// Slope of log time over log number by least squares.
template <class Time>
std::optional<double> exponent(const std::vector<Timed>& runs, std::size_t least, const Time& time) {
  std::vector<CurvePoint> points;
  for (const Timed& r : runs)
    if (r.luminaires >= least)
      points.push_back({1, static_cast<double>(r.luminaires), std::max(1e-9, time(r))});
  return convergence_rate(points);
}

void add_exponents(const std::string& kind, const std::vector<Timed>& runs, Figures& figures) {
  for (const std::size_t least : {std::size_t{10}, std::size_t{1000}}) {
    const auto add = [&](const char* selection, const std::optional<double>& value) {
      if (value)
        figures.add(
            {kGrowth, kind, least, selection, "exponent of growth from here on", spread_of({*value})});
    };
    add("constant", exponent(runs, least, [](const Timed& r) { return r.constant; }));
    add("spatial", exponent(runs, least, [](const Timed& r) { return r.spatial; }));
  }
}

}  // namespace

void measure_growth(const RunSettings& settings, Figures& figures) {
  const GrowthEffort effort = growth_effort(settings);
  figures.notes.push_back(fmt::format(
      "growth: {} points on floor, walls and ceiling of a closed box, {} rounds of {} samples at each",
      effort.points, effort.rounds, effort.samples));
  struct Kind {
    const char* name;
    Scene (*make)(std::size_t);
  };
  for (const Kind& kind : {Kind{"spheres", box_with_spheres}, Kind{"triangles", box_with_triangles}}) {
    std::vector<Timed> runs;
    for (std::size_t count = 1; count <= effort.most; count *= 10)
      runs.push_back(measure(kind.name, count, kind.make(count), effort, figures));
    add_exponents(kind.name, runs, figures);
  }
  measure("one mesh", 2 * kSheetSide * kSheetSide, box_with_sheet(kSheetSide), effort, figures);
}

}  // namespace reemit::bench
