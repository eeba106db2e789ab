#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solver/emit/luminaire_choice.h"
#include "solver/emit/luminaire_table.h"
#include "solver/gather/caustic_map.h"
#include "solver/room/room.h"
#include "solver/sampling/sobol.h"
#include "solver/trace/measuring_point.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// Where light goes that a surface sends on: by its lobes, and by diffuse transmission; per band.
struct LobeSums {
  float* lobes;
  float* diffuse;
};

struct DirectLightSettings {
  /// How one luminaire is chosen among many; unset: LuminaireChoice::default_for.
  std::optional<Selection> selection = std::nullopt;
};

/// Irradiance straight from the luminaires at a point, by shadow rays to sampled luminaire points [SWZ96].
/// They cross panes, which light passes straight on; what comes over mirrors or is bent by glass they do not
/// find. Const members may be called from any thread.
class DirectLight {
 public:
  static constexpr int kDimensions =
      3;  ///< Uniform numbers that one sample takes; the first two matter most.

  /// The room must outlive it.
  explicit DirectLight(const Room& room, const DirectLightSettings& settings = {});

  std::size_t band_count() const { return table_.band_count(); }
  bool empty() const { return table_.empty(); }
  /// Luminaires that one sample weighs against each other, as a measure of its cost.
  std::size_t luminaires_weighed() const;
  Selection selection() const { return selection_; }

  /// One sample: adds weight[b] E_b to sum[b], E_b an unbiased estimate of the irradiance [W/m2]. Exactly
  /// nothing is added where no luminaire is visible.
  void add_sample(const SurfacePoint& x, const std::array<float, kDimensions>& u, const float* weight,
                  float* sum) const;

  /// The same at a point in the air, of few luminaires by a ray to each.
  void add_sample(const MeasuringPoint& x, const std::array<float, kDimensions>& u, const float* weight,
                  float* sum) const;

  /// `count` samples at one point, `numbers(i)` those of each: the same sums as by add_sample, but what they
  /// have in common is found once.
  template <class Numbers>
  void add_samples(const SurfacePoint& x, int count, const Numbers& numbers, const float* weight,
                   float* sum) const {
    add_samples(x, count, numbers, weight, [&](int) { return sum; });
  }
  /// The same for samples that have different sums: `sum_of(i)`.
  template <class Numbers, class SumOf>
  requires std::invocable<SumOf, int>
  void add_samples(const SurfacePoint& x, int count, const Numbers& numbers, const float* weight,
                   const SumOf& sum_of) const {
    estimate_all(x, count, numbers, [&](int i, const Arrival& light) { add(light, weight, sum_of(i)); });
  }

  /// Whether a sample weighs all luminaires for its point; weights for many points near each other can then
  /// be found once.
  bool is_weighed_by_point() const {
    return selection_ == Selection::kLinear && table_.size() > 1 &&
           table_.size() <= LuminaireChoice::kMostLinear;
  }
  /// Adds the irradiance that each luminaire would bring to x if nothing hid it [W/m2], all bands together,
  /// to one of the luminaires_weighed() weights. Pre: is_weighed_by_point().
  void weigh(const SurfacePoint& x, float* weights) const;
  /// add_sample with luminaires chosen by such weights, which may be those of other points.
  void add_sample(const SurfacePoint& x, const std::array<float, kDimensions>& u,
                  std::span<const float> luminaire_weights, const float* weight, float* sum) const;

  /// One sample of what the surface at x sends towards x.towards of it: adds weight[b] f_b E_b / `chance` to
  /// sum[b], f the BRDF [1/sr].
  void add_reflected_sample(const SurfacePoint& x, const std::array<float, kDimensions>& u, float chance,
                            const float* weight, float* sum) const;

  /// One sample of what the lobes of a rough surface at x send towards x.towards (SpecularSurface::value):
  /// adds weight[b] times that to the sums, of areas only the share that rays drawn from the lobe do not
  /// find, of narrow lobes only what is `counted`; diffuse transmission only where it is followed.
  void add_lobe_sample(const SurfacePoint& x, const std::array<float, kDimensions>& u,
                       const CausticShare& counted, DiffuseWay diffuse, const float* weight,
                       const LobeSums& sums) const;
  /// The share of an area's light that is left to rays drawn from a lobe: the balance heuristic [VG95], with
  /// the luminaires of a surface taken as drawn evenly by area. `way`: from the lobe to a point of the
  /// triangle.
  float found_by_lobe(TriangleId luminaire, float way, float pdf_per_sr) const;

  /// Adds, for samples first .. first+count-1 of the sequence (dimensions 0-2), E_b to sum[b] [W/m2] and, if
  /// given, E_b^2 to sum_of_squares[b].
  void add_samples(const SurfacePoint& x, const SobolSequence& sequence, std::uint32_t first, int count,
                   double* sum, double* sum_of_squares = nullptr) const;

 private:
  /// What arrives at a point: the irradiance is estimated as factor * strength[b] * pane(b).
  struct Arrival {
    const float* strength = nullptr;  ///< Null if nothing arrives, or is_at_point.
    float factor = 0;
    std::size_t entry = 0;   ///< Of the table.
    Vec3f towards{0, 0, 0};  ///< The luminaire; of any length.
    /// By band, what panes on the way leave of it, and the colour of the sky there; empty where there are
    /// neither.
    std::vector<float> panes;
    SurfaceModel::PointValues at_point{};  ///< The strength where it differs over the luminaire.
    bool is_at_point = false;

    bool arrives() const { return strength != nullptr || is_at_point; }
    float strength_in(std::size_t b) const { return is_at_point ? at_point[b] : strength[b]; }
    float pane(std::size_t b) const { return panes.empty() ? 1.0F : panes[b]; }
  };
  /// add_lobe_sample by one way; `lit` is x on the side of the surface that light falls on.
  void add_lobe_of(const SurfacePoint& x, SpecularWayOn way, const SurfacePoint& lit,
                   const std::array<float, kDimensions>& u, const CausticShare& counted, const float* weight,
                   float* sum) const;
  /// Whether light comes straight from the luminaire to the origin of a shadow ray; `panes` as of Arrival,
  /// `chance` as of RayTracer::visible.
  bool passes(const Vec3f& origin, const LuminaireSample& sample, std::uint32_t chance,
              std::vector<float>& panes) const;
  /// The share of the light of an entry that comes from `towards` which shadow rays count at a lobe with this
  /// density.
  float left_by_lobe(const Arrival& light, const SpecularStep& step, const CausticShare& counted) const;
  Arrival estimate(const SurfacePoint& x, const Vec3f& origin, const std::array<float, kDimensions>& u) const;
  Arrival estimate(const SurfacePoint& x, const Vec3f& origin, const LuminaireChoice& choice,
                   const std::array<float, kDimensions>& u) const;
  /// Irradiance goes by `normal`; `is_above` tells whether a direction leads away from the surface there.
  template <class IsAbove>
  Arrival estimate(const Vec3f& origin, const Vec3f& normal, const IsAbove& is_above,
                   const LuminaireChoice& choice, const std::array<float, kDimensions>& u) const;
  /// What comes of one luminaire; `inverse_probability` of its having been chosen.
  template <class IsAbove>
  Arrival arrival(const Vec3f& origin, const Vec3f& normal, const IsAbove& is_above, std::size_t entry,
                  const std::array<float, kDimensions>& u, float inverse_probability) const;
  /// Calls back with the number and the estimate of each of `count` samples at one point.
  template <class Numbers, class CallBack>
  void estimate_all(const SurfacePoint& x, int count, const Numbers& numbers,
                    const CallBack& call_back) const {
    if (empty()) return;
    const Vec3f origin = ray_origin(*rays_, x);
    std::optional<LuminaireChoice> choice;
    for (int i = 0; i < count; ++i) {
      const std::array<float, kDimensions> u = numbers(i);
      if (!choice || selection_ == Selection::kSpatial)  // the tree takes a number for each
        choice.emplace(table_, selection_, origin, x.normal, u[2]);
      call_back(i, estimate(x, origin, *choice, u));
    }
  }
  void add(const Arrival& light, const float* weight, float* sum) const;

  const RayTracer* rays_;
  const SurfaceModel* surfaces_;
  const SkyLight* sky_;
  LuminaireTable table_;
  Selection selection_;
};

}  // namespace reemit
