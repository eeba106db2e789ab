#include "bench/convergence/summary.h"

#include <algorithm>
#include <map>
#include <optional>

namespace reemit::bench {
namespace {

struct SeedPoint {
  std::uint64_t seed;
  double seconds;
  double work;
  std::optional<double> error;  // nothing if the reference is not good enough
};

void add_levels(const std::map<int, std::vector<SeedPoint>>& by_level, Curve& curve) {
  std::map<std::uint64_t, std::vector<CurvePoint>> by_seed;
  for (const auto& [level, points] : by_level) {
    if (std::any_of(points.begin(), points.end(), [](const SeedPoint& p) { return !p.error; })) continue;
    std::vector<double> seconds;
    std::vector<double> work;
    std::vector<double> errors;
    for (const SeedPoint& p : points) {
      seconds.push_back(p.seconds);
      work.push_back(p.work);
      errors.push_back(*p.error);
      by_seed[p.seed].push_back({p.seconds, p.work, *p.error});
    }
    curve.levels.push_back({spread_of(seconds), spread_of(work).median, spread_of(errors)});
  }
  for (auto& [seed, points] : by_seed) curve.by_seed.push_back(std::move(points));
}

}  // namespace

std::vector<CurvePoint> Curve::medians() const {
  std::vector<CurvePoint> points;
  for (const Level& level : levels) points.push_back({level.seconds.median, level.work, level.error.median});
  return points;
}

std::vector<Curve> make_curves(const Table& table, const std::string& quantity, Metric metric) {
  std::vector<Curve> curves;
  std::vector<std::map<int, std::vector<SeedPoint>>> points;
  for (const Measurement& m : table.rows) {
    if (m.quantity != quantity) continue;
    const auto found = std::find_if(curves.begin(), curves.end(),
                                    [&](const Curve& c) { return c.room == m.room && c.method == m.method; });
    const auto k = static_cast<std::size_t>(found - curves.begin());
    if (found == curves.end()) {
      curves.push_back({m.room, quantity, m.method, metric, m.work_unit, {}, {}});
      points.emplace_back();
    }
    const auto error_of = [&](const ErrorPair& e) { return metric == Metric::kRms ? e.rms : e.median; };
    points[k][m.level].push_back(
        {m.seed, m.seconds, m.work, without_reference(error_of(m.error), error_of(m.reference))});
  }
  for (std::size_t k = 0; k < curves.size(); ++k) add_levels(points[k], curves[k]);
  // Rooms together, in the order in which they first came.
  std::vector<Curve> sorted;
  for (const Curve& first : curves)
    for (const Curve& c : curves)
      if (c.room == first.room && !find_curve(sorted, c.room, c.method) && !c.levels.empty())
        sorted.push_back(c);
  return sorted;
}

const Curve* find_curve(const std::vector<Curve>& curves, const std::string& room,
                        const std::string& method) {
  const auto found = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) {
    return c.room == room && c.method == method && !c.levels.empty();
  });
  return found == curves.end() ? nullptr : &*found;
}

Factor factor_between(const Curve& slow, const Curve& fast, double error) {
  Factor factor{time_to_error(slow.medians(), error), time_to_error(fast.medians(), error), {}, false};
  factor.is_bound = factor.fast.reach == Reach::kAtMost;
  std::vector<double> ratios;
  for (std::size_t s = 0; s < std::min(slow.by_seed.size(), fast.by_seed.size()); ++s) {
    const TimeToError a = time_to_error(slow.by_seed[s], error);
    const TimeToError b = time_to_error(fast.by_seed[s], error);
    if (a.reach != Reach::kNever && b.reach != Reach::kNever) ratios.push_back(a.seconds / b.seconds);
  }
  if (factor.slow.reach != Reach::kNever && factor.fast.reach != Reach::kNever && !ratios.empty()) {
    factor.ratio = spread_of(ratios);
    factor.ratio.median = factor.slow.seconds / factor.fast.seconds;
  }
  return factor;
}

}  // namespace reemit::bench
