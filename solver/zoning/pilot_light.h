#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/work_watch.h"
#include "solver/gather/gather_batch.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/light_spread.h"
#include "solver/progressive_solver.h"

namespace reemit {

/// How closely a cell is looked at.
struct LookEffort {
  int points;   ///< [1, 2^16]
  int shadows;  ///< Shadow rays from each point for each half of the pilot solution, >= 1.
  int gathers;  ///< Gather rays likewise, >= 1.
};

/// What was seen at a point at each look (LightSpread::add).
struct Seen {
  float first_look, second_look;
};

/// A point of a cell and what was seen there.
struct SeenPoint {
  InCell at;
  Seen seen;
};
/// The light over the area that the points are spread over evenly. Its variance needs two points.
LightSpread spread_of(std::span<const SeenPoint> points);

/// A quick solution on coarse zones, and what it says about the light on other cells of the same triangles:
/// reflected radiance at points, by shadow rays and gather rays, all bands together, weighted such that each
/// has the same mean over the room. Nothing in it depends on
/// the seed of a solve or on threads.
class PilotLight {
 public:
  /// Solves the room on this mesh. Throws Interrupted when `watch` ends it. `scene` must outlive it.
  PilotLight(const Scene& scene, MeshResult mesh, const WorkWatch& watch);
  PilotLight(const PilotLight&) = delete;
  PilotLight& operator=(const PilotLight&) = delete;

  const ZoneMesh& mesh() const { return room().mesh(); }
  const Room& room() const { return solver_.room(); }
  /// Reflected radiance averaged over all area that is not sealed [W/(m2 sr)]; 0 in a room without light.
  double mean() const { return mean_; }

  /// What cells are looked at with. One per thread.
  class Looker {
   public:
    /// `pilot` must outlive it.
    explicit Looker(const PilotLight& pilot);
    /// Looks at points of the cell, twice at each, with halves of the pilot solution. The same for the same
    /// cell and effort; what is seen at points of cells of one side can be compared, for all send the same
    /// rays.
    LightSpread look(const SideCell& cell, const LookEffort& effort);
    /// The same at these places of the cell, as many as the effort says; what is seen there is set.
    void look_at(const SideCell& cell, std::span<SeenPoint> places, const LookEffort& effort);
    /// The same for each of these cells, with their gather rays in common packets: for few rays from each.
    /// `light` has room for one result a cell.
    void look_at_all(std::span<const SideCell> cells, const LookEffort& effort, LightSpread* light);
    /// The points of the last look, cell by cell.
    const std::vector<SeenPoint>& points() const { return points_; }

   private:
    /// Adds to `found` by point, half and band.
    void send_rays(const SideCell& cell, std::span<const SeenPoint> places, const LookEffort& effort,
                   float* found);
    /// Finds the numbers of the rays from points of this side, unless those of the last cell are the same.
    void draw_numbers(SideId side, const LookEffort& effort);
    /// Puts together what was found at these points.
    void add_up(const SideCell& cell, std::span<SeenPoint> points, const float* found) const;

    const PilotLight* pilot_;
    GatherBatch batch_;
    SideId side_;                                   // that the numbers are of
    std::vector<std::array<float, 3>> light_;       // numbers of shadow rays, by half and ray
    std::vector<std::array<float, 2>> hemisphere_;  // of gather rays, likewise
    std::vector<float> direct_weight_;              // by band
    std::vector<float> ray_weight_;                 // by band
    std::vector<float> found_;                      // by cell, point, half and band
    std::vector<SeenPoint> points_;
  };

 private:
  /// Adds batches until there are enough.
  static const Solution& solve(ProgressiveSolver& solver, const WorkWatch& watch);

  Scene pilot_scene_;
  std::atomic<bool> never_ = false;
  ProgressiveSolver solver_;
  RadianceField field_;
  DirectLight direct_;
  HemisphereGather gather_;
  double mean_ = 0;
  std::vector<float> band_weight_;  ///< Makes the bands' means alike, with the same sum.
};

}  // namespace reemit
