#pragma once
#include <array>
#include <string_view>

namespace reemit {

/// How one luminaire among many is chosen for a shading point: the weights alpha_i of [SWZ96, sec. 4].
enum class Selection {
  kConstant,  ///< alpha_i = 1/N [SWZ96, sec. 4.1].
  kLinear,    ///< alpha_i proportional to the unoccluded irradiance; looks at every luminaire [SWZ96,
              ///< sec. 4.2].
  kSpatial,   ///< A walk down a tree over the luminaires: the purpose of [SWZ96, sec. 4.3], built as in
              ///< [CON18].
};

/// Names for the command line, in the order of the enumeration.
inline constexpr std::array<std::string_view, 3> kSelectionNames = {"constant", "linear", "spatial"};

constexpr std::string_view name_of(Selection selection) {
  return kSelectionNames[static_cast<std::size_t>(selection)];
}

}  // namespace reemit
