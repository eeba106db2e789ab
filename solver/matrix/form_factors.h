#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/interrupted.h"
#include "solver/matrix/leaks.h"
#include "solver/matrix/symmetric_table.h"
#include "solver/solution/form_factor_report.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// Form factors between all zones of a mesh. What is stored is the exchange area A_i F_ij = A_j F_ji [m2],
/// once per pair: reciprocity holds by construction.
class FormFactors {
 public:
  /// More zones than this make a table that no desktop holds.
  static constexpr std::size_t kMostZones = 16384;

  std::size_t zones() const { return areas_.size(); }
  double zone_area(std::size_t i) const { return areas_[i]; }  ///< [m2]
  double exchange_area(std::size_t i, std::size_t j) const {   ///< [m2]
    return i == j ? (self_.empty() ? 0 : self_[i].exchange) : exchange_.at(i, j);
  }
  /// Share of the power that zone i sends out uniformly which arrives at zone j directly.
  double factor(std::size_t i, std::size_t j) const { return exchange_area(i, j) / areas_[i]; }
  /// Its standard error: 0 for exact pairs, and for those that all rays found clear or hidden; of joined
  /// zones, as if the errors of their cells were independent.
  double factor_error(std::size_t i, std::size_t j) const;
  /// By zone, the sum of its factors [1]: 1 where nothing leaks.
  Eigen::VectorXd row_sums() const;

  const SymmetricTable<double>& exchange() const { return exchange_; }  ///< Of different zones.
  /// Variance of A_i F_ij divided by A_i A_j: free of units, so that float holds it in rooms of any size.
  const SymmetricTable<float>& relative_variance() const { return variance_; }
  const ZoneLeaks& leaks() const { return leaks_; }  ///< Of zones that are cells.
  const FormFactorReport& report() const { return report_; }

 private:
  friend class FormFactorBuilder;
  friend FormFactors join_cells(const FormFactors& cells, const ZoneMesh& mesh);
  /// Of a zone with itself: of a group whose members see each other.
  struct Self {
    double exchange = 0;           // [m2]
    double relative_variance = 0;  // as of pairs
  };
  std::vector<double> areas_;
  SymmetricTable<double> exchange_;
  SymmetricTable<float> variance_;
  std::vector<Self> self_;  // empty: all 0
  ZoneLeaks leaks_;
  FormFactorReport report_;
};

struct FormFactorSettings {
  std::uint64_t seed = 1;
  bool enforce_closure = true;
};

/// Computes the form factors of all pairs: exact where nothing comes between, else the exact unoccluded
/// factor times a visible share found by shadow rays (docs/matrix_method.md). In closed rooms the sampled
/// pairs are then corrected such that rows sum to 1. The same bits on any number of threads; runs in the task
/// arena of the caller. `progress`, if any, gets the share done [0,1], from one thread at a time.
/// Throws InputError for more zones than kMostZones, for curved zones and for groups of sides, ResourceError
/// when the table does not fit into memory, Interrupted when `interrupt` becomes true.
FormFactors compute_form_factors(const ZoneMesh& mesh, const RayTracer& rays,
                                 const FormFactorSettings& settings,
                                 const std::function<void(double)>& progress,
                                 const std::atomic<bool>& interrupt);

/// Those between the zones of `mesh`, groups of sides among them, from those of its cells, which are the
/// zones of ZoneMesh(mesh.base(), {}, mesh.splits()): exchange areas add up. What the report says of pairs
/// stays that of cells. Throws std::invalid_argument for other cells.
FormFactors join_cells(const FormFactors& cells, const ZoneMesh& mesh);

}  // namespace reemit
