#include "scenes/io/mgf/mgf_colour.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "scenes/model/cie_1931.h"

namespace reemit {
namespace {

constexpr double kVisibleFrom = 360, kVisibleTo = 830;  // [nm], range of the CIE table

// Never NaN, as colours are compared with each other.
MgfColour chromaticity(const Eigen::Vector3d& xyz) {
  const MgfColour colour{xyz[0] / xyz.sum(), xyz[1] / xyz.sum()};
  return std::isfinite(colour.x) && std::isfinite(colour.y) ? colour : MgfColour{0, 0};
}

template <class Density>
MgfColour integrate(double from_nm, double to_nm, const Density& density) {
  const double from = std::max(from_nm, kVisibleFrom);
  const double to = std::min(to_nm, kVisibleTo);
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  const auto steps = static_cast<int>(std::clamp(std::ceil(to - from), 64.0, 512.0));  // about 1 nm
  for (int i = 0; i < steps && to > from; ++i) {
    const double wavelength = from + (to - from) * (i + 0.5) / steps;
    xyz += density(wavelength) * cie_1931(wavelength);
  }
  return chromaticity(xyz);
}

}  // namespace

bool is_valid_chromaticity(double x, double y) {
  constexpr double kLeastY = 1e-3;    // the spectral locus stays above 0.0048
  constexpr double kRounding = 1e-3;  // deep red rounded to three digits: 0.735 + 0.266
  return x >= 0 && y >= kLeastY && x + y <= 1 + kRounding;
}

MgfColour colour_of_spectrum(double from_nm, double to_nm, std::span<const double> samples) {
  const double intervals = static_cast<double>(samples.size() - 1);
  return integrate(from_nm, to_nm, [&](double wavelength) {
    const double position = std::clamp((wavelength - from_nm) / (to_nm - from_nm), 0.0, 1.0) * intervals;
    const auto index = std::min(static_cast<std::size_t>(position), samples.size() - 2);
    return std::lerp(samples[index], samples[index + 1], position - static_cast<double>(index));
  });
}

MgfColour colour_of_black_body(double kelvin) {
  constexpr double kSecondRadiation = 1.438776877e7;  // h c / k [nm K], CODATA 2018
  const double scale = kSecondRadiation / kelvin;
  return integrate(kVisibleFrom, kVisibleTo, [&](double wavelength) {
    // Planck's law relative to its value at 560 nm, which keeps low temperatures within range.
    return std::pow(560 / wavelength, 5) * std::expm1(scale / 560) / std::expm1(scale / wavelength);
  });
}

MgfColour mix_colours(std::span<const std::pair<double, MgfColour>> parts) {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  for (const auto& [weight, colour] : parts)
    xyz += weight * Eigen::Vector3d(colour.x / colour.y, 1, (1 - colour.x - colour.y) / colour.y);
  return chromaticity(xyz);
}

}  // namespace reemit
