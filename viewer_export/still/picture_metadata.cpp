#include "viewer_export/still/picture_metadata.h"

#include <algorithm>

namespace reemit {

std::vector<std::pair<std::string, std::string>> metadata_of(const StillImage& image) {
  std::vector<std::pair<std::string, std::string>> metadata{
      {"Software", "reemit " + image.info.program_version}};
  for (auto [name, value] : describe(image.info, image.bands)) {
    std::replace(name.begin(), name.end(), ' ', '_');
    metadata.emplace_back("reemit:" + name, value);
  }
  return metadata;
}

}  // namespace reemit
