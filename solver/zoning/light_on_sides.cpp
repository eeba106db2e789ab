#include "solver/zoning/light_on_sides.h"

#include <algorithm>
#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/zoning/light_level.h"

namespace reemit {
namespace {

constexpr LookEffort kSideEffort{2, 1, 1};

}  // namespace

std::vector<float> light_on_sides(const PilotLight& pilot, const std::vector<SideUse>& uses,
                                  const WorkWatch& watch) {
  const ZoneMesh& mesh = pilot.mesh();
  std::vector<float> levels(uses.size(), 0.0F);
  if (!(pilot.mean() > 0)) return levels;
  constexpr std::size_t kSidesPerStep = 1 << 16;
  for (std::size_t begin = 0; begin < uses.size(); begin += kSidesPerStep) {
    watch.at(static_cast<double>(begin) / static_cast<double>(uses.size()));
    const std::size_t end = std::min(begin + kSidesPerStep, uses.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 256), [&](const auto& range) {
      std::vector<SideCell> cells;
      for (std::size_t s = range.begin(); s != range.end(); ++s) {
        const SideId side(s);
        if (uses[s] == SideUse::kShared && mesh.has_zones(side))
          cells.push_back({triangle_of(side), is_front(side), {}});
      }
      std::vector<LightSpread> light(cells.size());
      PilotLight::Looker(pilot).look_at_all(cells, kSideEffort, light.data());
      for (std::size_t i = 0; i < cells.size(); ++i)
        levels[side_of(cells[i].triangle, cells[i].front).index()] =
            static_cast<float>(light_level(light[i].mean(), pilot.mean()));
    });
  }
  return levels;
}

}  // namespace reemit
