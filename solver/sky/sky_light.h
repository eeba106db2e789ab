#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "scenes/model/scene.h"
#include "solver/reflect/surface_model.h"
#include "solver/sky/sky_cells.h"
#include "solver/sky/sky_table.h"
#include "solver/sky/sky_view.h"
#include "solver/sky/sun_beam.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

struct SkySight;

/// Sky, ground and sun as packets, shadow rays and rays that leave the room meet them. What the room sees of
/// them is surveyed once, when it is first asked for. Const members may be called from any thread.
class SkyLight {
 public:
  /// All must outlive it; the sky of the scene is placed.
  SkyLight(const Scene& scene, const ZoneMesh& mesh, const RayTracer& rays, const SurfaceModel& surfaces);

  // What a ray sees that leaves the room; directions are unit, in the room.

  bool has_sky() const { return !table_.empty(); }
  bool has_sun() const { return beam_.has_value(); }
  /// Radiance of sky or ground, the sun left out [W/(m2 sr)].
  const float* radiance(const Vec3f& towards) const { return table_.radiance(cell(towards)); }
  /// Radiance of the sun if that is there, else null.
  const float* sun_radiance(const Vec3f& towards) const {
    return beam_ && beam_->sees(towards.cast<double>()) ? sun_radiance_.data() : nullptr;
  }
  /// Both, as a camera sees them: the image itself, or skies without the steps of the table. Adds weight[b]
  /// times them to sum[b].
  void add_seen(const Vec3f& towards, const float* weight, float* sum) const;
  /// Share of the light from there that is left to rays drawn with this density [1/sr] from a lobe, shadow
  /// rays counting the rest: the balance heuristic [VG95] against directions drawn by brightness alone.
  float sky_found_by_lobe(const Vec3f& towards, float pdf_per_sr) const;
  /// The same of the sun. Pre: has_sun().
  float sun_found_by_lobe(float pdf_per_sr) const;

  // Shadow rays.

  struct Sample {
    Vec3f towards{0, 0, 0};
    float factor = 0;  ///< Irradiance per unit of strength() over the density.
  };
  /// Sum over bands is the unit of Sample::factor for the sky; irradiance across the beam for the sun.
  const Spectrum& sky_strength() const { return table_.spectrum(); }
  const Spectrum& sun_strength() const { return sun_irradiance_; }
  /// About what arrives at x per unit of strength; never 0 for the sky.
  float expected_from_sky(const Vec3f& x, const Vec3f& normal) const;
  /// The cosine to the middle of the sun; a little above 0 while only its rim is up. Pre: has_sun().
  float expected_from_sun(const Vec3f& normal) const;
  Sample sample_sky(const Vec3f& x, const Vec3f& normal, float u0, float u1) const;
  Sample sample_sun(const Vec3f& normal, float u0, float u1) const;
  /// True if the colour of the sky depends on the direction; then colour() is to be multiplied by.
  bool is_coloured() const { return table_.is_coloured(); }
  /// By band, the spectrum of a direction over sky_strength().
  void colour(const Vec3f& towards, std::vector<float>& by_band) const;

  /// Makes the survey, if that has not been done.
  void prepare() const { survey(); }

  // Packets: from cells whose packets share their power.

  std::size_t cell_count() const { return survey().cells.size(); }
  /// Power that a cell sends into the box around the room [W] per band.
  Spectrum power(std::size_t cell) const;
  bool is_sun(std::size_t cell) const { return survey().cells[cell].source == kSunSource; }
  /// Share of the packets of sky and sun that should leave a cell; all add up to 1.
  double packet_share(std::size_t cell) const { return survey().cells[cell].packets; }
  /// What all of them bring to surfaces [W], each piece over the share of sky in the view of its surface:
  /// light for dark corners counts more than light for outsides. A lamp's power compares with it times
  /// mean_need().
  double worth() const { return survey().worth; }
  double mean_need() const { return survey().mean_need; }
  /// A packet of a cell, by uniform numbers in [0,1).
  SkyRay start(std::size_t cell, float u0, float u1, float u2, float u3) const;

  /// How many packets light that leaves a surface at x should be carried on by, over those of a surface that
  /// sees half the sky: 1 to kMostNeed. What is reflected outside must not take the packets from what is
  /// inside.
  static constexpr std::uint8_t kMostNeed = 32;
  std::uint8_t need(const Vec3f& x, const Vec3f& normal) const;

 private:
  static constexpr std::size_t kSunSource = 0xffff;
  struct PacketCell {
    std::size_t source;  // of entries_ and face: entry * kFaces + face
    NumberCell numbers;
    double packets = 0;
  };
  struct Survey {
    SkyView view;
    std::vector<PacketCell> cells;
    double worth = 0;
    double mean_need = 1;
  };

  SkyTable::Cell cell(const Vec3f& towards) const {
    return table_.cell_of(table_.to_local() * towards.cast<double>());
  }
  Vec3 local(const Vec3f& v) const { return table_.to_local() * v.cast<double>(); }
  const Survey& survey() const;
  void make_survey() const;
  /// Parts of it, which fill its view: what of the sky is of use, by entry and face of its box, and what of
  /// the sun. Pre (the latter): beam_, after useful_sky().
  std::vector<std::vector<UsefulLight>> useful_sky() const;
  std::vector<UsefulLight> useful_sun() const;
  double square_metres(const SkySight& sight) const;
  double flux(std::size_t source) const;
  double pdf_per_sr(std::uint32_t place, const Vec3& local) const;

  const Sky* sky_;
  const ZoneMesh* mesh_;
  const RayTracer* rays_;
  const SurfaceModel* surfaces_;
  SkyTable table_;
  SkyBox box_;
  std::vector<SkyEntry> entries_;  // one, or one for each band of a coloured sky
  std::vector<Spectrum> entry_spectrum_;
  std::optional<SunBeam> beam_;
  Spectrum sun_irradiance_;
  std::vector<float> sun_radiance_;
  Spectrum ground_;  // as a camera sees it; empty: as in the image
  mutable std::once_flag surveyed_;
  mutable Survey survey_;
};

/// The sky of a scene; null if it has none.
std::shared_ptr<const SkyLight> make_sky_light(const Scene& scene, const ZoneMesh& mesh,
                                               const RayTracer& rays, const SurfaceModel& surfaces);

}  // namespace reemit
