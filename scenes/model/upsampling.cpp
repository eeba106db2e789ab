#include "scenes/model/upsampling.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "scenes/model/colour.h"

namespace reemit {
namespace {

/// Sigmoids are made in (wavelength - middle) / half width, which keeps their coefficients alike in size.
constexpr double kMiddle = 595, kHalfWidth = 235;  // [nm], of 360 ... 830

/// The mean over a range of wavelengths, and its derivatives by the coefficients.
struct MeanOfSigmoid {
  double value = 0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
};

MeanOfSigmoid mean_of_sigmoid(const Eigen::Vector3d& c, const WavelengthRange& range) {
  constexpr double kSampleWidth = 2.5;  // [nm]
  constexpr double kMostSamples = 64;
  const auto samples =
      static_cast<int>(std::clamp(std::ceil(range.width() / kSampleWidth), 1.0, kMostSamples));
  MeanOfSigmoid mean;
  for (int i = 0; i < samples; ++i) {
    const double x = (range.from + range.width() * (i + 0.5) / samples - kMiddle) / kHalfWidth;
    const double p = (c[0] * x + c[1]) * x + c[2];
    const double root = std::sqrt(1 + p * p);
    mean.value += 0.5 + 0.5 * p / root;
    mean.slope += 0.5 / (root * root * root) * Eigen::Vector3d(x * x, x, 1);
  }
  mean.value /= samples;
  mean.slope /= samples;
  return mean;
}

Spectrum means_of_sigmoid(const Eigen::Vector3d& c, const BandSet& bands) {
  Spectrum values(static_cast<Eigen::Index>(bands.count()));
  for (std::size_t i = 0; i < bands.count(); ++i)
    values[static_cast<Eigen::Index>(i)] = mean_of_sigmoid(c, bands.range_nm(i)).value;
  return values;
}

Spectrum widths(const BandSet& bands) {
  Spectrum widths(static_cast<Eigen::Index>(bands.count()));
  for (std::size_t i = 0; i < bands.count(); ++i)
    widths[static_cast<Eigen::Index>(i)] = bands.range_nm(i).width();
  return widths;
}

bool shows_white_as_neutral(const BandSet& bands) {
  constexpr double kGreyRounding = 1e-9;
  const Eigen::Array3d white = bands.to_rgb(widths(bands));
  return white.minCoeff() > 0 && white.maxCoeff() - white.minCoeff() <= kGreyRounding * white.maxCoeff();
}

const BandSet& whole_visible_range() {
  static const BandSet bands = [] {
    std::vector<double> centres;
    for (double nm = 362.5; nm < 830; nm += 5) centres.push_back(nm);
    return BandSet::spectral(centres);
  }();
  return bands;
}

/// Column i: share of band i of the colour of a reflectance of 1 in light of these powers by band.
Eigen::Matrix3Xd colour_of_reflectance(const BandSet& bands, const Spectrum& light) {
  const auto count = static_cast<Eigen::Index>(bands.count());
  const Eigen::Array3d whole = bands.to_rgb(light);
  Eigen::Matrix3Xd shares(3, count);
  Spectrum part = Spectrum::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    part[i] = light[i];
    shares.col(i) = (bands.to_rgb(part) / whole).matrix();
    part[i] = 0;
  }
  return shares;
}

bool is_neutral(const Eigen::Array3d& rgb) {
  constexpr double kGreyRounding = 1e-9;
  return rgb.maxCoeff() - rgb.minCoeff() <= kGreyRounding * rgb.maxCoeff();
}

}  // namespace

Upsampling::Upsampling(const BandSet& bands, const Eigen::Array3d& light)
    : bands_(bands), observer_(shows_white_as_neutral(bands) ? bands : whole_visible_range()) {
  white_ = colour_of_reflectance(observer_, widths(observer_));
  lit_ = is_neutral(light) ? white_
                           : colour_of_reflectance(observer_, Upsampling(observer_).emission(light).values);
}

// Levenberg and Marquardt's method from the grey of equal luminance.
Upsampling::Sigmoid Upsampling::solve(const Eigen::Matrix3Xd& colour_of, const Eigen::Vector3d& rgb) const {
  constexpr int kMostSteps = 200;
  constexpr double kExact = 1e-12, kStuck = 1e12, kLeastCurvature = 1e-12;
  struct Miss {
    Eigen::Vector3d rgb = Eigen::Vector3d::Zero();
    Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
  };
  const auto miss_of = [&](const Eigen::Vector3d& c) {
    Miss miss;
    for (std::size_t i = 0; i < observer_.count(); ++i) {
      const MeanOfSigmoid mean = mean_of_sigmoid(c, observer_.range_nm(i));
      const auto column = colour_of.col(static_cast<Eigen::Index>(i));
      miss.rgb += mean.value * column;
      miss.slope += column * mean.slope.transpose();
    }
    miss.rgb -= rgb;
    return miss;
  };
  const double grey = std::clamp((rec709_luminance_weights() * rgb.array()).sum(), 1e-3, 1 - 1e-3);
  const double sine = 2 * grey - 1;
  Eigen::Vector3d c(0, 0, sine / std::sqrt(1 - sine * sine));
  Miss miss = miss_of(c);
  double damping = 1e-3;
  for (int i = 0; i < kMostSteps && miss.rgb.norm() > kExact && damping < kStuck; ++i) {
    Eigen::Matrix3d normal = miss.slope.transpose() * miss.slope;
    normal.diagonal() += damping * (normal.diagonal().array() + kLeastCurvature).matrix();
    const Eigen::Vector3d next = c - normal.inverse() * (miss.slope.transpose() * miss.rgb);
    const Miss there = next.allFinite() ? miss_of(next) : Miss{};
    if (next.allFinite() && there.rgb.norm() < miss.rgb.norm()) {
      c = next;
      miss = there;
      damping = std::max(damping / 5, 1e-12);
    } else {
      damping *= 4;
    }
  }
  return {c, miss.rgb.norm()};
}

Upsampled Upsampling::reflectance(const Eigen::Array3d& rgb, double most) const {
  const auto count = static_cast<Eigen::Index>(bands_.count());
  if (is_neutral(rgb)) return {Spectrum::Constant(count, std::min(rgb.maxCoeff(), most))};
  const Eigen::Vector3d share = (rgb / most).max(0).min(1).matrix();
  const Sigmoid sigmoid = solve(lit_, share);
  return {most * means_of_sigmoid(sigmoid.coefficients, bands_), sigmoid.residual / share.maxCoeff()};
}

Upsampled Upsampling::emission(const Eigen::Array3d& rgb) const {
  const auto count = static_cast<Eigen::Index>(bands_.count());
  const double strongest = rgb.maxCoeff();
  if (!(strongest > 0)) return {Spectrum::Zero(count)};
  if (count == 1) {
    const double luminance = (BandSet::rgb().efficacy_lm_per_w() * rgb).sum();
    const double efficacy = bands_.efficacy_lm_per_w()[0];
    return {Spectrum::Constant(1, efficacy > 0 ? luminance / efficacy : 0.0)};
  }
  // Radiance of a flat spectrum per nm, by the radiance of its colour.
  const double density = 1 / observer_.to_rgb(widths(observer_)).mean();
  if (is_neutral(rgb)) return {density * strongest * widths(bands_)};
  const Sigmoid sigmoid = solve(white_, (rgb / (2 * strongest)).matrix());
  return {2 * strongest * density * widths(bands_) * means_of_sigmoid(sigmoid.coefficients, bands_),
          2 * sigmoid.residual};
}

}  // namespace reemit
