#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "bench/validation/code_room.h"
#include "bench/validation/validation_row.h"
#include "solver/matrix/form_factors.h"

namespace reemit::validation {

/// A mean irradiance of the zonal system with what is not known about it.
struct ZonalValue {
  double mean = 0;  ///< [W/m2]
  /// From sampled visibility; 0 in rooms without blockers. Larger than true, because factors do not credit
  /// the stratification of their rays nor the closure of rows.
  double standard_error = 0;
};

/// The zonal system of zones that are made of triangles: rectangles, or whole surfaces. Exchange areas of
/// pairs of triangles are summed, then H = F (M + rho H) is solved by elimination.
class MergedZones {
 public:
  enum class Merge { kTriangles, kPolygons, kSurfaces };
  /// Zones are the triangles, polygons or surfaces of the room, in its order.
  MergedZones(const CodeRoom& room, Merge merge, std::uint64_t seed);

  std::size_t size() const { return static_cast<std::size_t>(area_.size()); }
  std::size_t surface_of(std::size_t zone) const { return surface_[zone]; }

  /// Solves for reflectance and exitance by surface; values of zones and surfaces follow.
  void solve(const Eigen::VectorXd& surface_reflectance, const Eigen::VectorXd& surface_exitance);
  ZonalValue zone(std::size_t zone) const;
  ZonalValue surface(std::size_t surface) const;  ///< Area mean.
  ZonalValue room() const;                        ///< Area mean.
  std::size_t brightest_zone() const;

 private:
  ZonalValue weighted(const Eigen::VectorXd& weights) const;

  std::vector<std::size_t> owner_;    // zone of each triangle
  std::vector<std::size_t> surface_;  // of each zone
  Eigen::VectorXd area_;
  Eigen::MatrixXd exchange_;
  struct Sampled {
    std::size_t a, b;  // zones
    double variance;   // of the exchange area
  };
  std::vector<Sampled> sampled_;
  Eigen::MatrixXd system_;  // diag(A) - G diag(rho)
  Eigen::VectorXd irradiance_, radiosity_;
};

/// A row of a value of the zonal system. Its standard error is too large to follow Student's t, so it has no
/// degrees of freedom. `relative_bound`: of factors and elimination.
ValidationRow make_row(const ReferenceCase& c, const ReferenceValue& v, const ZonalValue& value,
                       double relative_bound);

}  // namespace reemit::validation
