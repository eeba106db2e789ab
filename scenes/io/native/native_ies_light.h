#pragma once
#include <filesystem>
#include <string>

#include "scenes/io/common/json_cursor.h"
#include "scenes/io/photometry/measured_luminaire.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads lights of type "ies" (docs/room_format.md). One object per room, so that luminaires of one file
/// share their intensities. Where a file does not aim one it shines down, as cameras and sky that are read
/// already say (up_direction).
class NativeIesLights {
 public:
  /// `folder` of the room file; `unit`: metres per unit of length.
  NativeIesLights(std::filesystem::path folder, double unit, Scene& scene)
      : folder_(std::move(folder)), unit_(unit), scene_(scene) {}

  PhotometricLight read(const JsonCursor& at, const std::string& name);

 private:
  std::filesystem::path folder_;
  double unit_;
  Scene& scene_;
  LuminaireLibrary library_;
};

}  // namespace reemit
