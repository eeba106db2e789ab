#include "scenes/io/gltf/gltf_units.h"

#include <charconv>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace reemit {
namespace {

/// Version of Blender's exporter, {0, 0} where the generator is one of its forerunners without a number;
/// nothing if another program wrote the file.
std::optional<std::pair<int, int>> blender_version(std::string_view generator) {
  if (generator.find("Blender") == std::string_view::npos || generator.find("glTF") == std::string_view::npos)
    return std::nullopt;
  std::pair<int, int> version{0, 0};
  constexpr std::string_view kMark = "I/O v";
  const auto mark = generator.find(kMark);
  if (mark == std::string_view::npos) return version;
  const char* const end = generator.data() + generator.size();
  const auto major = std::from_chars(generator.data() + mark + kMark.size(), end, version.first);
  if (major.ec == std::errc() && major.ptr != end && *major.ptr == '.')
    std::from_chars(major.ptr + 1, end, version.second);
  return version;
}

/// The name of a program that compresses or rearranges files of others, and keeps their numbers but not the
/// name of who made them; empty for others.
std::string rewriter(std::string_view generator) {
  for (const char* name : {"glTF-Transform", "gltfpack", "gltf-pipeline", "meshoptimizer"})
    if (generator.find(name) != std::string_view::npos) return name;
  return "";
}

/// What Blender's exporter multiplies watts by, from this version on, in its lighting mode "Standard".
constexpr double kBlenderEfficacy = 683;
constexpr std::pair kFirstWithEfficacy{3, 4};

}  // namespace

double GltfUnits::watts_per_sr() const {
  return lamps_in_watts ? 1 / (4 * std::numbers::pi) : 1 / light_efficacy;
}

double GltfUnits::watts_per_m2() const {
  return lamps_in_watts ? 1 : 1 / light_efficacy;
}

GltfUnits gltf_units(const std::string& generator, const ReadOptions& options) {
  const auto blender = blender_version(generator);
  const std::string by_blender = fmt::format("the file was written by Blender (\"{}\")", generator);
  GltfUnits units;
  units.by_blender = blender.has_value();
  units.rewritten_by = rewriter(generator);
  units.lamps_open = !units.rewritten_by.empty() && !options.gltf_light_efficacy;
  units.emission_open =
      !units.rewritten_by.empty() && options.gltf_emissive_units == EmissiveUnits::kByGenerator;
  units.light_efficacy = kGltfEfficacy;
  if (options.gltf_light_efficacy) {
    units.light_efficacy = *options.gltf_light_efficacy;
    units.lamp_assumption =
        fmt::format("as cd and lx and divided by the {:g} lm/W that were asked for", units.light_efficacy);
  } else if (blender && *blender >= kFirstWithEfficacy) {
    units.light_efficacy = kBlenderEfficacy;
    units.lamp_assumption = fmt::format(
        "as cd and lx and divided by {:g} lm/W, because {}, which makes them from watts with this number "
        "unless its lighting mode is not \"Standard\"; --gltf-light-efficacy says otherwise",
        kBlenderEfficacy, by_blender);
  } else if (blender) {
    units.lamps_in_watts = true;
    units.lamp_assumption = fmt::format(
        "as W of a full sphere (point, spot) and W/m2 (directional), because {}, which before version 3.4 "
        "did "
        "not convert them; --gltf-light-efficacy says otherwise",
        by_blender);
  } else {
    units.lamp_assumption = fmt::format(
        "as cd and lx and divided by {:g} lm/W; --gltf-light-efficacy says otherwise", kGltfEfficacy);
  }

  EmissiveUnits emissive = options.gltf_emissive_units;
  std::string why = "as was asked for";
  if (emissive == EmissiveUnits::kByGenerator) {
    emissive = blender ? EmissiveUnits::kWatt : EmissiveUnits::kCandela;
    why = blender ? fmt::format("because {}, which writes the strength of emission as it is", by_blender)
                  : "as the specification says";
    why += "; --emissive-units says otherwise";
  }
  if (emissive == EmissiveUnits::kCandela) units.emissive_efficacy = kGltfEfficacy;
  units.emissive_assumption = emissive == EmissiveUnits::kCandela
                                  ? fmt::format("as cd/m2 and divided by {:g} lm/W, {}", kGltfEfficacy, why)
                                  : fmt::format("as W/(sr m2), {}", why);
  return units;
}

}  // namespace reemit
