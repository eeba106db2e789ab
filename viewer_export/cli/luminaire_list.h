#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"
#include "solver/solution/solution.h"

namespace reemit::cli {

/// One luminaire as `info` lists it.
struct LuminaireRow {
  std::string name;
  std::string kind;  ///< "surface", "point", "spot", "directional", "ies", a kind of sky or "sun".
  double area = 0;   ///< Emitting area, both sides if both emit [m2]; 0 for those without area.
  Spectrum power;    ///< [W] per band; size 0 for directional light, whose power depends on the room.
  Spectrum power_per_area{};  ///< Exitance of a surface or irradiance across a beam [W/m2]; else size 0.
};

/// Emissive surfaces in the order of the room, then lights without area. Textures count where they lie,
/// cut-outs by what is there of them.
std::vector<LuminaireRow> list_luminaires(const Scene& scene, const MeshResult& meshed);
/// The same of a room that has been solved, by the zones of its solution.
std::vector<LuminaireRow> list_luminaires(const Scene& scene, const Solution& solution);

/// The emissive surfaces of a solution, for when its room cannot be read: lights without area are not in it.
std::vector<LuminaireRow> list_luminous_surfaces(const Solution& solution);

/// The rows as a table: power [W] per band and luminous flux [lm], with totals.
std::string luminaires_text(const std::vector<LuminaireRow>& rows, const BandSet& bands);
/// Sets "luminaires", "total_power_W" and "total_flux_lm" (docs/command_line.md).
void add_luminaires(nlohmann::ordered_json& json, const std::vector<LuminaireRow>& rows,
                    const BandSet& bands);

/// Luminous flux [lm] of a power per band.
double lumens(const Spectrum& power, const BandSet& bands);

}  // namespace reemit::cli
