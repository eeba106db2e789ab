#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "bench/validation/validation_row.h"
#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"

namespace reemit::validation {

/// Both ways to follow packets.
inline constexpr std::array kMethods{SolveMethod::kShooting, SolveMethod::kWalk};

/// A room solved kSolves times with different seeds, each in ZoneSums::kGroups batches. Every batch is an
/// independent estimate of the whole solution, a replicate: kReplicates of them give standard errors with
/// enough degrees of freedom that four of them mean something.
class SolvedRoom {
 public:
  static constexpr std::size_t kSolves = 4;
  static constexpr std::size_t kReplicates = kSolves * ZoneSums::kGroups;

  /// `packets`: emitted by luminaires in all solves together. The room must outlive this.
  SolvedRoom(const Scene& scene, const MeshResult& mesh, SolveMethod method, double packets,
             const std::string& seed_text, Reemission reemission = Reemission::kFromHits);

  const Scene& scene() const { return *scene_; }
  const ZoneMesh& mesh() const { return solutions_.front().mesh; }
  const Room& room() const { return *room_; }
  const RayTracer& rays() const { return room_->rays(); }
  const std::vector<Solution>& solutions() const { return solutions_; }
  SurfaceId surface(const std::string& name) const;  ///< Throws std::out_of_range.
  double area(SurfaceId s) const;                    ///< Of the fronts [m2].
  double area(const std::vector<SurfaceId>& surfaces) const;
  std::vector<SurfaceId> all_surfaces() const;

  /// Irradiance of a zone [W/m2] in every replicate.
  Estimates zone(ZoneId z, std::size_t band = 0) const;
  /// Area mean over the fronts of surfaces [W/m2].
  Estimates mean(const std::vector<SurfaceId>& surfaces, std::size_t band = 0) const;
  Estimates mean(SurfaceId s, std::size_t band = 0) const { return mean(std::vector<SurfaceId>{s}, band); }
  /// What of mean() comes after a reflection, where the direct part does not vary between the batches of a
  /// solve: in closed rooms, over all surfaces.
  Estimates indirect_mean(const std::vector<SurfaceId>& surfaces, std::size_t band = 0) const;

 private:
  double in_replicate(std::size_t replicate, std::size_t value) const {
    const ZoneSums& sums = solutions_[replicate / ZoneSums::kGroups].sums;
    const std::size_t group = replicate % ZoneSums::kGroups;
    return sums.group_total[group * sums.direct.size() + value] /
           static_cast<double>(sums.group_weight[group]);
  }

  const Scene* scene_;
  std::vector<Solution> solutions_;
  std::unique_ptr<Room> room_;
};

/// Each estimate times a factor.
Estimates scaled(Estimates estimates, double factor);
/// Each estimate times a factor plus an offset.
Estimates scaled(Estimates estimates, double factor, double offset);

/// Relative bound of what zone values of SolvedRoom lack: the power that shooting leaves unshot, and
/// rounding.
inline constexpr double kSolveBound = 1.2e-5;

}  // namespace reemit::validation
