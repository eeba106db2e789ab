#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// The textures and vertex colours of a room, point by point of its base triangles: the one place that knows
/// how an image lies on a triangle, and what its colours are in the bands of the room. Empty in rooms
/// without. Const members may be called from any thread.
class RoomTextures {
 public:
  /// Room for one number per band, which takes none until a value is put there.
  using Values = std::vector<float>;

  RoomTextures() = default;
  /// Scene and mesh must outlive it.
  RoomTextures(const Scene& scene, const ZoneMesh& mesh);

  bool empty() const { return slot_.empty(); }
  bool varies_reflectance(SurfaceId s) const { return !empty() && materials_[s.index()].varies_reflectance; }
  bool varies_emission(SurfaceId s) const { return !empty() && materials_[s.index()].emission != nullptr; }
  bool is_cut_out(SurfaceId s) const { return !empty() && materials_[s.index()].is_cut_out; }
  /// Whether the back has a reflectance of its own, which does not vary.
  bool varies_back(SurfaceId s) const { return materials_[s.index()].varies_back; }
  /// Triangles of cut-outs; none elsewhere.
  const std::vector<std::uint32_t>& cut_outs() const { return cut_outs_; }

  // At (u,v) of a triangle, averaged over a spot of `size` across [m].

  /// Diffuse reflectance per band [0,1]. Pre: varies_reflectance.
  void reflectance(TriangleId t, float u, float v, float size, Values& rho) const;
  /// Radiance along the normal per band [W/(m2 sr)]. Pre: varies_emission.
  void radiance(TriangleId t, float u, float v, float size, Values& radiance) const;
  /// Share of the surface that is there [0,1], without averaging. Pre: is_cut_out.
  float opacity(TriangleId t, float u, float v) const;
  /// Length over which the finest image of a triangle changes by a texel [m]; infinite if none does.
  double texel_size(TriangleId t) const;

 private:
  /// How one image lies on a triangle.
  struct Placement {
    std::array<std::array<float, 2>, 3> uv{};  // of the corners, in the image
    float texels_per_m = 0;                    // geometric mean over directions; 0: no coordinates
  };
  struct OfMaterial {
    const MaterialTextures* textures = nullptr;
    const Texture* reflectance = nullptr;  // null: none
    const Texture* emission = nullptr;
    const Texture* opacity = nullptr;
    Values reflectance_factor, most_reflectance, emission_factor;
    bool varies_reflectance = false, varies_back = false, is_cut_out = false, has_colours = false;
  };
  struct OfTriangle {
    std::uint32_t surface;
    Placement reflectance, emission, opacity;
  };
  using Rgb = std::array<float, 3>;
  using Colours = std::array<Rgb, 3>;
  static constexpr std::uint32_t kNone = 0xffffffff;

  OfMaterial material_of(const Scene& scene, const Surface& surface) const;
  void add_triangle(const Scene& scene, const ZoneMesh& mesh, TriangleId t);
  /// A colour of an image, and of vertices, in the bands of the room.
  void in_bands(const Rgb& rgb, const TexelSpectra& spectra, Values& values) const;
  const OfTriangle& of(TriangleId t) const { return triangles_[slot_[t.index()]]; }
  static Texel value(const Texture& texture, const Placement& placement, float u, float v, float size);

  BandKind kind_ = BandKind::kGrey;
  std::size_t bands_ = 0;
  std::vector<std::uint32_t> slot_;    // by triangle
  std::vector<OfTriangle> triangles_;  // textured ones
  std::vector<Colours> colours_;       // as triangles_, of their corners; empty if no vertex has any
  std::vector<OfMaterial> materials_;  // by surface
  std::vector<std::uint32_t> cut_outs_;
};

}  // namespace reemit
