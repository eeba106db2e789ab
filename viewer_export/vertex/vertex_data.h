#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/model/bands.h"
#include "scenes/model/ids.h"
#include "scenes/model/vec.h"
#include "viewer_export/output/export_info.h"
#include "viewer_export/output/tone_map.h"

namespace reemit {

/// The surface whose vertices are known worst.
struct WorstSurface {
  SurfaceId surface;
  double error = 0;  ///< As ExportInfo::error, of its vertices alone.
};

/// Light at the vertices of the zones, ready for export. Vertices are split where surface, material, side or
/// a crease splits them, so every vertex belongs to one surface.
struct VertexData {
  ExportInfo info;
  /// Under a sky: irradiance of the sky, not the sun, on a horizontal plane outside [W/m2] per band; else
  /// empty.
  Spectrum outside{};
  /// True if an error target was missed because of the noise of the zone solution.
  bool limited_by_zones = false;
  bool gathered = false;  ///< Else every vertex has the mean of its zones.
  bool smoothed = false;  ///< Noise was taken out (smooth_vertices).
  /// Of surfaces that have a hundredth of the area or more. A bright part of the room hides in the error of
  /// all what a dark one lacks.
  WorstSurface worst{};
  BandSet bands = BandSet::grey();
  /// Of the displayable colours in PLY and glTF (tone_map_of_room); the radiances are never tone-mapped.
  ToneMap tone_map{1.0, ToneMapSettings::kFixedWhite};
  Vec3 up{0, 1, 0};  ///< +y or +z (up_direction): glTF files are turned so that it becomes +y.
  std::vector<std::string> surface_names;   ///< By SurfaceId.
  std::vector<std::string> material_names;  ///< By MaterialId.

  // One entry per vertex.
  std::vector<Vec3> positions;  ///< [m]
  std::vector<Vec3> normals;    ///< Unit, towards the side the light was computed on.
  std::vector<SurfaceId> surfaces;
  std::vector<MaterialId> materials;
  std::vector<bool> on_back;  ///< Of its surface: the front lies in the same place.

  // bands.count() entries per vertex: index vertex * bands + band.
  std::vector<float> radiance;         ///< Leaving the vertex in all, emission included [W/(m2 sr)].
  std::vector<float> irradiance;       ///< [W/m2]
  std::vector<float> radiance_stderr;  ///< Standard error of radiance [W/(m2 sr)].
  /// Part of radiance that is the first reflection of luminaires [W/(m2 sr)].
  std::vector<float> direct_radiance;
  /// The same of luminaires over mirrors, glass and gloss; empty in rooms that bend no light.
  std::vector<float> caustic_radiance;

  std::vector<std::array<std::uint32_t, 3>>
      triangles;  ///< Counter-clockwise seen from the side of the normals.

  std::size_t vertex_count() const { return positions.size(); }
  /// Linear Rec.709 of one of the per-band arrays at a vertex.
  Eigen::Array3d rgb(const std::vector<float>& values, std::size_t vertex) const;
};

/// Throws std::invalid_argument when array sizes or indices do not fit together.
void check_consistent(const VertexData& data);

}  // namespace reemit
