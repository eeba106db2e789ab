#pragma once
#include <cmath>
#include <numbers>

#include "scenes/model/vec.h"

namespace reemit::test {

/// Unit vector of the angles [degrees] of photometry of type C, in the luminaire's axes: gamma from nadir,
/// the half-plane C around it.
inline Vec3 type_c(double gamma_deg, double c_deg) {
  const double g = gamma_deg * std::numbers::pi / 180;
  const double c = c_deg * std::numbers::pi / 180;
  return {std::sin(g) * std::cos(c), std::sin(g) * std::sin(c), -std::cos(g)};
}

}  // namespace reemit::test
