#include "scenes/io/photometry/measured_luminaire.h"

#include "scenes/io/common/text_parse.h"
#include "scenes/io/photometry/eulumdat_reader.h"
#include "scenes/io/photometry/ies_reader.h"

namespace reemit {

MeasuredLuminaire read_luminaire_file(const std::filesystem::path& file) {
  return lower_case_extension(file) == ".ldt" ? read_eulumdat_file(file) : read_ies_file(file);
}

const MeasuredLuminaire& LuminaireLibrary::load(const std::filesystem::path& file,
                                                std::vector<std::string>& warnings,
                                                std::vector<std::string>& notes) {
  std::error_code error;
  std::filesystem::path key = std::filesystem::canonical(file, error);
  if (error) key = file;
  const auto known = files_.find(key);
  if (known != files_.end()) return known->second;
  const MeasuredLuminaire& loaded = files_.emplace(key, read_luminaire_file(file)).first->second;
  warnings.insert(warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
  notes.insert(notes.end(), loaded.notes.begin(), loaded.notes.end());
  return loaded;
}

}  // namespace reemit
