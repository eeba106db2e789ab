#include "scenes/model/bands.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "scenes/model/cie_1931.h"
#include "scenes/model/colour.h"

namespace reemit {
namespace {

constexpr double kRgbEfficacy = 179;       // [lm/W], the Radiance convention [ZIM98]
constexpr double kSpectralEfficacy = 683;  // [lm/W] at 555 nm

// Column i: XYZ of one watt in band i, relative to 683 lm/W.
Eigen::Matrix3Xd band_xyz(const std::vector<WavelengthRange>& ranges) {
  Eigen::Matrix3Xd xyz(3, static_cast<Eigen::Index>(ranges.size()));
  for (std::size_t i = 0; i < ranges.size(); ++i)
    xyz.col(static_cast<Eigen::Index>(i)) = mean_cie_1931(ranges[i].from, ranges[i].to);
  return xyz;
}

// Makes the flat spectrum exactly neutral when the bands cover the visible range, where only sampling keeps
// it from being so. Bands that cover a part of it keep their true colours.
void balance_white(Eigen::Matrix3Xd& xyz, const std::vector<WavelengthRange>& ranges) {
  constexpr double kMostImbalance = 1.5;
  if (ranges.size() == 1) {  // nothing to tell colours apart by
    xyz.row(0) = xyz.row(1);
    xyz.row(2) = xyz.row(1);
    return;
  }
  Eigen::Vector3d white = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < ranges.size(); ++i)
    white += xyz.col(static_cast<Eigen::Index>(i)) * ranges[i].width();
  if (!(white.maxCoeff() <= kMostImbalance * white.minCoeff()) || white.minCoeff() <= 0) return;
  for (const Eigen::Index k : {0, 2}) xyz.row(k) *= white[1] / white[k];
}

}  // namespace

BandSet BandSet::grey() {
  BandSet bands;
  bands.kind_ = BandKind::kGrey;
  bands.names_ = {"grey"};
  bands.efficacy_ = Spectrum::Constant(1, kRgbEfficacy);
  bands.to_rgb_ = Eigen::Vector3d::Ones();
  return bands;
}

BandSet BandSet::rgb() {
  BandSet bands;
  bands.kind_ = BandKind::kRgb;
  bands.names_ = {"r", "g", "b"};
  bands.efficacy_ = kRgbEfficacy * rec709_luminance_weights();
  bands.to_rgb_ = Eigen::Matrix3d::Identity();
  return bands;
}

BandSet BandSet::spectral(std::vector<double> centres_nm) {
  if (centres_nm.empty()) throw std::invalid_argument("a spectral room needs at least one band");
  for (std::size_t i = 0; i < centres_nm.size(); ++i) {
    if (!std::isfinite(centres_nm[i]) || centres_nm[i] <= 0 || (i > 0 && centres_nm[i] <= centres_nm[i - 1]))
      throw std::invalid_argument("band centres must be positive and strictly increasing");
  }
  BandSet bands;
  bands.kind_ = BandKind::kSpectral;
  for (const double centre : centres_nm) bands.names_.push_back(fmt::format("{}", centre));
  bands.centres_nm_ = std::move(centres_nm);
  std::vector<WavelengthRange> ranges;
  for (std::size_t i = 0; i < bands.count(); ++i) ranges.push_back(bands.range_nm(i));
  Eigen::Matrix3Xd xyz = band_xyz(ranges);
  bands.efficacy_ = kSpectralEfficacy * xyz.row(1).transpose().array();
  balance_white(xyz, ranges);
  bands.to_rgb_ = (kSpectralEfficacy / kRgbEfficacy) * (xyz_to_rec709() * xyz);
  return bands;
}

WavelengthRange BandSet::range_nm(std::size_t band) const {
  const std::vector<double>& centres = centres_nm_;
  const double centre = centres[band];
  if (centres.size() == 1) return {centre, centre};
  const double below = band > 0 ? centre - centres[band - 1] : centres[1] - centre;
  const double above = band + 1 < centres.size() ? centres[band + 1] - centre : below;
  return {centre - below / 2, centre + above / 2};
}

std::string BandSet::efficacy_statement() const {
  switch (kind_) {
    case BandKind::kGrey:
      return "one grey band, 179 lm/W";
    case BandKind::kRgb:
      return "linear Rec.709 RGB, 179 lm/W x (0.2126, 0.7152, 0.0722)";
    case BandKind::kSpectral:
      break;
  }
  return fmt::format(
      "{} spectral bands {} ... {} nm, 683 lm/W x V(lambda) averaged over each band; colours by "
      "CIE 1931 in linear Rec.709, equal-energy white shown as D65",
      count(), names_.front(), names_.back());
}

Eigen::Array3d BandSet::to_rgb(const Spectrum& value) const {
  return (to_rgb_ * value.matrix()).array();
}

}  // namespace reemit
