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

  /// By how much all that left is more.
  void scale_leaks(double factor) {
    for (double& watts : escaped) watts *= factor;
    for (double& watts : absorbed_on_backs) watts *= factor;
  }
  double leaked() const {
    return std::accumulate(escaped.begin(), escaped.end(), 0.0) +
           std::accumulate(absorbed_on_backs.begin(), absorbed_on_backs.end(), 0.0);
  }
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
    double unseen = 0;  // left from zones none of whose rays did [W]
    for (std::size_t i = 0; i < factors.zones(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const SurfaceId surface = transport.mesh().zone_surface(ZoneId(i));
      const double area = factors.zone_area(i);
      powers.absorbed[surface.index()] +=
          area *
          (1 - transport.surface_model().reflectance(ZoneId(i), transport.mesh().zone_triangle(ZoneId(i)),
                                                     transport.mesh().zone_is_front(ZoneId(i)))[b]) *
          irradiance(row, column);
      const double lacking = area * radiosity(row, column) * (1 - row_sums(row));
      if (factors.leaks().closed(i))
        unseen += lacking;
      else
        powers.leak(std::max(0.0, lacking), factors.leaks().of(i));
    }
    // Through a small opening little leaves from many zones, and that goes where the rays of others went.
    // What rows are off by sampling is of either sign and cancels.
    if (unseen > 0 && powers.leaked() > 0) powers.scale_leaks(1 + unseen / powers.leaked());
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
