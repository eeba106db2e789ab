#pragma once
#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/gather/bright_zones.h"
#include "solver/gather/caustic_map.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/path_key.h"
#include "solver/gather/radiance_field.h"
#include "solver/gather/specular_path.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "solver/solution/gather_plan.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// How gather rays read the zone solution.
struct GatherSettings {
  /// A hit nearer than this many zone sizes is continued by another bounce instead of read, so that corners
  /// show no zone-sized steps; so are hits on uneven zones from any distance. >= 0, 0 = always read.
  double close_hit = 1.0;
  /// Bounces after which a hit is read all the same [0, 64]. From the fifth on, chance ends those that carry
  /// little.
  int most_bounces = 4;
  /// By zone, 1 where what packets brought is too little to be read: such hits are continued from any
  /// distance. Needed by the constructor alone; null: none.
  const std::vector<std::uint8_t>* little_known = nullptr;
  /// Look for uneven zones before the first ray, which takes some shadow rays for each zone.
  bool continue_uneven = true;
  /// Shoot photons for light over mirrors and glass before the first ray (CausticMap); else rays find it.
  bool caustics = false;
  /// Points in the air about which photons tell as well, in the order of their numbers; needed by the
  /// constructor alone. At others rays find that light, but none of lights without area.
  std::span<const MeasuringPoint> in_air = {};
  /// Look for zones that are worth rays of their own (GatherBatch::aims).
  bool aim_at_bright = true;
  std::uint64_t seed = 1;
  /// What was found before of the solution and the room, needed by the constructor alone; null: nothing. What
  /// it lacks is found with `seed`.
  const GatherPlan* plan = nullptr;
};

/// Indirect light at points: cosine-distributed rays that read the *reflected* radiance of the zones they hit
/// ([GI98] final gather). Self-emission of what they hit is not read: DirectLight has counted it.
/// A hit y closer than about the size of its zone, or on a zone whose light is uneven (uneven_zones.h), is
/// not read; its radiance is taken as rho_y/pi (E_direct(y) + pi L_reflected(z)) with its own shadow ray and
/// one more cosine-distributed ray to z. Rays go on from mirrors, gloss and glass; a luminaire that they meet
/// over a bent way counts, because no shadow ray finds it, as far as photons do not. Const members may be
/// called from any thread.
class HemisphereGather {
 public:
  /// When `stop` (may be null) is requested, the look for uneven zones ends early, and what is gathered means
  /// little.
  HemisphereGather(const RadianceField& field, const DirectLight& direct, const GatherSettings& settings,
                   const StopToken* stop = nullptr);

  const Room& room() const { return field_->room(); }
  std::size_t band_count() const { return field_->band_count(); }
  /// What photons bring to a point is a part of what is gathered there: GatherBatch adds it.
  const CausticMap& caustics() const { return caustics_; }
  /// True if a hit of this zone at this distance [normalised units] is continued instead of read.
  bool continues(ZoneId zone, float distance) const { return distance < reach_[zone.index()]; }
  const RadianceField& field() const { return *field_; }
  const BrightZones& bright() const { return bright_; }
  /// Has what a hit of this zone reads brought into the cache.
  void fetch(ZoneId zone, std::size_t part) const {
    __builtin_prefetch(&reach_[zone.index()]);
    __builtin_prefetch(field_->reflected(zone, part));
  }

  /// An estimate of weight[b]/pi times the irradiance of photons at x for two uniform numbers, added to
  /// sum[b], where u1 is below kPhotonLooks.
  void add_photons(const SurfacePoint& x, float u0, float u1, const PathKey& key, const float* weight,
                   float* sum) const {
    if (caustics_.exists() && u1 < kPhotonLooks)
      caustics_.add_reflected(x, key.part, false, u0,
                              {white_.data(), std::numbers::inv_pi_v<float> / kPhotonLooks}, weight, sum);
  }

  /// Adds weight[b] times the radiance that a hit y of a ray of this direction (unit), which is continued or
  /// on a mirror or glass, sends back along it to sum[b], of luminaires over mirrors, glass and gloss alone
  /// to caustic[b], which may be the same. `weight` is used up. `without_photons`: of a ray from a point
  /// where photons tell nothing, so that rays count all that they find over mirrors and glass. `aims`: points
  /// that it goes on from because they are near aim a ray at bright zones, too.
  void add_continued(const Hit& y, const Vec3f& direction, const PathKey& key, bool without_photons,
                     float* weight, float* sum, float* caustic, bool aims) const;

  /// From where rays are aimed at bright zones.
  struct AimingPoint {
    Vec3f origin, normal;
    float view;    ///< BrightZones::View::total.
    float others;  ///< Cosine-distributed rays for each aimed one.
  };
  /// What a ray of either kind from x that met a bright zone counts for, by the balance heuristic [VG95], as
  /// a share of all the weight that the others have together.
  float share_of_kind(const AimingPoint& x, const Vec3f& along, ZoneId met, const Hit& hit) const;

 private:
  /// Adds what a ray aimed from y brings at this bounce; returns BrightZones::View::total from there, 0 if
  /// none can be. `chance`: of coming here.
  float add_aimed(const SurfacePoint& y, int bounce, const PathKey& key, const BrdfValue& brdf, float chance,
                  const float* weight, float* sum) const;

  /// A look at photons costs as much as several rays and has less noise: one of eight that might takes it.
  static constexpr float kPhotonLooks = 0.125F;

  /// One sample of what y reflects of the luminaires along the path.
  void add_direct(const SurfacePoint& y, int bounce, const PathKey& key, const float* weight,
                  float* sum) const;

  /// One sample of what photons on the other side of y send through it diffusely.
  void add_photons_beyond(const SurfacePoint& y, int bounce, const PathKey& key, const float* weight,
                          float* sum) const;

  /// Three for a shadow ray, one for a look at photons.
  std::array<float, 4> numbers(int bounce, const PathKey& key) const;

  const RadianceField* field_;
  const DirectLight* direct_;
  CausticMap caustics_;
  BrightZones bright_;
  std::vector<float> white_;  // by band: 1
  std::vector<float> reach_;  // by zone: hits nearer than this are continued
  int most_bounces_;
  CounterRng rng_;
  SpecularNumbers specular_;
};

}  // namespace reemit
