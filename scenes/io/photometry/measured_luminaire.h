#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenes/model/photometry.h"

namespace reemit {

/// Of a table, in either direction.
inline constexpr int kMostAngles = 10'000;

/// What a photometric file says about a luminaire, in SI units, with all its factors applied.
struct MeasuredLuminaire {
  std::string name;
  std::shared_ptr<const IntensityTable> table;  ///< Never null.
  LuminousOpening opening;
  double lamp_lumens = 0;             ///< Of all lamps [lm]; 0: absolute photometry.
  std::vector<std::string> warnings;  ///< Each begins with file or file:line.
  std::vector<std::string> notes;     ///< Conversions that were applied.
};

/// Reads EULUMDAT if the file name ends in .ldt, case ignored, else IES LM-63. Throws InputError with file
/// and line.
MeasuredLuminaire read_luminaire_file(const std::filesystem::path& file);

/// Files of a room, each read once, so that lights of one kind share their table. Warnings and notes of a
/// file come once.
class LuminaireLibrary {
 public:
  /// Throws InputError as read_luminaire_file.
  const MeasuredLuminaire& load(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                std::vector<std::string>& notes);

 private:
  std::map<std::filesystem::path, MeasuredLuminaire> files_;
};

}  // namespace reemit
