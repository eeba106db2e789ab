#pragma once
#include <optional>
#include <string_view>

namespace tinyobj {
struct material_t;
}

namespace reemit {

/// Of Blender's exporters of OBJ files: the one in Python (2.8 to 3.2) and the one in C++ (since 3.1). They
/// differ in how they write the roughness.
enum class BlenderExporter { kPython, kCpp };

/// What a room that was read by these conventions says of it.
inline constexpr const char* kBlenderNote =
    "Blender wrote it: Ks, its Specular, is no share of the light, and what dielectrics reflect (4 %) counts "
    "as "
    "diffuse, as in glTF; illum 3 is metal of the colour Kd, as rough as Ns says";

/// Which of them wrote a MTL file, by the comment at its beginning; none if it was another program.
std::optional<BlenderExporter> blender_exporter_of(std::string_view mtl);

/// Turns what Blender writes of its Principled BSDF into what the statements of a MTL file mean. Ks is the
/// factor Specular (0.5: 4 % at normal incidence) and no reflectance: read as one, it makes walls of 0.8
/// absorb nothing. It is taken out. Metals (illum 3) have their colour in Kd and their share in Ka: they
/// become gloss of Kd, whose Phong exponent has the roughness alpha = r^2 of Blender's roughness r [WAL07];
/// Ns is 1000 (1 - r)^2, of the exporter in Python 900 (1 - r)^2. A metal with map_Kd keeps its colour as
/// paint.
void read_as_written_by_blender(BlenderExporter exporter, tinyobj::material_t& material);

}  // namespace reemit
