#pragma once
#include <optional>
#include <string_view>

namespace tinyobj {
struct material_t;
}

namespace reemit {

/// What a room that was read by Blender's conventions says of it.
inline constexpr const char* kBlenderNote =
    "Blender wrote it: Ks, its Specular, is no share of the light, and what dielectrics reflect (4 %) counts "
    "as diffuse, as in glTF; illum 3 is metal of the colour Kd, as rough as Ns says";

/// Whether Blender wrote a MTL file, by the comment in its first line.
bool is_written_by_blender(std::string_view mtl);

/// Turns what Blender writes of its Principled BSDF into what the statements of a MTL file mean. Ks is the
/// factor Specular (0.5: 4 % at normal incidence) and no reflectance: read as one, it makes walls of 0.8
/// absorb nothing. It is taken out. Metals (illum 3) have their colour in Kd and their share in Ka: that
/// share of Kd goes to Ks. Returns their roughness alpha = r^2 of GGX [0,1], of Blender's roughness r, for Ns
/// = 1000 (1 - r)^2 (versions 2.8 wrote 900 (1 - r)^2: by that r is up to 0.05 too large); nothing if it is
/// no metal. A metal with map_Kd keeps its colour as paint.
std::optional<double> read_as_written_by_blender(tinyobj::material_t& material);

}  // namespace reemit
