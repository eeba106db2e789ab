#pragma once
#include <memory>
#include <string>
#include <vector>

#include "scenes/model/photometry.h"

namespace reemit {

/// The grid of an LM-63 file as it stands there.
struct IesGrid {
  PhotometricType type = PhotometricType::kC;
  std::vector<double> vertical;    ///< [degree]
  std::vector<double> horizontal;  ///< [degree]
  std::vector<double> candela;     ///< candela[horizontal * vertical.size() + vertical]
};

/// What is wrong with the vertical or horizontal angles, and what they should be; both empty if they can be
/// read for the type of photometry.
struct IesComplaint {
  std::string problem, advice;
};
/// Pre of both: the grid has an angle.
IesComplaint check_vertical_angles(const IesGrid& grid);
IesComplaint check_horizontal_angles(const IesGrid& grid);

/// Intensities below 0 by no more than 1 % of the largest, as goniometers note them where there is no light,
/// become 0, with a warning that begins with `where`.
void clear_noise(std::vector<double>& intensities, const std::string& where,
                 std::vector<std::string>& warnings);

/// Unfolds the symmetry of the horizontal angles and brings the grid to polar angle and azimuth. The values
/// are copied, not resampled: mirrored grid lines of a bilinear function give the mirrored function. Adds to
/// the warnings, which name `file`, where the last plane is missing or angles cover less than any range that
/// LM-63 knows. Throws InputError, which says `where`, if there is no flux.
std::shared_ptr<const IntensityTable> table_of(const IesGrid& grid, const std::string& where,
                                               const std::string& file, std::vector<std::string>& warnings);

}  // namespace reemit
