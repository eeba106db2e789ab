#pragma once
#include <string>
#include <vector>

#include <Eigen/Core>

namespace reemit {

/// One value per band: reflectance [1], radiance [W/(m2 sr)], power [W], ... in the order of the room's
/// BandSet.
using Spectrum = Eigen::ArrayXd;

/// What the bands of a room are.
enum class BandKind { kGrey, kRgb, kSpectral };

/// A range of wavelengths [nm], from <= to.
struct WavelengthRange {
  double from, to;

  double width() const { return to - from; }
};

/// The bands a room transports: one for a grey room, three (linear Rec.709) for RGB, N for a spectral room.
/// A radiometric value of a band is the power *within* that band, not a density per nanometre.
class BandSet {
 public:
  /// One band, and three of linear Rec.709 [ITU709].
  static BandSet grey();
  static BandSet rgb();
  /// Centres [nm], strictly increasing, at least one; throws std::invalid_argument otherwise.
  static BandSet spectral(std::vector<double> centres_nm);

  BandKind kind() const { return kind_; }
  std::size_t count() const { return names_.size(); }
  /// "grey", "r" "g" "b", or the wavelength in nm as in "550".
  const std::string& name(std::size_t band) const { return names_[band]; }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<double>& centres_nm() const { return centres_nm_; }  ///< Empty unless spectral.
  /// Where a spectral band reaches: half-way to its neighbours; the first and last are symmetric about their
  /// centres, and a lone band has no width.
  WavelengthRange range_nm(std::size_t band) const;

  /// Luminous efficacy of each band [lm/W]: 179 x Rec.709 weights for grey and RGB ([ZIM98] appendix, the
  /// Radiance convention), 683 x the mean of V(lambda) over the band for spectral rooms.
  const Spectrum& efficacy_lm_per_w() const { return efficacy_; }
  /// One line for file headers that states the conversion, and for spectral rooms the white of their colours.
  std::string efficacy_statement() const;

  /// Linear Rec.709 colour of a spectrum, scaled so that its luminance weights give luminance/179.
  /// Equal-energy white is neutral in rooms whose bands cover the visible range. Components may be negative
  /// (colours out of gamut).
  Eigen::Array3d to_rgb(const Spectrum& value) const;

  bool operator==(const BandSet& other) const {
    return kind_ == other.kind_ && centres_nm_ == other.centres_nm_;
  }

 private:
  BandKind kind_ = BandKind::kGrey;
  std::vector<std::string> names_;
  std::vector<double> centres_nm_;
  Spectrum efficacy_;
  Eigen::Matrix3Xd to_rgb_;
};

}  // namespace reemit
