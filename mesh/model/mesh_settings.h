#pragma once
#include <optional>

namespace reemit {

/// How a room is cut into zones.
struct MeshSettings {
  /// Largest area of the zones that large faces are cut into [m2], > 0. Unset: such that there are about
  /// default_zone_count zones, both sides counted.
  std::optional<double> zone_area = std::nullopt;
  int default_zone_count = 8000;  ///< Zones aimed at when zone_area is unset [1, 1e8].
  double smallest_angle_deg =
      20.0;  ///< Quality bound of the base triangulation where the input allows it [0, 30].
  double crease_angle_deg =
      30.0;  ///< Neighbouring faces that bend less share vertices (curved surfaces) [0, 180].
  /// Spheres, disks, cylinders and cones stay what they are. Else they become flat faces, as a method that
  /// needs flat zones asks for.
  bool exact_shapes = true;
  /// Small sides of triangles share zones, and so do sides that no light reaches (build_zones), so that there
  /// are about as many as asked for in rooms of many triangles. Else every side of a triangle has its own.
  bool share_zones = true;
};

}  // namespace reemit
