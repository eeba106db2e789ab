#pragma once
#include <filesystem>
#include <vector>

#include "scenes/model/photometry.h"

namespace reemit::hit_paths {

/// Luminous intensities by angle, looked up apart from what the solver uses: angles in degrees, symmetries
/// folded when asked rather than unfolded when read.
class Photometry {
 public:
  /// The numbers of a table as the program read them.
  explicit Photometry(const IntensityTable& table);
  /// An IES file, by a reader of its own: LM-63 of any edition with TILT=NONE and type C; and the opening in
  /// metres. Throws std::invalid_argument for others.
  explicit Photometry(const std::filesystem::path& file);

  /// Intensity [cd] in a direction of any length above 0, in luminaire coordinates (photometry.h).
  double candela(const Vec3& direction) const;
  /// Sizes along C = 0, C = 90 and up [m] as the file states them, of a table 0.
  const Vec3& size() const { return size_; }

 private:
  PhotometricType type_ = PhotometricType::kC;
  std::vector<double> vertical_, horizontal_;  // [deg]; of the poles of the type
  std::vector<double> candela_;                // [horizontal * count of vertical + vertical]
  bool folded_ = false;  // planes stand for those that the symmetry of the file makes of them
  Vec3 size_ = Vec3::Zero();
};

}  // namespace reemit::hit_paths
