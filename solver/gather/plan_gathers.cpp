#include "solver/gather/plan_gathers.h"

#include <utility>

#include "solver/gather/caustic_shots.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/radiance_field.h"
#include "solver/gather/uneven_zones.h"

namespace reemit {

void plan_uneven_zones(const RadianceField& field, const StopToken& stop, Solution& solution) {
  GatherPlan& plan = solution.gather_plan;
  plan.seed = solution.settings.seed;
  plan.uneven.clear();
  const DirectLight direct(field.room());
  std::vector<std::uint8_t> uneven = uneven_zones(field, direct, plan.seed, &stop);
  if (!stop.requested()) plan.uneven = std::move(uneven);
}

void plan_caustic_packets(const Room& room, const StopToken& stop, Solution& solution) {
  GatherPlan& plan = solution.gather_plan;
  plan.seed = solution.settings.seed;
  plan.caustics.reset();
  if (!room.surfaces().any_specular() || stop.requested()) return;
  CausticPackets packets = find_caustic_packets(CausticShooter(room, plan.seed), &stop);
  if (!stop.requested()) plan.caustics = std::move(packets);
}

}  // namespace reemit
