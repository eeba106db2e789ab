#pragma once
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "mesh/zones/zone_mesh.h"

namespace reemit::cli {

/// What `info` says of zones that sides share: a line each of small sides and of sealed ones, if there are
/// any. `head_width`: of the column of their heads. `sealed_light`: the part of all light that came to the
/// sealed ones, of a solution.
std::string shared_zones_text(const ZoneMesh& mesh, int head_width, std::optional<double> sealed_light = {});
/// The same as entries of `json`.
void add_shared_zones(nlohmann::ordered_json& json, const ZoneMesh& mesh,
                      std::optional<double> sealed_light = {});

}  // namespace reemit::cli
