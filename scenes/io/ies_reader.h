#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenes/model/photometry.h"

namespace reemit {

/// What an IES LM-63 file says about a luminaire, in SI units, with all its factors applied [LM63].
struct IesLuminaire {
  std::string name;  ///< Keyword LUMINAIRE or LUMCAT, else the first label line, else the name of the file.
  std::shared_ptr<const IntensityTable> table;  ///< Never null.
  LuminousOpening opening;
  double lamp_lumens = 0;             ///< Of all lamps after the ballast factor [lm]; 0: absolute photometry.
  std::vector<std::string> warnings;  ///< Each begins with file or file:line.
  std::vector<std::string> notes;     ///< Conversions that were applied.
};

/// Reads LM-63-1986, 1991, 1995, 2002 and 2019 files (docs/ies.md). Throws InputError with file and line.
IesLuminaire read_ies_file(const std::filesystem::path& file);

/// Files of a room, each read once, so that lights of one kind share their table. Warnings and notes of a
/// file come once.
class IesLibrary {
 public:
  /// Throws InputError as read_ies_file.
  const IesLuminaire& load(const std::filesystem::path& file, std::vector<std::string>& warnings,
                           std::vector<std::string>& notes);

 private:
  std::map<std::filesystem::path, IesLuminaire> files_;
};

}  // namespace reemit
