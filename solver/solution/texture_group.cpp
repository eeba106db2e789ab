#include "solver/solution/texture_group.h"

#include <algorithm>
#include <limits>

#include "solver/solution/file_damage.h"

namespace reemit {

void write_textures(const Hdf5Group& root, const Solution& solution) {
  if (solution.zone_reflectances.empty()) return;
  const Hdf5Group group = root.create_group("textures");
  const Hdf5Shape shape{solution.mesh.zone_count(), solution.bands.count()};
  group.write<double>("reflectance", solution.zone_reflectances, shape, "1",
                      "diffuse reflectance of each zone, its mean over the textures there");
  group.write<double>("emitted", solution.zone_exitances, shape, "W/m2",
                      "emitted by each zone, its mean over the textures there");
  if (!solution.mesh.solid_shares().empty())
    group.write<float>("solid_share", solution.mesh.solid_shares(), {solution.mesh.zone_count()}, "1",
                       "share of each zone that is there; areas of zones are of that alone");
}

void read_textures(const Hdf5Group& root, Solution& solution) {
  if (!root.has_dataset("textures")) return;
  const Hdf5Group group = root.open_group("textures");
  const Hdf5Shape shape{solution.mesh.zone_count(), solution.bands.count()};
  solution.zone_reflectances = group.read<double>("reflectance", shape);
  solution.zone_exitances = group.read<double>("emitted", shape);
  require_intact(std::all_of(solution.zone_reflectances.begin(), solution.zone_reflectances.end(),
                             [](double x) { return x >= 0 && x <= 1; }),
                 "reflectance of a zone outside [0,1]");
  require_intact(std::all_of(solution.zone_exitances.begin(), solution.zone_exitances.end(),
                             [](double x) { return x >= 0 && x <= std::numeric_limits<double>::max(); }),
                 "negative or infinite emission of a zone");
  if (group.has_dataset("solid_share"))
    solution.mesh.set_solid_shares(group.read<float>("solid_share", {solution.mesh.zone_count()}));
}

}  // namespace reemit
