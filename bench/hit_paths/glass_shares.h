#pragma once

namespace reemit::hit_paths {

/// Shares of light, not polarised, that goes back from clear glass and that crosses it.
struct GlassShares {
  double reflected = 1;
  double transmitted = 0;
};

/// Angle to the normal behind a surface by Snell's law [rad], for the index of what is behind over that of
/// what is before it; negative where all light is reflected.
double refracted_angle(double ratio, double angle);

/// At one surface between clear media: Fresnel's sine and tangent laws.
GlassShares at_surface(double ratio, double angle);

/// At a thin pane of index `ior` in air, both surfaces and all that goes to and fro between them; `clear` is
/// what one pass at normal incidence leaves. Either polarisation keeps its own way.
GlassShares at_pane(double ior, double clear, double angle);

}  // namespace reemit::hit_paths
