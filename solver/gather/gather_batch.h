#pragma once
#include <array>
#include <vector>

#include "solver/gather/bright_zones.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_key.h"
#include "solver/sampling/warp.h"
#include "solver/trace/measuring_point.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// Gather rays of any points in packets of 16. One per thread; the order of the calls decides the order of
/// the sums, so results do not depend on threads. Every ray adds weight[b] * L_b to its sum; with
/// weight = 1/n over n cosine-distributed rays, pi times the sum is the irradiance.
class GatherBatch {
 public:
  /// `rays_of_place`: from each place so many rays by `add` and, where there are bright zones, one by `aim`,
  /// all of the same weight; 0: none is aimed, and any number may leave a place.
  explicit GatherBatch(const HemisphereGather& gather, int rays_of_place = 0);
  bool aims() const { return aims_; }

  /// Queues a ray from x in direction (u0,u1) of the cosine-weighted hemisphere. `weight` has one value per
  /// band and is copied; `sum` must live until flush(), and `caustic`, which gets what comes from luminaires
  /// over mirrors, glass and gloss unless it is null.
  void add(const SurfacePoint& x, float u0, float u1, const PathKey& key, const float* weight, float* sum,
           float* caustic = nullptr);
  /// The same from a point in the air. What photons bring to one that has a number is not among it and the
  /// same for all its rays: CausticMap::add_irradiance.
  void add(const MeasuringPoint& x, float u0, float u1, const PathKey& key, const float* weight, float* sum,
           float* caustic = nullptr);
  /// Queues the ray from x, a SurfacePoint or a MeasuringPoint, to a bright zone, for three uniform numbers.
  /// Pre: aims().
  template <class Place>
  void aim(const Place& x, const std::array<float, 3>& u, PathKey key, const float* weight, float* sum,
           float* caustic = nullptr);
  /// Traces what is queued. Call it before the sums are read.
  void flush();

 private:
  static constexpr int kWidth = 16;

  /// Of a lane.
  struct Way {
    bool second_look = false;
    bool without_photons = false;
    PathKey key{};
    float* sum = nullptr;
    float* caustic = nullptr;
    Vec3f normal{0, 0, 1};   // at the place
    float view = 0;          // BrightZones::View::total from there
    BrightZones::Aim aim{};  // distance > 0: of an aimed ray, which brings nothing if it meets anything else
  };

  /// Finds how rays leave x, unless the last one left it as well. False where none does.
  bool leave_from(const SurfacePoint& x);
  bool leave_from(const MeasuringPoint& x);
  void look_at_bright();
  void queue(const Vec3f& direction, const Way& way, const float* weight);
  /// What a ray that met this counts for, by the balance heuristic; 0 if it was aimed at something else.
  float share_of_kind(int lane, const Way& way, ZoneId zone, const Hit16& hits) const;
  void trace();
  void keep_for_second_look(std::size_t lane, const Hit16& hits);
  bool counts(const Way& way, ZoneId zone, TriangleId triangle, bool front) const;

  const HemisphereGather* gather_;
  std::size_t bands_;
  bool aims_;
  float rays_of_place_;
  int count_ = 0;
  bool without_photons_ = false;  // at the place that the last ray left
  SurfacePoint from_;             // that the last ray left
  Vec3f origin_{0, 0, 0};
  Vec3f above_{0, 0, 1};         // geometric normal there
  Frame frame_{Vec3f(0, 0, 1)};  // of directions there
  Vec3f normal_{0, 0, 1};        // that cosines are to
  BrightZones::View view_;
  Ray16 rays_{};
  std::array<Way, kWidth> ways_{};
  std::vector<float> weights_;
};

}  // namespace reemit
