#pragma once
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "solver/solution/solution.h"
#include "viewer_export/cli/luminaire_list.h"

namespace reemit::cli {

/// Under a sky: what falls on a horizontal plane outside [lx].
struct LightOutside {
  double sky_lx = 0;
  double sun_lx = 0;
};

/// Illuminance, exitance, area and flux of every surface and material of a solution with their standard
/// errors, and what its luminaires send: three tables for people. Under a sky with daylight factors.
std::string light_text(const Solution& solution, const std::vector<LuminaireRow>& luminaires,
                       const std::optional<LightOutside>& outside = std::nullopt);

/// Sets "surfaces", "materials", "luminaires" and what belongs to them in the document of `info --json`
/// (docs/command_line.md).
void add_light(nlohmann::ordered_json& json, const Solution& solution,
               const std::vector<LuminaireRow>& luminaires,
               const std::optional<LightOutside>& outside = std::nullopt);

}  // namespace reemit::cli
