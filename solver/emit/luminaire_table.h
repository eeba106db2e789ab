#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/emit/area_luminaire.h"
#include "solver/emit/light_tree.h"
#include "solver/emit/luminaire_sample.h"
#include "solver/emit/punctual_emitter.h"
#include "solver/room/room.h"

namespace reemit {

/// Everything that emits, as seen by direct light: one entry per emitting side of a convex polygon, of a
/// curved shape, or of a base triangle of any other face; then the lights that rays do not see; then sky and
/// sun. Entries of zero power are left out.
class LuminaireTable {
 public:
  /// The room must outlive it.
  explicit LuminaireTable(const Room& room);

  std::size_t size() const { return brightness_.size(); }
  bool empty() const { return brightness_.empty(); }
  std::size_t band_count() const { return bands_; }

  /// Per band: radiance along the normal [W/(m2 sr)] of an area, intensity [W/sr], irradiance across the beam
  /// [W/m2], intensity per candela, or SkyLight::sky_strength.
  const float* strength(std::size_t entry) const { return &strength_[entry * bands_]; }
  /// Whether the strength of an entry is but a mean over it, and radiance_at says more.
  bool varies(std::size_t entry) const { return entry >= first_cell_ && entry < first_cell_ + cells_.size(); }
  /// Radiance along the normal [W/(m2 sr)] where a sample of such an entry lies; of cut-outs, that times the
  /// share that is there.
  void radiance_at(std::size_t entry, const Vec3f& target, SurfaceModel::PointValues& radiance) const;
  /// Surface that an entry belongs to; not valid for lights that rays do not see.
  SurfaceId surface_of(std::size_t entry) const {
    return entry < areas_.size() ? surface_of_area_[entry] : SurfaceId();
  }
  /// Area of the emitting sides of a surface [normalised].
  float emitting_area(SurfaceId s) const { return area_of_surface_[s.index()]; }
  bool is_sky(std::size_t entry) const { return entry == sky_; }
  bool is_sun(std::size_t entry) const { return entry == sun_; }
  /// Sum of strength over bands.
  float brightness(std::size_t entry) const { return brightness_[entry]; }

  /// About the irradiance at x (normal n) per unit of strength if nothing is in the way; 0 only if the entry
  /// cannot light x at all.
  float unoccluded(std::size_t entry, const Vec3f& x, const Vec3f& n) const;
  /// Draws a point of the entry. False if it cannot light x.
  bool sample(std::size_t entry, const Vec3f& x, const Vec3f& n, float u0, float u1,
              LuminaireSample& result) const;

  /// Over all entries but those at infinity; its luminaires are numbered by entry_of_tree.
  const LightTree& tree() const { return tree_; }
  std::size_t entry_of_tree(std::uint32_t luminaire) const { return tree_entry_[luminaire]; }
  const std::vector<std::uint32_t>& entries_at_infinity() const { return at_infinity_; }

 private:
  void add_surfaces(const Room& room);
  void add_cells(const Room& room);
  void add_lights(const Scene& scene);
  void add_sky(const Room& room);
  void build_tree();
  void add_strength(const Spectrum& strength);

  static constexpr std::size_t kNoEntry = static_cast<std::size_t>(-1);

  const RayTracer* rays_;
  const SkyLight* sky_light_;
  const SurfaceModel* surfaces_;
  std::size_t bands_;
  std::size_t sky_ = kNoEntry, sun_ = kNoEntry;  // entries
  std::vector<AreaLuminaire> areas_;
  std::vector<SurfaceId> surface_of_area_;
  std::vector<float> area_of_surface_;
  std::size_t first_cell_ = 0;     // entry
  std::vector<TriangleId> cells_;  // triangles of the entries from there on
  std::vector<PunctualEmitter> punctual_;
  std::vector<float> strength_;
  std::vector<float> brightness_;
  LightTree tree_;
  std::vector<std::uint32_t> tree_entry_;
  std::vector<std::uint32_t> at_infinity_;
};

}  // namespace reemit
