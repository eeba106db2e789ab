#pragma once
#include <cstddef>
#include <vector>

#include "solver/solution/solution.h"
#include "tests/support/chi_square.h"

namespace reemit::test {

/// Irradiances of all zones in all bands.
inline std::vector<Measured> zone_irradiances(const Solution& s) {
  std::vector<Measured> all;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z)
    for (std::size_t b = 0; b < s.bands.count(); ++b) {
      const Estimate e = s.irradiance(ZoneId(z), b);
      all.push_back({e.mean, e.stderr_of_mean});
    }
  return all;
}

/// Odds that all of them have this value but for their noise: squared deviations in standard errors, tested
/// as chi-square.
inline double furnace_fit(const Solution& s, double truth) {
  const std::vector<Measured> measured = zone_irradiances(s);
  return agreement(measured, std::vector<Measured>(measured.size(), {truth, 0}),
                   static_cast<double>(s.sums.batches));
}

}  // namespace reemit::test
