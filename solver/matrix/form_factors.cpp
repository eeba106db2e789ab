#include "solver/matrix/form_factors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include "mesh/geometry/disjoint_sets.h"
#include "mesh/zones/zone_cells.h"
#include "scenes/model/error.h"
#include "solver/matrix/blocker_sieve.h"
#include "solver/matrix/closure.h"
#include "solver/matrix/pair_visibility.h"
#include "solver/matrix/polygon_form_factor.h"
#include "solver/matrix/zone_points.h"

namespace reemit {
namespace {

constexpr const char* kAdvice = "Use larger zones (solve --zone-area), or the methods shooting or walk.";

void refuse_too_many(std::size_t zones) {
  if (zones > FormFactors::kMostZones)
    throw InputError(
        "form factors",
        fmt::format("{} zones are too many for a matrix; the most is {}", zones, FormFactors::kMostZones),
        kAdvice);
  const double needed =
      0.5 * static_cast<double>(zones) * static_cast<double>(zones) * (sizeof(double) + sizeof(float));
  const double memory =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
  if (memory > 0 && needed > 0.8 * memory)
    throw ResourceError("form factors",
                        fmt::format("the matrix of {} zones takes {:.1f} GB, and this machine has {:.1f} GB",
                                    zones, needed * 1e-9, memory * 1e-9),
                        kAdvice);
}

/// Counts of the pairs of one row.
struct RowCounts {
  std::uint64_t facing = 0, open = 0, walled = 0, clear = 0, hidden = 0, sampled = 0, rays = 0;
};

/// Of the zones that see others: backs of outer walls see none. 0 if none does.
double lowest_of_seeing(const Eigen::VectorXd& sums) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const double sum : sums)
    if (sum > 0) lowest = std::min(lowest, sum);
  return std::isfinite(lowest) ? lowest : 0;
}

}  // namespace

double FormFactors::factor_error(std::size_t i, std::size_t j) const {
  if (i == j) return self_.empty() ? 0 : std::sqrt(self_[i].relative_variance);
  return std::sqrt(static_cast<double>(variance_.at(i, j)) * areas_[j] / areas_[i]);
}

Eigen::VectorXd FormFactors::row_sums() const {
  const auto n = static_cast<Eigen::Index>(zones());
  const Eigen::Map<const Eigen::VectorXd> areas(areas_.data(), n);
  Eigen::VectorXd sums = exchange_.times(Eigen::VectorXd::Ones(n));
  for (std::size_t i = 0; i < self_.size(); ++i) sums(static_cast<Eigen::Index>(i)) += self_[i].exchange;
  return sums.cwiseQuotient(areas);
}

class FormFactorBuilder {
 public:
  FormFactorBuilder(const ZoneMesh& mesh, const RayTracer& rays, const FormFactorSettings& settings)
      : settings_(settings),
        sieve_(mesh, kSieveTolerance * rays.metres_per_unit()),
        visibility_(rays, settings.seed) {
    const std::size_t zones = mesh.zone_count();
    polygons_.reserve(zones);
    for (std::size_t z = 0; z < zones; ++z) {
      polygons_.push_back(zone_polygon(mesh, ZoneId(z)));
      result_.areas_.push_back(mesh.zone_area(ZoneId(z)));
    }
    result_.exchange_ = SymmetricTable<double>(zones);
    result_.variance_ = SymmetricTable<float>(zones);
    result_.leaks_ = trace_leaks(rays, settings.seed);
  }

  FormFactors build(const std::function<void(double)>& progress, const std::atomic<bool>& interrupt) {
    fill(progress, interrupt);
    const std::vector<bool> closed = closed_zones();
    FormFactorReport& report = result_.report_;
    report.zones = polygons_.size();
    report.closed_zones = static_cast<std::size_t>(std::count(closed.begin(), closed.end(), true));
    report.rays += report.zones * ZoneLeaks::kRaysPerZone;
    report.before = summary(closed);
    if (settings_.enforce_closure)
      enforce_closure(result_.areas_, closed, result_.variance_, result_.exchange_);
    report.after = summary(closed);
    return std::move(result_);
  }

 private:
  /// Points nearer to a plane than this [normalised units] cannot be told from points on it by rays, which
  /// start as far away.
  static constexpr double kSieveTolerance = RayTracer::kLift;

  void fill(const std::function<void(double)>& progress, const std::atomic<bool>& interrupt) {
    const std::size_t zones = polygons_.size();
    std::vector<RowCounts> counts(zones);
    std::mutex mutex;
    std::uint64_t done = 0;
    tbb::parallel_for(std::size_t{0}, zones, [&](std::size_t i) {
      if (interrupt) return;
      fill_row(i, counts[i]);
      if (!progress) return;
      const std::lock_guard lock(mutex);
      done += zones - i;
      progress(2 * static_cast<double>(done) / (static_cast<double>(zones) * static_cast<double>(zones + 1)));
    });
    if (interrupt) throw Interrupted("interrupted before the form factors were complete");
    FormFactorReport& report = result_.report_;
    for (const RowCounts& c : counts) {
      report.facing_pairs += c.facing;
      report.open_pairs += c.open;
      report.walled_pairs += c.walled;
      report.clear_pairs += c.clear;
      report.hidden_pairs += c.hidden;
      report.sampled_pairs += c.sampled;
      report.rays += c.rays;
    }
  }

  void fill_row(std::size_t i, RowCounts& counts) {
    double* exchange = result_.exchange_.row(i);
    float* variance = result_.variance_.row(i);
    for (std::size_t j = i + 1; j < polygons_.size(); ++j, ++exchange, ++variance) {
      const FacingPair pair = facing_parts(polygons_[i], polygons_[j]);
      const double unoccluded = unoccluded_exchange_area(pair);
      if (!(unoccluded > 0)) continue;
      ++counts.facing;
      *exchange = unoccluded;
      const PairSight sight = sieve_.look(i, j, pair);
      if (sight == PairSight::kOpen) {
        ++counts.open;
        continue;
      }
      if (sight == PairSight::kHidden) {
        ++counts.walled;
        *exchange = 0;
        continue;
      }
      const double factor = unoccluded / std::min(result_.areas_[i], result_.areas_[j]);
      const VisibleShare visible = visibility_.look(ZoneId(i), ZoneId(j), pair, factor);
      counts.rays += visible.rays;
      ++(visible.sampled ? counts.sampled : visible.share > 0 ? counts.clear : counts.hidden);
      *exchange = unoccluded * visible.share;
      *variance = static_cast<float>(visible.variance * (unoccluded / result_.areas_[i]) *
                                     (unoccluded / result_.areas_[j]));
    }
  }

  /// Zones that see, directly or by way of others, no zone with a leak.
  std::vector<bool> closed_zones() const {
    const std::size_t zones = polygons_.size();
    DisjointSets rooms(zones);
    for (std::size_t i = 0; i < zones; ++i) {
      const double* row = result_.exchange_.row(i);
      for (std::size_t k = 0; k < result_.exchange_.row_length(i); ++k)
        if (row[k] > 0) rooms.join(i, i + 1 + k);
    }
    std::vector<bool> leaks(zones);
    std::vector<bool> alone(zones, true);
    for (std::size_t i = 0; i < zones; ++i) {
      const std::size_t room = rooms.find(i);
      if (!result_.leaks_.closed(i)) leaks[room] = true;
      if (room != i) alone[room] = false;
    }
    std::vector<bool> closed(zones);
    for (std::size_t i = 0; i < zones; ++i) closed[i] = !leaks[rooms.find(i)] && !alone[rooms.find(i)];
    return closed;
  }

  RowSums summary(const std::vector<bool>& closed) const {
    const Eigen::VectorXd sums = result_.row_sums();
    RowSums s;
    if (sums.size() == 0) return s;
    s.lowest = lowest_of_seeing(sums);
    s.highest = sums.maxCoeff();
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < closed.size(); ++i) {
      if (!closed[i]) continue;
      const double deviation = sums(static_cast<Eigen::Index>(i)) - 1;
      squares += deviation * deviation;
      ++count;
    }
    if (count > 0) s.rms_deviation = std::sqrt(squares / static_cast<double>(count));
    return s;
  }

  FormFactorSettings settings_;
  BlockerSieve sieve_;
  PairVisibility visibility_;
  std::vector<ConvexPolygon> polygons_;
  FormFactors result_;
};

FormFactors compute_form_factors(const ZoneMesh& mesh, const RayTracer& rays,
                                 const FormFactorSettings& settings,
                                 const std::function<void(double)>& progress,
                                 const std::atomic<bool>& interrupt) {
  refuse_too_many(mesh.zone_count());
  if (mesh.flat_count() != mesh.triangle_count())
    throw InputError("form factors", "the room has round zones, and form factors are those of flat ones",
                     "Solve it with --method matrix, which puts flat faces in place of round shapes.");
  if (mesh.groups().count > 0)
    throw InputError("form factors",
                     "the room has zones of several triangles, and form factors are those of one",
                     "Mesh it with MeshSettings::share_zones = false, as --method matrix does, or join those "
                     "of its cells (join_cells).");
  return FormFactorBuilder(mesh, rays, settings).build(progress, interrupt);
}

FormFactors join_cells(const FormFactors& cells, const ZoneMesh& mesh) {
  const ZoneCells all(mesh);
  if (all.size() != cells.zones()) throw std::invalid_argument("form factors of other cells");
  std::vector<std::size_t> zone(all.size());
  for (std::size_t c = 0; c < all.size(); ++c) zone[c] = all.zone(c).index();
  const std::size_t zones = mesh.zone_count();
  FormFactors joined;
  for (std::size_t z = 0; z < zones; ++z) joined.areas_.push_back(mesh.zone_area(ZoneId(z)));
  joined.exchange_ = SymmetricTable<double>(zones);
  SymmetricTable<double> variance(zones);  // of exchange areas [m4]
  joined.self_.resize(zones);
  for (std::size_t c = 0; c < all.size(); ++c) {
    const std::size_t i = zone[c];
    const double* exchange = cells.exchange_.row(c);
    const float* relative = cells.variance_.row(c);
    for (std::size_t d = c + 1; d < all.size(); ++d, ++exchange, ++relative) {
      const std::size_t j = zone[d];
      const double of_pair = static_cast<double>(*relative) * cells.areas_[c] * cells.areas_[d];
      if (i == j) {  // from each to the other
        joined.self_[i].exchange += 2 * *exchange;
        joined.self_[i].relative_variance += 4 * of_pair / (joined.areas_[i] * joined.areas_[i]);
      } else {
        joined.exchange_.add(i, j, *exchange);
        variance.add(i, j, of_pair);
      }
    }
  }
  joined.variance_ = SymmetricTable<float>(zones);
  for (std::size_t i = 0; i < zones; ++i)
    for (std::size_t k = 0; k < variance.row_length(i); ++k)
      joined.variance_.row(i)[k] =
          static_cast<float>(variance.row(i)[k] / (joined.areas_[i] * joined.areas_[i + 1 + k]));
  joined.report_ = cells.report_;
  joined.report_.zones = zones;
  const Eigen::VectorXd sums = joined.row_sums();
  joined.report_.after.lowest = lowest_of_seeing(sums);
  joined.report_.after.highest = sums.size() > 0 ? sums.maxCoeff() : 0;
  return joined;
}

}  // namespace reemit
