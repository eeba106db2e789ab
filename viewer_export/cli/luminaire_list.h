#pragma once
#include <string>
#include <vector>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit::cli {

/// One luminaire as `info` lists it.
struct LuminaireRow {
  std::string name;
  std::string kind;  ///< "surface", "point", "spot", "directional" or "ies".
  double area = 0;   ///< Emitting area, both sides if both emit [m2]; 0 for those without area.
  Spectrum power;    ///< [W] per band; size 0 for directional light, whose power depends on the room.
  Spectrum power_per_area{};  ///< Exitance of a surface or irradiance across a beam [W/m2]; else size 0.
};

/// Emissive surfaces in the order of the room, then lights without area.
std::vector<LuminaireRow> list_luminaires(const Scene& scene, const MeshReport& report);

/// Luminous flux [lm] of a power per band.
double lumens(const Spectrum& power, const BandSet& bands);

}  // namespace reemit::cli
