#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// What a zone is made of.
enum class ZoneKind : std::uint8_t {
  kCell,    ///< A cell of one side of a base triangle.
  kShared,  ///< A group of small sides.
  kSealed,  ///< A group of sides that no light reaches.
};
inline constexpr ZoneKind kZoneKinds[] = {ZoneKind::kCell, ZoneKind::kShared, ZoneKind::kSealed};

/// Of a zone, and what it is called in lists and JSON.
ZoneKind kind_of(const ZoneMesh& mesh, ZoneId zone);
const char* name_of(ZoneKind kind);

/// How large zones of one kind are.
struct ZoneSizes {
  std::size_t count = 0;
  double smallest = 0;  ///< [m2], as the others; 0 if there are none.
  double median = 0;
  double largest = 0;
};

/// The median of an even number of zones is the larger of the two in the middle.
ZoneSizes zone_sizes(const ZoneMesh& mesh, ZoneKind kind);

}  // namespace reemit
