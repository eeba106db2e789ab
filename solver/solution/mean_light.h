#pragma once
#include <vector>

#include "solver/solution/solution.h"

namespace reemit {

/// Area-weighted means over zones of one material. Standard errors come from the spread of the same means in
/// the batch groups (ZoneSums::kGroups), so they hold how the errors of zones and of bands go together; they
/// are infinite with one batch and 0 without any, as those of a zone. Where packets bring the light, the
/// variance is that of one packet more than came: so what few met, or none, is not taken for exact.
struct MeanLight {
  double area = 0;                   ///< [m2]
  std::vector<Estimate> irradiance;  ///< Per band [W/m2].
  std::vector<Estimate> exitance;    ///< Reflected, let through diffusely and emitted, per band [W/m2].
  Estimate illuminance;              ///< [lx]
  Estimate luminous_exitance;        ///< The same [lm/m2].
};

/// The light on one side of a surface.
struct SideLight {
  SurfaceId surface;
  bool front = true;
  /// False for a side that no light reached and that does not emit, as the outside of two-sided walls, unless
  /// it is the front of a surface that is dark on both sides.
  bool counts = true;
  MeanLight light;
};

struct RoomLight {
  std::vector<SideLight> sides;      ///< Those that have zones, by surface, fronts first.
  std::vector<MeanLight> materials;  ///< By MaterialId, over the sides that count; area 0 if there are none.
  double degrees_of_freedom = 0;     ///< Of the standard errors, for Student's t.
};

/// Pre: the zones of `solution` are those of its surfaces and materials, as load_solution checks.
RoomLight mean_light(const Solution& solution);

/// Power of this irradiance on all zones per ray that packets took, by band [W]; 0 without packets.
Spectrum incident_power_per_ray(const Solution& solution,
                                Solution::Irradiance irradiance = &Solution::irradiance);

}  // namespace reemit
