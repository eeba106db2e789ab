#include "viewer_export/inspection/zone_sizes.h"

#include <algorithm>

namespace reemit {

ZoneKind kind_of(const ZoneMesh& mesh, ZoneId zone) {
  if (!mesh.is_group(zone)) return ZoneKind::kCell;
  return mesh.is_sealed(zone) ? ZoneKind::kSealed : ZoneKind::kShared;
}

const char* name_of(ZoneKind kind) {
  switch (kind) {
    case ZoneKind::kCell:
      return "cells";
    case ZoneKind::kShared:
      return "groups of sides";
    case ZoneKind::kSealed:
      break;
  }
  return "sealed sides";
}

ZoneSizes zone_sizes(const ZoneMesh& mesh, ZoneKind kind) {
  std::vector<double> areas;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z)
    if (kind_of(mesh, ZoneId(z)) == kind) areas.push_back(mesh.zone_area(ZoneId(z)));
  if (areas.empty()) return {};
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  const double median = *middle;
  const auto [smallest, largest] = std::minmax_element(areas.begin(), areas.end());
  return {areas.size(), *smallest, median, *largest};
}

}  // namespace reemit
