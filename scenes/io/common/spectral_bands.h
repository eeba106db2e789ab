#pragma once
#include <string>
#include <vector>

namespace reemit {

/// Spectral bands at equal steps, by their centres [nm]. All 0: none are asked for.
struct SpectralBands {
  double first_nm = 0, last_nm = 0, step_nm = 0;

  bool given() const { return *this != SpectralBands{}; }
  /// What is wrong with them, or nothing.
  std::string problem() const;
  /// From the first in steps up to the last, or as near below as the steps come. Pre: problem() is empty.
  std::vector<double> centres_nm() const;
  std::string text() const;  ///< "400:700:10", as parse_spectral_bands reads it.

  bool operator==(const SpectralBands&) const = default;
};

/// "FIRST:LAST:STEP" in nm. Throws std::invalid_argument.
SpectralBands parse_spectral_bands(const std::string& text);

/// Most bands that a room may have.
inline constexpr std::size_t kMostBands = 1024;

}  // namespace reemit
