#pragma once
#include <optional>
#include <string>

#include "scenes/io/common/spectral_bands.h"

namespace reemit {

/// cd/m2, W/(sr m2), or what the program that wrote the file is known to write.
enum class EmissiveUnits { kByGenerator, kCandela, kWatt };

/// What a file format leaves open.
struct ReadOptions {
  /// Unit of glTF emissiveFactor x emissive strength. The specification says cd/m2; exporters disagree.
  EmissiveUnits gltf_emissive_units = EmissiveUnits::kByGenerator;
  bool force_two_sided = false;  ///< Treat every face as reflecting on both sides (rooms with mixed winding).
  /// Luminous efficacy by which the cd and lx of glTF lamps become watts [lm/W], finite and above 0. Nothing:
  /// by the program that wrote the file (docs/gltf_input.md).
  std::optional<double> gltf_light_efficacy;
  /// Sky and sun in place of those of the file, as the options --sky and --sun have them (docs/sky.md);
  /// empty: those of the file.
  std::string sky{};
  std::string sun{};

  /// Bands for a room of colours (docs/spectral.md); if not given, those of the file.
  SpectralBands bands;

  bool operator==(const ReadOptions&) const = default;
};

}  // namespace reemit
