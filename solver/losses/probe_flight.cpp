#include "solver/losses/probe_flight.h"

#include <fmt/format.h>

namespace reemit {

std::string quoted_name(const Scene& scene, SurfaceId surface) {
  const std::string& name = scene.surfaces[surface.index()].name;
  return name.empty() ? fmt::format("surface {}", surface.index()) : "'" + name + "'";
}

std::string share_text(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

std::string place_text(const Vec3& point) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", point.x(), point.y(), point.z());
}

}  // namespace reemit
