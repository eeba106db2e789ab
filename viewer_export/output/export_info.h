#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scenes/model/bands.h"
#include "scenes/model/scene.h"
#include "solver/solution/solution.h"

namespace reemit {

/// A value of the info: text where it is no number, "not known" too.
using InfoValue = std::variant<std::string, std::uint64_t, double>;

/// What every exported file says about where its numbers come from.
struct ExportInfo {
  std::string program_version;
  std::string room;        ///< Name or path of the room file.
  std::string room_hash;   ///< content_hash of the room.
  std::uint64_t seed = 0;  ///< Of the zone solution.
  std::string stopped;     ///< Why the solve ended, in words; empty where no zone was read.
  double error = 0;        ///< Relative standard error of the exported values, as a fraction; 0 = not known.
  /// False where the solution has one batch alone, whose error nobody knows: what the spread of gathers says
  /// is not all of it then.
  bool error_is_known = true;
  /// What the zones add to that; nothing if it is not known.
  std::optional<ZoneBias> zones = std::nullopt;
  /// Further settings worth keeping, in the order they are written: {"gather rays", 256}.
  std::vector<std::pair<std::string, InfoValue>> settings;
};

/// Says of which solution and room something is.
void state_origin(const Scene& scene, const Solution& solution, ExportInfo& info);

/// ExportInfo::error; +infinity if it is not known, which JSON shows as null.
double known_error(const ExportInfo& info);

/// The text with control characters replaced by spaces: a line break would end a comment of a file header
/// early.
std::string one_line(std::string text);

/// The info as {name, value} pairs for metadata that knows numbers: program, room, units, efficacy, seed,
/// error, settings. Texts are one line each: line breaks inside become spaces.
std::vector<std::pair<std::string, InfoValue>> describe_values(const ExportInfo& info, const BandSet& bands);

/// The same as text, for headers.
std::vector<std::pair<std::string, std::string>> describe(const ExportInfo& info, const BandSet& bands);

}  // namespace reemit
