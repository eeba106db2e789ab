#pragma once
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "solver/solution/zone_bias.h"

namespace reemit::cli {

/// "1.2 %", "below 0.8 %" where noise hides it, "none", or "not known".
std::string zones_text(const std::optional<ZoneBias>& zones);

/// Appends the members "zone_error", the best estimate, and "zone_error_bound"; null where they are not
/// known.
void add_zones(nlohmann::ordered_json& json, const std::optional<ZoneBias>& zones);

/// What to say where an error target was missed because of the noise of the zone solution.
inline constexpr const char* kZonesTooNoisy =
    "the noise of the zone solution keeps the error above the target; solve to a lower --error";

/// The same where all that is known is that samples did not lessen the error.
inline constexpr const char* kSamplesDoNotHelp =
    "more samples hardly lessen the error, which stays above the target: most of it is the noise of the zone "
    "solution (solve to a lower --error), or few samples bring much of the light (give their number)";

/// What to say where a path-traced still misses its target: rare samples carry much of the light.
inline constexpr const char* kPathsTooNoisy =
    "more samples hardly lessen the error, as a few of them bring much of the light, and what is stated may "
    "be too little; give it more --spp, or gather (--integrator gather), which needs far fewer";

/// The same where light over mirrors and glass may be the cause.
inline constexpr const char* kPhotonsTooNoisy =
    "the noise of light over mirrors and glass, or of the zone solution, keeps the error above the target; "
    "means of several points have less of the first, solving to a lower --error takes off the second";

/// Says so, and what helps, where the zones alone miss an error target > 0; empty where they do not or it is
/// not known. `what`: whose target, "the picture".
std::string missed_by_zones(const std::string& what, double target, const std::optional<ZoneBias>& zones);

}  // namespace reemit::cli
