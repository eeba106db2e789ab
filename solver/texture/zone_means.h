#pragma once
#include <vector>

#include "solver/texture/room_textures.h"

namespace reemit {

/// What zones hold of textures: means over their areas, of cut-outs over what is there of them. Rows of zones
/// of surfaces whose value does not vary are 0.
struct ZoneTextureMeans {
  std::vector<double> reflectance;  ///< [zone * bands + band], [0,1]; empty if none varies.
  std::vector<double> radiance;     ///< Along the normal [W/(m2 sr)], likewise.
  std::vector<float> solid;         ///< Share that is there, by zone, above 0; empty without cut-outs.
};

/// Whether a room finds the means of its textures over zones, which takes a look at every texel; where they
/// are left out, nothing may be asked that depends on a zone.
enum class TextureMeans { kFound, kLeftOut };

/// A cell is cut into no more than this squared parts to take its mean.
inline constexpr int kMostMeanDivisions = 32;

/// By the midpoint rule over the parts of each cell, which are an eighth of a texel across where
/// kMostMeanDivisions are enough for that; where they are larger than half a texel, over copies of the images
/// with larger texels. A zone of many cells has as many parts as one of a single cell would, unless cut-outs
/// decide how large it is.
ZoneTextureMeans zone_texture_means(const RoomTextures& textures, const ZoneMesh& mesh, std::size_t bands);

/// Makes zones of cut-outs as large as what is there of them, unless the mesh has such shares already.
void measure_cut_outs(const Scene& scene, ZoneMesh& mesh);

}  // namespace reemit
