#pragma once
#include <cmath>
#include <numbers>

namespace reemit {

/// A direction about an axis.
struct AxisDirection {
  double z;        ///< Cosine of the angle to the axis.
  double azimuth;  ///< [rad]
};

/// Direction i of n on a spherical Fibonacci lattice: even cover with any number of them.
inline AxisDirection sphere_lattice(int i, int n) {
  return {1 - (2.0 * i + 1) / n, 2 * std::numbers::pi * std::fmod(i * (std::numbers::phi - 1), 1.0)};
}

}  // namespace reemit
