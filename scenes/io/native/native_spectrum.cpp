#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "scenes/io/common/srgb.h"
#include "scenes/io/native/native_materials.h"
#include "scenes/model/error.h"
#include "scenes/model/upsampling.h"

namespace reemit {

namespace {

/// A function of wavelength given by samples, linear between them.
struct Samples {
  std::vector<double> nm;
  std::vector<double> value;
  bool extend;  // Beyond the ends: the end value, else 0.

  double at(double wavelength) const {
    if (wavelength < nm.front()) return extend ? value.front() : 0;
    if (wavelength > nm.back()) return extend ? value.back() : 0;
    const auto upper = std::upper_bound(nm.begin(), nm.end(), wavelength);
    if (upper == nm.end()) return value.back();
    const auto i = static_cast<std::size_t>(upper - nm.begin());
    const double t = (wavelength - nm[i - 1]) / (nm[i] - nm[i - 1]);
    return value[i - 1] + t * (value[i] - value[i - 1]);
  }

  /// Exact integral over [from, to]: between two samples the function is linear, so its middle value is its
  /// mean.
  double integral(double from, double to) const {
    std::vector<double> knots{from};
    for (const double knot : nm) {
      if (knot > from && knot < to) knots.push_back(knot);
    }
    knots.push_back(to);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      sum += at(0.5 * (knots[i] + knots[i + 1])) * (knots[i + 1] - knots[i]);
    }
    return sum;
  }
};

Samples read_samples(const JsonCursor& at, bool extend) {
  at.expect_object({"nm", "value"});
  const JsonCursor nm = at.at("nm");
  const JsonCursor value = at.at("value");
  Samples samples{nm.numbers(), value.numbers(), extend};
  if (samples.nm.size() < 2) nm.fail("a sampled spectrum needs at least two wavelengths", "Add samples.");
  if (samples.nm.size() != samples.value.size()) {
    value.fail(fmt::format("{} values for {} wavelengths", samples.value.size(), samples.nm.size()),
               "Give one value per wavelength.");
  }
  for (std::size_t i = 1; i < samples.nm.size(); ++i) {
    if (samples.nm[i] <= samples.nm[i - 1])
      nm[i].fail("the wavelengths do not increase", "Sort the samples.");
  }
  return samples;
}

enum class Quantity { kReflectance, kEmission, kOpticalConstant };

Eigen::Array3d read_srgb(const JsonCursor& text) {
  const std::string& hex = text.string();
  const bool well_formed =
      hex.size() == 7 && hex[0] == '#' &&
      std::all_of(hex.begin() + 1, hex.end(), [](unsigned char c) { return std::isxdigit(c); });
  if (!well_formed) text.fail(fmt::format("\"{}\" is not a colour", hex), "Write it as \"#rrggbb\".");
  Eigen::Array3d rgb;
  for (int i = 0; i < 3; ++i)
    rgb[i] =
        linear_from_srgb(std::stoi(hex.substr(1 + 2 * static_cast<std::size_t>(i), 2), nullptr, 16) / 255.0);
  return rgb;
}

Eigen::Array3d read_rgb(const JsonCursor& listed, double most) {
  listed.expect_array(3, 3);
  Eigen::Array3d rgb;
  for (std::size_t i = 0; i < 3; ++i) rgb[static_cast<Eigen::Index>(i)] = listed[i].number_in(0, most);
  return rgb;
}

/// {"srgb": "#rrggbb"} or {"rgb": [r, g, b]} in the bands of the room.
Spectrum read_colour(const JsonCursor& at, const BandSet& bands, Quantity quantity, double most) {
  const bool encoded = at.find("srgb").has_value();
  at.expect_object({encoded ? "srgb" : "rgb"});
  const Eigen::Array3d rgb = encoded ? read_srgb(at.at("srgb")) : read_rgb(at.at("rgb"), most);
  if (bands.kind() == BandKind::kRgb) return rgb;
  if (bands.kind() == BandKind::kGrey) {
    const Spectrum weights = BandSet::rgb().efficacy_lm_per_w();
    return Spectrum::Constant(1, (rgb * weights).sum() / weights.sum());
  }
  if (quantity == Quantity::kOpticalConstant)
    at.fail("a colour has no spectrum of eta or k",
            "Give one value per band or {\"nm\": [...], \"value\": [...]}.");
  const Upsampling upsampling(bands);
  const Upsampled upsampled =
      quantity == Quantity::kEmission ? upsampling.emission(rgb) : upsampling.reflectance(rgb);
  constexpr double kMostDeviation = 0.01;
  if (upsampled.deviation > kMostDeviation)
    at.fail(
        fmt::format("the {} bands of the room are too few for this colour: the nearest spectrum misses it by "
                    "{:.2g} %",
                    bands.count(), 100 * upsampled.deviation),
        "Give the room more bands, or the spectrum itself.");
  return upsampled.values;
}

void demand_spectral(const JsonCursor& at, const BandSet& bands) {
  if (bands.kind() != BandKind::kSpectral) {
    at.fail("a sampled spectrum needs a room with spectral bands",
            "Set \"bands\": {\"wavelengths_nm\": [...]}, or give a number or one value per band.");
  }
}

Spectrum read_spectrum(const JsonCursor& at, const BandSet& bands, Quantity quantity) {
  const auto count = static_cast<Eigen::Index>(bands.count());
  const double most = quantity == Quantity::kReflectance ? 1
                      : quantity == Quantity::kEmission  ? std::numeric_limits<double>::max()
                                                         : NonDiffusePart::kLargestIndex;
  if (at.is_number()) return Spectrum::Constant(count, at.number_in(0, most));
  if (at.is_array()) {
    if (bands.kind() == BandKind::kSpectral && at.size() == 3 && bands.count() != 3)
      at.fail(fmt::format("3 values for {} bands", bands.count()),
              "Write a colour as {\"rgb\": [r, g, b]}, or give one value per band.");
    at.expect_array(bands.count(), bands.count());
    Spectrum values(count);
    for (std::size_t i = 0; i < bands.count(); ++i)
      values[static_cast<Eigen::Index>(i)] = at[i].number_in(0, most);
    return values;
  }
  if (!at.is_object()) {
    at.fail("expected a spectrum",
            fmt::format("Write a number, {} number(s) for the bands of this room, "
                        "{{\"nm\": [...], \"value\": [...]}}, {{\"rgb\": [r, g, b]}} or "
                        "{{\"srgb\": \"#rrggbb\"}}.",
                        bands.count()));
  }
  if (at.find("srgb") || at.find("rgb")) return read_colour(at, bands, quantity, most);
  demand_spectral(at, bands);
  const Samples samples = read_samples(at, quantity != Quantity::kEmission);
  const JsonCursor listed = at.at("value");
  for (std::size_t i = 0; i < samples.value.size(); ++i) listed[i].number_in(0, most);
  const std::vector<double>& centres = bands.centres_nm();
  if (centres.size() == 1) {
    if (quantity == Quantity::kEmission) {
      at.fail("a room with one wavelength has no band width to integrate an emission over", "Give a number.");
    }
    return Spectrum::Constant(1, samples.at(centres[0]));
  }
  Spectrum values(count);
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const auto [from, to] = bands.range_nm(i);
    const double integral = samples.integral(from, to);
    values[static_cast<Eigen::Index>(i)] =
        quantity == Quantity::kEmission ? integral : integral / (to - from);
  }
  return values;
}

}  // namespace

Spectrum read_reflectance(const JsonCursor& at, const BandSet& bands) {
  return read_spectrum(at, bands, Quantity::kReflectance);
}

Spectrum read_optical_constant(const JsonCursor& at, const BandSet& bands) {
  return read_spectrum(at, bands, Quantity::kOpticalConstant);
}

Spectrum read_emission(const JsonCursor& at, const BandSet& bands) {
  return read_spectrum(at, bands, Quantity::kEmission);
}

Spectrum photometric_emission(double photometric, const std::optional<JsonCursor>& colour,
                              const BandSet& bands) {
  const Spectrum shape =
      colour ? read_emission(*colour, bands) : Spectrum::Ones(static_cast<Eigen::Index>(bands.count()));
  const double lumens = (shape * bands.efficacy_lm_per_w()).sum();
  if (lumens > 0) return shape * (photometric / lumens);
  if (photometric == 0) return Spectrum::Zero(shape.size());
  if (colour) colour->fail("this colour has no luminance", "Give it a value in a visible band.");
  throw InputError("bands", "none of the bands of the room is visible", "Give emission in watts instead.");
}

}  // namespace reemit
