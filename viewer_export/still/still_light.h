#pragma once
#include <atomic>
#include <cstddef>
#include <memory>

#include "scenes/model/stop_token.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"
#include "solver/gather/radiance_field.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "viewer_export/still/still_settings.h"

namespace reemit {

/// What all stills of a solved room have in common, wherever their cameras stand: the zones as gather rays
/// read them, which of them are uneven, the choice of luminaires, photons behind mirrors and glass. Finding
/// it takes up to some seconds, once for any number of stills. Const members may be called from any thread.
class StillLight {
 public:
  /// The room and the solution must outlive it. When `interrupt` becomes true, it ends early and what gather
  /// rays find means little. Throws InputError for settings out of range and a room that is not the one
  /// solved.
  static std::unique_ptr<StillLight> prepare(const Room& room, const Solution& solution,
                                             const StillSettings& settings,
                                             const std::atomic<bool>& interrupt);
  static std::unique_ptr<StillLight> prepare(const Room&&, const Solution&, const StillSettings&,
                                             const std::atomic<bool>&) = delete;
  static std::unique_ptr<StillLight> prepare(const Room&, const Solution&&, const StillSettings&,
                                             const std::atomic<bool>&) = delete;
  StillLight(const StillLight&) = delete;
  StillLight& operator=(const StillLight&) = delete;

  const Room& room() const { return *room_; }
  const Solution& solution() const { return *solution_; }
  const StillSettings& settings() const { return settings_; }
  /// Of each pixel; a power of two. Each reads its own part of the zone solution.
  std::size_t replicates() const { return replicates_; }
  const RadianceField& field() const { return field_; }
  const DirectLight& direct() const { return direct_; }
  const HemisphereGather& gather() const { return gather_; }
  const PathTracer& path() const { return path_; }

 private:
  StillLight(const Room& room, const Solution& solution, const StillSettings& settings,
             const StopToken& stop);

  const Room* room_;
  const Solution* solution_;
  StillSettings settings_;
  std::size_t replicates_;
  RadianceField field_;
  DirectLight direct_;
  HemisphereGather gather_;
  PathTracer path_;
};

}  // namespace reemit
