#include "scenes/io/common/spectral_bands.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "scenes/io/common/text_parse.h"

namespace reemit {
namespace {

constexpr double kShortestWave = 1, kLongestWave = 1e6;  // [nm]
constexpr double kOfAStep = 1e-9;                        // of a step

double steps_of(const SpectralBands& bands) {
  return std::floor((bands.last_nm - bands.first_nm) / bands.step_nm + kOfAStep);
}

}  // namespace

std::string SpectralBands::problem() const {
  for (const double nm : {first_nm, last_nm})
    if (!(nm >= kShortestWave && nm <= kLongestWave))
      return fmt::format("a wavelength of {} nm is not between {} and {}", nm, kShortestWave, kLongestWave);
  if (!(step_nm > 0)) return fmt::format("a step of {} nm", step_nm);
  const double steps = steps_of(*this);
  if (!(steps >= 1)) return "less than two bands";
  if (!(steps < static_cast<double>(kMostBands))) return fmt::format("more than {} bands", kMostBands);
  return {};
}

std::vector<double> SpectralBands::centres_nm() const {
  std::vector<double> centres;
  const auto steps = static_cast<int>(steps_of(*this));
  for (int i = 0; i <= steps; ++i) centres.push_back(first_nm + i * step_nm);
  return centres;
}

std::string SpectralBands::text() const {
  return fmt::format("{}:{}:{}", first_nm, last_nm, step_nm);
}

SpectralBands parse_spectral_bands(const std::string& text) {
  std::array<double, 3> numbers{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto colon = rest.find(':');
    const auto number = parse_number(rest.substr(0, colon));
    if (!number || (i + 1 < numbers.size()) != (colon != std::string_view::npos))
      throw std::invalid_argument(fmt::format("'{}' is not FIRST:LAST:STEP in nm, as 400:700:10", text));
    numbers[i] = *number;
    if (colon != std::string_view::npos) rest.remove_prefix(colon + 1);
  }
  const SpectralBands bands{numbers[0], numbers[1], numbers[2]};
  if (const std::string problem = bands.problem(); !problem.empty())
    throw std::invalid_argument(
        fmt::format("'{}': {}; give FIRST:LAST:STEP in nm, as 400:700:10", text, problem));
  return bands;
}

}  // namespace reemit
