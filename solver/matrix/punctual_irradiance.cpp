#include "solver/matrix/punctual_irradiance.h"

#include <tbb/parallel_for.h>

#include "solver/matrix/zone_points.h"
#include "solver/sampling/sobol.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPointsPerScramble =
    PunctualIrradiance::kRaysPerZone / PunctualIrradiance::kReplicates;

bool lit(const RayTracer& rays, const LuminaireSample& sample, const Vec3f& origin) {
  return sample.at_infinity ? rays.escapes(origin, sample.target) : rays.visible(origin, sample.target);
}

}  // namespace

PunctualIrradiance punctual_irradiance(const PunctualEmitter& light, const PacketRoom& transport,
                                       std::uint64_t seed, double power_per_unit) {
  const ZoneMesh& mesh = transport.mesh();
  const RayTracer& rays = transport.rays();
  PunctualIrradiance result;
  const auto zones = static_cast<Eigen::Index>(mesh.zone_count());
  result.of_zone = RowMatrix::Zero(zones, PunctualIrradiance::kReplicates);
  tbb::parallel_for(Eigen::Index{0}, zones, [&](Eigen::Index z) {
    const auto zone = static_cast<std::size_t>(z);
    const ZonePoints points(mesh, rays, ZoneId(zone));
    for (std::uint32_t r = 0; r < PunctualIrradiance::kReplicates; ++r) {
      const SobolSequence numbers(matrix_seed(seed, MatrixNumbers::kLightOnZone, zone, r));
      double sum = 0;
      for (std::uint32_t k = 0; k < kPointsPerScramble; ++k) {
        const auto [u, v] = sample_triangle(numbers.sample(k, 0), numbers.sample(k, 1));
        const Vec3f origin = points.origin(u, v);
        const LuminaireSample sample =
            sample_light(light, origin, points.normal(), numbers.sample(k, 2), numbers.sample(k, 3));
        if (sample.factor > 0 && lit(rays, sample, origin)) sum += static_cast<double>(sample.factor);
      }
      result.of_zone(z, r) = sum / kPointsPerScramble;
    }
  });
  Eigen::VectorXd areas(zones);
  for (Eigen::Index z = 0; z < zones; ++z) areas(z) = mesh.zone_area(ZoneId(static_cast<std::size_t>(z)));
  Eigen::RowVectorXd arriving = areas.transpose() * result.of_zone;
  if (power_per_unit > 0 && (arriving.array() > 0).all()) {
    result.of_zone.array().rowwise() *= power_per_unit / arriving.array();
    arriving.setConstant(power_per_unit);
  }
  result.arriving = arriving.mean();
  return result;
}

}  // namespace reemit
