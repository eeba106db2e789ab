#include "bench/validation/merged_zones.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <Eigen/LU>

namespace reemit::validation {

MergedZones::MergedZones(const CodeRoom& room, Merge merge, std::uint64_t seed) {
  const MeshResult built = room.exact_zones();
  const ZoneMesh& mesh = built.mesh;
  const RayTracer rays(mesh);
  const std::atomic<bool> interrupt{false};
  FormFactorSettings settings;
  settings.seed = seed;
  const FormFactors factors = compute_form_factors(mesh, rays, settings, {}, interrupt);
  // One zone per triangle, in order: all faces are one-sided and undivided.
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const BaseTriangle& triangle = mesh.triangle(TriangleId(t));
    const bool same = t > 0 && triangle.surface == mesh.triangle(TriangleId(t - 1)).surface &&
                      (merge == Merge::kSurfaces ||
                       (merge == Merge::kPolygons && triangle.face == mesh.triangle(TriangleId(t - 1)).face));
    if (!same) surface_.push_back(triangle.surface.index());
    owner_.push_back(surface_.size() - 1);
  }
  const auto n = static_cast<Eigen::Index>(surface_.size());
  area_.setZero(n);
  exchange_.setZero(n, n);
  for (std::size_t i = 0; i < owner_.size(); ++i) {
    const auto a = static_cast<Eigen::Index>(owner_[i]);
    area_[a] += factors.zone_area(i);
    for (std::size_t j = 0; j < owner_.size(); ++j)
      exchange_(a, static_cast<Eigen::Index>(owner_[j])) += factors.exchange_area(i, j);
    for (std::size_t j = i + 1; j < owner_.size(); ++j) {
      const double error = factors.factor_error(i, j) * factors.zone_area(i);
      if (error > 0) sampled_.push_back({owner_[i], owner_[j], error * error});
    }
  }
}

void MergedZones::solve(const Eigen::VectorXd& surface_reflectance, const Eigen::VectorXd& surface_exitance) {
  const Eigen::Index n = area_.size();
  Eigen::VectorXd rho(n);
  Eigen::VectorXd exitance(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto s = static_cast<Eigen::Index>(surface_[static_cast<std::size_t>(i)]);
    rho[i] = surface_reflectance[s];
    exitance[i] = surface_exitance[s];
  }
  system_ = -exchange_ * rho.asDiagonal();
  system_.diagonal() += area_;
  irradiance_ = system_.partialPivLu().solve(exchange_ * exitance);
  radiosity_ = exitance + rho.cwiseProduct(irradiance_);
}

ZonalValue MergedZones::weighted(const Eigen::VectorXd& weights) const {
  ZonalValue value;
  value.mean = weights.dot(irradiance_);
  if (sampled_.empty()) return value;
  // A change of G by d changes H by M^-1 d B; the adjoint says what that does to the mean.
  const Eigen::VectorXd adjoint = system_.transpose().partialPivLu().solve(weights);
  double variance = 0;
  for (const Sampled& s : sampled_) {
    const auto a = static_cast<Eigen::Index>(s.a);
    const auto b = static_cast<Eigen::Index>(s.b);
    const double slope = adjoint[a] * radiosity_[b] + adjoint[b] * radiosity_[a];
    variance += slope * slope * s.variance;
  }
  value.standard_error = std::sqrt(variance);
  return value;
}

ZonalValue MergedZones::zone(std::size_t zone) const {
  return weighted(Eigen::VectorXd::Unit(area_.size(), static_cast<Eigen::Index>(zone)));
}

ZonalValue MergedZones::surface(std::size_t surface) const {
  Eigen::VectorXd weights = area_;
  for (std::size_t z = 0; z < surface_.size(); ++z)
    if (surface_[z] != surface) weights[static_cast<Eigen::Index>(z)] = 0;
  return weighted(weights / weights.sum());
}

ZonalValue MergedZones::room() const {
  return weighted(area_ / area_.sum());
}

std::size_t MergedZones::brightest_zone() const {
  Eigen::Index at = 0;
  irradiance_.maxCoeff(&at);
  return static_cast<std::size_t>(at);
}

ValidationRow make_row(const ReferenceCase& c, const ReferenceValue& v, const ZonalValue& value,
                       double relative_bound) {
  ValidationRow row;
  row.id = v.id;
  row.kind = c.kind;
  row.method = "matrix";
  row.expected = v.value;
  row.expected_abs_err = v.abs_err;
  row.numerical_bound = relative_bound * std::fabs(v.value);
  row.measured = value.mean;
  row.standard_error = value.standard_error;
  return row;
}

}  // namespace reemit::validation
