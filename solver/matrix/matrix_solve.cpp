#include "solver/matrix/matrix_solve.h"

#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "scenes/model/error.h"
#include "solver/emit/punctual_emitter.h"
#include "solver/matrix/conjugate_gradients.h"
#include "solver/matrix/factor_noise.h"
#include "solver/matrix/form_factors.h"
#include "solver/matrix/matrix_audit.h"
#include "solver/matrix/punctual_irradiance.h"
#include "solver/matrix/zone_points.h"
#include "solver/tally/batch_statistics.h"

namespace reemit {
namespace {

constexpr std::size_t kMatrixReplicates = ZoneSums::kGroups;
constexpr double kResidualAimedAt = 1e-13;
constexpr double kLargestResidual = 1e-10;
constexpr int kMostIterations = 5000;
/// Changes of replicates are followed from bounce to bounce until less than this share of them is left.
constexpr double kNoiseLeft = 1e-3;
constexpr int kMostNoiseBounces = 1000;

Eigen::Index to_index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

/// The zonal system of all bands; matrices are zone x band.
struct ZonalSystem {
  const FormFactors& factors;
  Eigen::VectorXd areas;  // [m2]
  RowMatrix emitted;      // M [W/m2]
  RowMatrix reflectance;
  RowMatrix punctual;             // E_p [W/m2]
  RowMatrix punctual_replicates;  // zone x (band * kMatrixReplicates + replicate)
  std::vector<LuminaireLeak> light_losses;
  std::uint64_t rays = 0;

  /// F x for each column x.
  RowMatrix transported(const RowMatrix& x) const {
    return areas.cwiseInverse().asDiagonal() * factors.exchange().times_columns(x);
  }
};

void add_punctual_lights(const PacketRoom& transport, std::uint64_t seed, ZonalSystem& system) {
  const std::vector<PunctualLight>& lights = transport.scene().lights;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const Spectrum& emission = strength_of(lights[l]);
    const Spectrum power = light_power(lights[l], transport.rays().metres_per_unit());
    Eigen::Index band = 0;
    if (!(emission.maxCoeff(&band) > 0)) continue;
    const std::uint64_t light_seed = matrix_seed(seed, MatrixNumbers::kLightLeaks, l, 0);
    LuminaireLeak loss;
    loss.leaks = trace_light_leaks(transport.emitters()[l], transport.rays(), light_seed);
    const double known_to_arrive = loss.leaks.empty() ? power(band) / emission(band) : 0;
    const PunctualIrradiance irradiance =
        punctual_irradiance(transport.emitters()[l], transport, light_seed, known_to_arrive);
    loss.watts = power - irradiance.arriving * emission;
    system.light_losses.push_back(std::move(loss));
    for (Eigen::Index b = 0; b < emission.size(); ++b)
      system.punctual_replicates.middleCols(b * to_index(kMatrixReplicates), to_index(kMatrixReplicates)) +=
          emission(b) * irradiance.of_zone;
    system.rays += kRaysPerLight + PunctualIrradiance::kRaysPerZone * transport.zones();
  }
  for (Eigen::Index b = 0; b < system.punctual.cols(); ++b)
    system.punctual.col(b) =
        system.punctual_replicates.middleCols(b * to_index(kMatrixReplicates), to_index(kMatrixReplicates))
            .rowwise()
            .mean();
}

ZonalSystem make_system(const PacketRoom& transport, const FormFactors& factors, const Solution& solution) {
  const Eigen::Index zones = to_index(factors.zones());
  const Eigen::Index bands = to_index(transport.channels().bands());
  ZonalSystem system{factors,
                     Eigen::VectorXd(zones),
                     RowMatrix(zones, bands),
                     RowMatrix(zones, bands),
                     RowMatrix::Zero(zones, bands),
                     RowMatrix::Zero(zones, bands * to_index(kMatrixReplicates)),
                     {},
                     0};
  for (Eigen::Index z = 0; z < zones; ++z) {
    const ZoneId zone(static_cast<std::size_t>(z));
    system.areas(z) = factors.zone_area(zone.index());
    for (std::size_t b = 0; b < transport.channels().bands(); ++b) {
      system.emitted(z, to_index(b)) = solution.emitted_radiosity(zone, b);
      system.reflectance(z, to_index(b)) = transport.surface_model().reflectance(
          zone, transport.mesh().zone_triangle(zone), transport.mesh().zone_is_front(zone))[b];
    }
  }
  add_punctual_lights(transport, solution.settings.seed, system);
  return system;
}

/// Irradiance of all zones in one band. Unknown is y = sqrt(rho A) E, for which the matrix
/// 1 - sqrt(rho/A) S sqrt(rho/A), with S the exchange areas, is symmetric and positive definite.
Eigen::VectorXd solve_band(const ZonalSystem& system, Eigen::Index band, const Scene& scene) {
  const Eigen::VectorXd rho = system.reflectance.col(band);
  const Eigen::VectorXd emitted = system.emitted.col(band);
  const Eigen::VectorXd scaling = rho.cwiseQuotient(system.areas).cwiseSqrt();
  const SymmetricTable<double>& exchange = system.factors.exchange();
  const auto matrix = [&](const Eigen::VectorXd& y) -> Eigen::VectorXd {
    return y - scaling.cwiseProduct(exchange.times(scaling.cwiseProduct(y)));
  };
  const Eigen::VectorXd first_hit =
      exchange.times(emitted) + system.areas.cwiseProduct(system.punctual.col(band));
  Eigen::VectorXd y = Eigen::VectorXd::Zero(rho.size());
  const IterationEnd end =
      conjugate_gradients(matrix, scaling.cwiseProduct(first_hit), y, kResidualAimedAt, kMostIterations);
  if (!(end.residual <= kLargestResidual))
    throw InputError(scene.source,
                     fmt::format("the zonal system of band '{}' could not be solved (residual {:.1e})",
                                 scene.bands.name(static_cast<std::size_t>(band)), end.residual),
                     "Some part of the room that no light leaves reflects all or almost all light: lower its "
                     "reflectance.");
  // sqrt(rho/A) y = rho E, the reflected part; one more transport gives E where rho is 0 as well.
  const Eigen::VectorXd radiosity = emitted + scaling.cwiseProduct(y);
  return exchange.times(radiosity).cwiseQuotient(system.areas) + system.punctual.col(band);
}

/// Deviations of the replicates from the solution, zone x (band * kMatrixReplicates + replicate) [W/m2].
struct ReplicateNoise {
  RowMatrix direct, total;
};

/// Moves the columns of each band so that their mean is 0.
void centre(RowMatrix& deviations) {
  for (Eigen::Index first = 0; first < deviations.cols(); first += to_index(kMatrixReplicates)) {
    auto of_band = deviations.middleCols(first, to_index(kMatrixReplicates));
    of_band.colwise() -= of_band.rowwise().mean().eval();
  }
}

ReplicateNoise replicate_noise(const ZonalSystem& system, const RowMatrix& radiosity, std::uint64_t seed) {
  // A replicate is one of 16 estimates whose mean has the standard error of the form factors.
  const double spread = std::sqrt(static_cast<double>(kMatrixReplicates));
  RowMatrix lights = system.punctual_replicates;
  centre(lights);
  ReplicateNoise noise;
  noise.direct = factor_noise(system.factors, system.emitted, kMatrixReplicates, spread, seed);
  centre(noise.direct);
  noise.direct += lights;
  RowMatrix source = factor_noise(system.factors, radiosity, kMatrixReplicates, spread, seed);
  centre(source);
  source += lights;

  noise.total = source;
  RowMatrix bounce = source;
  const double start = source.norm();
  for (int k = 0; k < kMostNoiseBounces && bounce.norm() > kNoiseLeft * start; ++k) {
    for (Eigen::Index b = 0; b < radiosity.cols(); ++b)
      bounce.middleCols(b * to_index(kMatrixReplicates), to_index(kMatrixReplicates)).array().colwise() *=
          system.reflectance.col(b).array();
    bounce = system.transported(bounce);
    noise.total += bounce;
  }
  return noise;
}

void store(const RowMatrix& direct, const RowMatrix& total, const ReplicateNoise& noise, ZoneSums& sums) {
  for (std::size_t r = 0; r < kMatrixReplicates; ++r) sums.count_batch(1);
  std::array<double, kMatrixReplicates> direct_values{};
  std::array<double, kMatrixReplicates> indirect_values{};
  for (Eigen::Index z = 0; z < direct.rows(); ++z)
    for (Eigen::Index b = 0; b < direct.cols(); ++b) {
      for (std::size_t r = 0; r < kMatrixReplicates; ++r) {
        const Eigen::Index at = b * to_index(kMatrixReplicates) + to_index(r);
        direct_values[r] = direct(z, b) + noise.direct(z, at);
        indirect_values[r] = total(z, b) - direct(z, b) + noise.total(z, at) - noise.direct(z, at);
      }
      store_replicates(sums,
                       static_cast<std::size_t>(z) * sums.channels.count() + static_cast<std::size_t>(b),
                       direct_values, indirect_values);
    }
}

}  // namespace

void solve_by_matrix(const PacketRoom& transport, const PacketSources& emission,
                     const std::function<void(double)>& progress, const std::atomic<bool>& interrupt,
                     Solution& solution) {
  const std::uint64_t seed = solution.settings.seed;
  const FormFactors factors =
      compute_form_factors(transport.mesh(), transport.rays(), {seed, true}, progress, interrupt);
  const ZonalSystem system = make_system(transport, factors, solution);
  RowMatrix total(system.emitted.rows(), system.emitted.cols());
  for (Eigen::Index b = 0; b < total.cols(); ++b) {
    if (interrupt) throw Interrupted("interrupted before the system was solved");
    total.col(b) = solve_band(system, b, transport.scene());
  }
  const RowMatrix direct = system.transported(system.emitted) + system.punctual;
  const RowMatrix radiosity = system.emitted + system.reflectance.cwiseProduct(total);
  store(direct, total, replicate_noise(system, radiosity, seed), solution.sums);
  book_matrix_solution(transport, emission, factors, radiosity, total, system.light_losses,
                       solution.sums.batches, solution.audit);
  solution.form_factors = factors.report();
  solution.record.rays = factors.report().rays + system.rays;
  solution.record.stopped = StopReason::kSystemSolved;
}

}  // namespace reemit
