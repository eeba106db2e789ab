#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/model/bands.h"
#include "solver/tally/zone_bias.h"

namespace reemit {

/// What every exported file says about where its numbers come from.
struct ExportInfo {
  std::string program_version;
  std::string room;        ///< Name or path of the room file.
  std::string room_hash;   ///< content_hash of the room.
  std::uint64_t seed = 0;  ///< Of the zone solution.
  double error = 0;        ///< Relative standard error of the exported values, as a fraction; 0 = not known.
  /// What the zones add to that; nothing if it is not known.
  std::optional<ZoneBias> zones = std::nullopt;
  /// Further settings worth keeping, in the order they are written: {"gather rays", "256"}.
  std::vector<std::pair<std::string, std::string>> settings;
};

/// The text with control characters replaced by spaces: a line break would end a comment of a file header
/// early.
std::string one_line(std::string text);

/// The info as {name, value} pairs for headers and metadata: program, room, units, efficacy, seed, error,
/// settings. Values are one line each: line breaks inside become spaces.
std::vector<std::pair<std::string, std::string>> describe(const ExportInfo& info, const BandSet& bands);

}  // namespace reemit
