#include "mesh/repair/dropped_luminaires.h"

#include <vector>

#include <fmt/format.h>

#include "mesh/pieces/face_notes.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

constexpr double kLeastShare = 1e-6;  // of the power; less is slivers at the poles of a tessellated sphere
constexpr std::size_t kMostNames = 3;

std::string name_of(const Scene& scene, std::size_t s) {
  const Surface& surface = scene.surfaces[s];
  if (surface.faces.size() == 1) return face_name(scene, SurfaceId(s), 0);
  const std::string& source = surface.source.empty() ? scene.source : surface.source;
  return fmt::format("'{}' ({}{}{} faces)", surface.name, source, source.empty() ? "" : ", ",
                     surface.faces.size());
}

}  // namespace

void check_dropped_luminaires(const Scene& scene, double weld, MeshReport& report) {
  double emitted = 0;  // [W] as read, summed over bands; both sides where both emit
  double lost = 0;
  bool any_left = !scene.lights.empty();
  std::size_t count = 0;
  std::string names;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Material& material = scene.material_of(scene.surfaces[s]);
    if (!material.emits()) continue;
    const SurfaceAreas& areas = report.surfaces[s];
    const double exitance = material.exitance().sum() * (material.emits_both_sides ? 2 : 1);
    emitted += exitance * areas.input;
    any_left |= areas.meshed > 0;
    if (!(areas.collapsed > 0)) continue;
    lost += exitance * areas.collapsed;
    if (++count <= kMostNames) names += (names.empty() ? "" : ", ") + name_of(scene, s);
  }
  if (!(lost > kLeastShare * emitted)) return;
  if (count > kMostNames) names += fmt::format(" and {} more", count - kMostNames);
  const std::string why =
      fmt::format("smaller or thinner than the {:.2g} m below which points of this room count as one", weld);
  if (!any_left)
    throw InputError(fmt::format("luminaire {}", names),
                     fmt::format("it is {}, and nothing else lights the room", why),
                     "Give it a size, use a point light, or check the unit of length.");
  report.warnings.push_back(
      fmt::format("{:.3g} % of the power of luminous surfaces is lost, because they are {}: {}",
                  100 * lost / emitted, why, names));
}

}  // namespace reemit
