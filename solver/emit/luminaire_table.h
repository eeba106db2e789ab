#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/model/scene.h"
#include "solver/emit/punctual_emitter.h"
#include "solver/emit/triangle_light.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// Where a shadow ray for one luminaire goes, and what arrives if it gets through.
struct LuminaireSample {
  float factor = 0;          ///< Irradiance per unit of emission() over the density of the sample.
  bool at_infinity = false;  ///< `target` is a unit direction towards the luminaire, else a point.
  Vec3f target{0, 0, 0};     ///< Normalised; a ray origin just off the luminaire.
};

/// Everything that emits, as seen by direct light: one entry per emitting side of a base triangle, then the
/// lights without area. Entries of zero power are left out.
class LuminaireTable {
 public:
  LuminaireTable(const Scene& scene, const RayScene& rays);

  std::size_t size() const { return brightness_.size(); }
  bool empty() const { return brightness_.empty(); }
  std::size_t band_count() const { return bands_; }

  /// Per band: radiance [W/(m2 sr)] of a triangle, intensity [W/sr], or irradiance across the beam [W/m2].
  const float* emission(std::size_t entry) const { return &emission_[entry * bands_]; }
  /// Sum of emission over bands.
  float brightness(std::size_t entry) const { return brightness_[entry]; }

  /// Irradiance at x (normal n) per unit of emission if nothing is in the way; 0 only if the entry cannot
  /// light x at all.
  float unoccluded(std::size_t entry, const Vec3f& x, const Vec3f& n) const;
  /// Draws a point of the entry. False if it cannot light x.
  bool sample(std::size_t entry, const Vec3f& x, const Vec3f& n, float u0, float u1,
              LuminaireSample& result) const;

  /// Entry whose share of the total power holds position u in [0,1), and that share.
  std::size_t entry_at_power(float u, float& share) const;

 private:
  struct TriangleEntry {
    TriangleLight light;
    TriangleId triangle;
    bool front;
  };

  void add_triangles(const Scene& scene);
  void add_punctual(const Scene& scene);
  void add_emission(const Spectrum& emission, double power);

  const RayScene* rays_;
  std::size_t bands_;
  std::vector<TriangleEntry> triangles_;
  std::vector<PunctualEmitter> punctual_;
  std::vector<float> emission_;
  std::vector<float> brightness_;
  std::vector<double> cumulative_power_;
};

/// Choice of one luminaire for a shading point by its unoccluded irradiance ([SWZ96, sec. 4.2], linear). With
/// few luminaires all are candidates; with many, kMost are drawn in systematic positions along the cumulative
/// power, and the choice among them keeps the estimate unbiased [TCE05].
class LuminaireChoice {
 public:
  static constexpr std::size_t kMost = 24;

  /// `u` places the candidates when there are more than kMost luminaires.
  LuminaireChoice(const LuminaireTable& table, const Vec3f& x, const Vec3f& n, float u);

  bool empty() const { return count_ == 0; }
  /// Picks by u in [0,1) and stretches u over the interval that was hit, so that it can be used again
  /// ([SWZ96] Fig. 8). `inverse_probability` weighs a sample of the picked entry. Pre: !empty().
  std::size_t pick(float& u, float& inverse_probability) const;

 private:
  /// Share of the choice that goes evenly to all candidates: bounds the weight of a luminaire whose stronger
  /// neighbours turn out to be hidden.
  static constexpr float kEvenShare = 0.1F;

  std::size_t count_ = 0;
  std::array<std::uint32_t, kMost> entry_;
  std::array<float, kMost> cumulative_;  // of the probabilities; the last is 1
  std::array<float, kMost> draw_weight_;
};

}  // namespace reemit
