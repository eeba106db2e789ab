#pragma once
#include <cmath>

namespace reemit {

struct SineVersine {
  double sine, versine;  ///< The versine is 1 - cosine.
};

/// Of an angle >= 0 [rad], each within 2 units in the last place up to kSmallAngle, where series of six terms
/// do it without a call; beyond, by the library, as its sine and cosine.
inline constexpr double kSmallAngle = 0.2;
inline SineVersine sine_and_versine(double x) {
  if (!(x <= kSmallAngle)) {
    const double sine = std::sin(x);
    const double cosine = std::cos(x);
    return {sine, cosine > 0 ? sine * sine / (1 + cosine) : 1 - cosine};
  }
  const double y = x * x;
  return {
      x * (1 +
           y * (-1.0 / 6 + y * (1.0 / 120 + y * (-1.0 / 5040 + y * (1.0 / 362880 - y * (1.0 / 39916800)))))),
      y * (1.0 / 2 + y * (-1.0 / 24 + y * (1.0 / 720 + y * (-1.0 / 40320 +
                                                            y * (1.0 / 3628800 - y * (1.0 / 479001600))))))};
}

}  // namespace reemit
