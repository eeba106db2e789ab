#include "mesh/model/changed_faces.h"

#include <algorithm>
#include <tuple>

namespace reemit {

void tidy(std::vector<ChangedFace>& changes) {
  std::sort(changes.begin(), changes.end());
  changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
  changes.shrink_to_fit();
}

std::span<const ChangedFace> changes_of(std::span<const ChangedFace> changes, SurfaceId surface,
                                        std::uint32_t face) {
  const auto place = [](const ChangedFace& c) { return std::tuple(c.surface, c.face); };
  const std::tuple wanted(surface, face);
  return {std::ranges::lower_bound(changes, wanted, {}, place),
          std::ranges::upper_bound(changes, wanted, {}, place)};
}

}  // namespace reemit
