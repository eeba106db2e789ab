#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/io/common/json_cursor.h"
#include "scenes/model/scene.h"

namespace reemit {

/// A spectrum of reflectances [0,1]: a number, one number per band, {"rgb": [r, g, b]}, {"srgb": "#rrggbb"}
/// or
/// {"nm", "value"};
/// see docs/room_format.md. Sampled spectra are averaged over each band, which needs a spectral room.
Spectrum read_reflectance(const JsonCursor& at, const BandSet& bands);

/// A spectrum of eta or k of a metal, 0 to 100.
Spectrum read_optical_constant(const JsonCursor& at, const BandSet& bands);

/// A spectrum of non-negative emission. Sampled spectra are densities per nm and are integrated over each
/// band.
Spectrum read_emission(const JsonCursor& at, const BandSet& bands);

/// The emission whose photometric value is `photometric` [cd/m2, cd, lm, lx] with the relative colour in
/// `colour` (equal in all bands when absent), by the efficacies of the bands.
Spectrum photometric_emission(double photometric, const std::optional<JsonCursor>& colour,
                              const BandSet& bands);

/// The materials of a room file.
class NativeMaterials {
 public:
  /// Reads the object of materials and appends them to `scene`. Scene::bands must be set. `folder`: that of
  /// the room file, where textures are looked for.
  NativeMaterials(const JsonCursor& materials, const std::filesystem::path& folder, Scene& scene);

  /// The material that a string names.
  MaterialId find(const JsonCursor& name) const;
  /// Appends a material that came with a referenced file; its name is made unique.
  MaterialId import(Material material, Scene& scene);

  /// Turns total powers and fluxes into radiances, once all surfaces are known:
  /// L = Phi / (pi A), A the area of all emitting sides of the material. Throws InputError if there is none.
  void share_total_powers(Scene& scene) const;

 private:
  struct TotalPower {
    JsonCursor at;
    MaterialId material;
    Spectrum power;  // [W] per band.
  };
  /// The radiance and lobe of a material, of which all but the emission is read; what needs the area of its
  /// surfaces is put down for later.
  void read_emission_of(const JsonCursor& at, MaterialId id, const BandSet& bands, Material& material);

  std::map<std::string, MaterialId> ids_;
  std::vector<TotalPower> totals_;
};

}  // namespace reemit
