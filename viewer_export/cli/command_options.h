#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "scenes/io/common/spectral_bands.h"
#include "scenes/io/native/sky_option.h"
#include "scenes/io/scene_reader.h"
#include "viewer_export/cli/option_values.h"

namespace reemit::cli {

/// Options that most subcommands share.
struct OutputStyle {
  bool json = false;     ///< Results on stdout as one JSON document.
  bool quiet = false;    ///< Neither progress nor warnings.
  bool verbose = false;  ///< Progress lines even where stderr is not a terminal.
};

inline void add_progress_options(CLI::App& command, OutputStyle& style) {
  auto* quiet = command.add_flag("--quiet,-q", style.quiet, "No progress, notes or warnings on stderr");
  command.add_flag("--verbose,-v", style.verbose, "Progress lines on stderr even if it is not a terminal")
      ->excludes(quiet);
}

inline void add_json_option(CLI::App& command, OutputStyle& style) {
  command.add_flag("--json", style.json, "Print the result as one JSON document");
}

/// Type of options that take a point, as `--help` shows it.
inline constexpr const char* kPointType = "X,Y,Z";

/// An option whose text `parse` turns into the value; its std::invalid_argument becomes a usage error.
template <class Target, class Parse>
CLI::Option* add_parsed_option(CLI::App& command, const std::string& names, Target& target, Parse parse,
                               const std::string& type, const std::string& help) {
  const std::function<void(const std::string&)> read = [&target, parse, names](const std::string& text) {
    try {
      target = parse(text);
    } catch (const std::invalid_argument& problem) {
      throw CLI::ValidationError(names, problem.what());
    }
  };
  return command.add_option_function(names, read, help)->type_name(type);
}

/// Words of an option and what they stand for, in the order of the help; the first is the default.
template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// An option that takes one of a few words. `target` is set to the first choice.
template <class Value>
CLI::Option* add_choice_option(CLI::App& command, const std::string& names, Value& target,
                               const Choices<Value>& choices, const std::string& help) {
  std::string words;
  for (const auto& [word, value] : choices) words += (words.empty() ? "" : "|") + word;
  const auto parse = [choices, words](const std::string& text) {
    for (const auto& [word, value] : choices) {
      if (word == text) return value;
    }
    throw std::invalid_argument("'" + text + "' is not one of " + words);
  };
  target = choices.front().second;
  return add_parsed_option(command, names, target, parse, words, help)->default_str(choices.front().first);
}

/// An option that takes a whole number in [least, most]; its value on entry is the default.
template <class Integer>
CLI::Option* add_integer_option(CLI::App& command, const std::string& names, Integer& target, Integer least,
                                Integer most, const std::string& help) {
  const auto parse = [least, most](const std::string& text) {
    return static_cast<Integer>(
        parse_integer(text, static_cast<std::uint64_t>(least), static_cast<std::uint64_t>(most)));
  };
  return add_parsed_option(command, names, target, parse, "N", help)->default_str(std::to_string(target));
}

inline void add_seed_and_threads(CLI::App& command, std::uint64_t& seed, int& threads) {
  add_integer_option(command, "--seed", seed, std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max(),
                     "Seed; the same seed gives the same bits on any number of threads");
  add_integer_option(command, "--threads", threads, 0, 1024, "Threads; 0 = all cores");
}

/// What the formats of rooms leave open.
inline void add_read_options(CLI::App& command, ReadOptions& options) {
  add_parsed_option(command, "--bands", options.bands, parse_spectral_bands, "FIRST:LAST:STEP",
                    "Solve a room of colours in these spectral bands [nm], as 400:700:10: colours\n"
                    "become smooth spectra (docs/spectral.md)");
  add_choice_option<EmissiveUnits>(
      command, "--emissive-units", options.gltf_emissive_units,
      {{"auto", EmissiveUnits::kByGenerator},
       {"cd/m2", EmissiveUnits::kCandela},
       {"W/sr/m2", EmissiveUnits::kWatt}},
      "Unit of emissive factors in glTF; auto: W/sr/m2 if Blender wrote the file, else cd/m2");
  add_parsed_option(command, "--gltf-light-efficacy", options.gltf_light_efficacy, parse_positive, "LM/W",
                    "Luminous efficacy that turns cd and lx of glTF lamps into watts [lm/W] (default: 683\n"
                    "if Blender wrote the file, none if it was one before 3.4, else 179)");
}

/// What stands around the room, where its file does not say it.
inline void add_sky_options(CLI::App& command, ReadOptions& options) {
  const auto parse_sky = [](const std::string& text) { return with_absolute_path(parse_word(text)); };
  add_parsed_option(command, "--sky", options.sky, parse_sky, "SKY",
                    "Sky around the room, in place of that of its file: uniform:10000lx, overcast:10000lx,\n"
                    "clear:20000lx (with --sun), cie7:15000lx, perez:15000lx,direct=600,diffuse=120 or\n"
                    "image:FILE; then ,ground=0.2,up=z,north=0/1/0,color=1/1/1,scale=1,rotation=0. Lux on a\n"
                    "horizontal plane outside, without the sun");
  add_parsed_option(command, "--sun", options.sun, parse_word, "SUN",
                    "Sun: altitude=40,azimuth=180,lx=80000 or latitude=48.2,longitude=16.4,\n"
                    "time=2024-06-21T12:00+02:00,lx=80000. Degrees, azimuth from north towards east; lux\n"
                    "across the beam; without lx it only says where the sun stands");
}

inline CLI::Option* add_room_option(CLI::App& command, std::vector<std::filesystem::path>& room) {
  return command
      .add_option("--room", room,
                  "Room file, if it is no longer where it was solved from; of a room of several\n"
                  "files give all, in order, each with its own --room")
      ->type_name("ROOM")
      ->allow_extra_args(false);
}

}  // namespace reemit::cli
