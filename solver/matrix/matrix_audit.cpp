#include "solver/matrix/matrix_audit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace reemit {
namespace {

/// Powers of one band [W].
struct Powers {
  std::vector<double> absorbed;           // by surface
  std::vector<double> absorbed_on_backs;  // by surface
  std::array<double, LeakAccount::kAxes> escaped{};

  explicit Powers(std::size_t surfaces) : absorbed(surfaces), absorbed_on_backs(surfaces) {}

  /// Shares out power by where rays went; none if none of them left the zones.
  void leak(double watts, std::span<const LeakAccount> leaks) {
    const auto rays = std::accumulate(leaks.begin(), leaks.end(), 0.0,
                                      [](double sum, const LeakAccount& a) { return sum + a.rays; });
    for (const LeakAccount& a : leaks) {
      const double share = watts * a.rays / rays;
      if (a.account < LeakAccount::kAxes)
        escaped[a.account] += share;
      else
        absorbed_on_backs[a.account - LeakAccount::kAxes] += share;
    }
  }
};

}  // namespace

void book_matrix_solution(const PacketRoom& transport, const PacketSources& emission,
                          const FormFactors& factors, const RowMatrix& radiosity, const RowMatrix& irradiance,
                          const std::vector<LuminaireLeak>& light_losses, std::int64_t batches,
                          EnergyAudit& audit) {
  const Eigen::VectorXd row_sums = factors.row_sums();
  audit.batches = batches;
  audit.weight = batches;
  for (std::size_t b = 0; b < transport.channels().bands(); ++b) {
    BandAudit& band = audit.bands[b];
    if (!(emission.watts_per_quantum[b] > 0)) continue;
    const auto column = static_cast<Eigen::Index>(b);
    Powers powers(transport.surfaces());
    for (std::size_t i = 0; i < factors.zones(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const SurfaceId surface = transport.mesh().zone_surface(ZoneId(i));
      const double area = factors.zone_area(i);
      powers.absorbed[surface.index()] +=
          area *
          (1 - transport.surface_model().reflectance(ZoneId(i), transport.mesh().zone_triangle(ZoneId(i)),
                                                     transport.mesh().zone_is_front(ZoneId(i)))[b]) *
          irradiance(row, column);
      powers.leak(area * radiosity(row, column) * std::max(0.0, 1 - row_sums(row)), factors.leaks().of(i));
    }
    for (const LuminaireLeak& loss : light_losses) powers.leak(std::max(0.0, loss.watts(column)), loss.leaks);

    const auto quanta = [&](double watts) {
      return RunQuanta{batches} * std::llround(watts / emission.watts_per_quantum[b]);
    };
    band.emitted = RunQuanta{batches} * kBatchQuanta;
    for (std::size_t s = 0; s < transport.surfaces(); ++s) {
      band.absorbed[s] = quanta(powers.absorbed[s]);
      band.absorbed_on_backs[s] = quanta(powers.absorbed_on_backs[s]);
    }
    for (std::size_t axis = 0; axis < powers.escaped.size(); ++axis)
      band.escaped[axis] = quanta(powers.escaped[axis]);
    band.unshot = band.emitted - band.total_absorbed() - band.total_escaped();
  }
}

}  // namespace reemit
