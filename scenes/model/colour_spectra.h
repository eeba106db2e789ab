#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "scenes/model/upsampling.h"

namespace reemit {

/// Spectra for the colours of images, one for every texel that is looked at: mixed from those that Upsampling
/// finds for a lattice of colours. Within a cell of the lattice, spectra are mixed in the proportions in
/// which the colours at the corners of one of its six tetrahedra along the grey diagonal make the colour
/// [KNPH95]. So colours are as exact as Upsampling's, spectra stay in [0,1] and greys constant. Does not
/// change once it is made.
class ColourSpectra {
 public:
  /// Colours are those of reflectances in the light of `upsampling`, of a room with `bands` bands. A room of
  /// one band gets their luminance.
  ColourSpectra(const Upsampling& upsampling, std::size_t bands);
  /// For images that count by their Rec.709 luminance, as in grey rooms: the same in every band.
  static ColourSpectra by_luminance(std::size_t bands) { return ColourSpectra(bands); }

  std::size_t band_count() const { return bands_; }

  /// The spectrum [0,1] of a linear Rec.709 colour, whose components are brought to [0,1].
  /// values: band_count() numbers.
  void values(const std::array<float, 3>& rgb, std::span<float> values) const;

  /// At most so much, over the largest component of the colour, do its spectra miss it (Upsampled): more than
  /// rounding only where the bands are too few.
  double deviation(const std::array<float, 3>& rgb) const;

 private:
  static constexpr std::size_t kSteps = 8;  ///< Of the lattice from 0 to 1.

  /// The corners of the tetrahedron that a colour lies in, and their shares.
  struct Mixture {
    std::array<std::size_t, 4> corner;
    std::array<float, 4> share;
  };

  explicit ColourSpectra(std::size_t bands) : bands_(bands) {}
  static Mixture mixture(const std::array<float, 3>& rgb);

  std::size_t bands_;
  std::vector<float> spectra_;  ///< [corner * bands + band]; empty: by luminance.
  std::vector<float> misses_;   ///< Of the largest component, by corner.
};

}  // namespace reemit
