#pragma once
#include <string>

#include "scenes/io/common/read_options.h"

namespace reemit {

/// What the numbers of a glTF file mean. The specification says cd, lx and cd/m2; the exporter of Blender
/// [GLB22] turns the watts of lamps into these with 683 lm/W (since its version 3.4) or not at all
/// (before), and writes the strength of emissive meshes, W/(sr m2), as it is.
struct GltfUnits {
  double light_efficacy = 0;     ///< Of lamps [lm/W]: W/sr = cd / this, W/m2 = lx / this. Above 0.
  bool lamps_in_watts = false;   ///< Points and spots hold W of a full sphere, the sun W/m2; no efficacy.
  double emissive_efficacy = 0;  ///< Of emissive meshes [lm/W]; 0: their values are W/(sr m2).
  bool by_blender = false;       ///< Its exporter wrote the file.
  std::string lamp_assumption;   ///< In words, for the notes of the room.
  std::string emissive_assumption;
  /// The program that rewrote the file and took the name of the exporter out, if that leaves units open.
  std::string rewritten_by;
  bool lamps_open = false, emission_open = false;  ///< What it leaves open.

  /// Factor from the strength of a point or spot light to W/sr.
  double watts_per_sr() const;
  /// Factor from the strength of a directional light to W/m2.
  double watts_per_m2() const;
  /// Factor from emissive values to W/(sr m2).
  double radiance() const { return emissive_efficacy > 0 ? 1 / emissive_efficacy : 1; }
};

/// Units by `generator` (asset.generator of the file) where `options` leave them open.
GltfUnits gltf_units(const std::string& generator, const ReadOptions& options);

/// Luminous efficacy that turns photometric values into radiometric ones where nothing else is known [lm/W];
/// see BandSet.
inline constexpr double kGltfEfficacy = 179;

}  // namespace reemit
