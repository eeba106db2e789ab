#pragma once
#include <span>
#include <variant>

#include "scenes/model/luminaire.h"
#include "solver/emit/directional_emitter.h"
#include "solver/emit/photometric_emitter.h"
#include "solver/emit/point_emitter.h"
#include "solver/emit/spot_emitter.h"

namespace reemit {

/// A luminaire that rays do not see, in the normalised space. Each kind has a file of its own, with the
/// members that the functions below call; a further kind is a further file and a further name here.
using PunctualEmitter = std::variant<PointEmitter, SpotEmitter, DirectionalEmitter, PhotometricEmitter>;

/// `rays`: of the room, for its normalised space.
PunctualEmitter make_punctual_emitter(const PunctualLight& light, const RayTracer& rays);

/// Intensity [W/sr] on the axis, irradiance [W/m2] across the beam of a directional light, or intensity per
/// candela of a measured luminaire.
const Spectrum& strength_of(const PunctualLight& light);
/// Power that packets of the light carry [W] per band, in a room of this size (RayTracer::metres_per_unit),
/// which only light at infinity asks for.
Spectrum light_power(const PunctualLight& light, double metres_per_unit);
/// Whether the light comes from infinitely far away, and so from nowhere in the room.
bool is_at_infinity(const PunctualLight& light);

/// Irradiance at x with unit normal n per unit of strength_of (so [1/m2] for an intensity, [1] for a
/// directional light) if nothing is in the way: I cos(theta) / r^2 with r in metres. Of an opening, whose
/// light comes from many points, about that (PhotometricEmitter::expected_irradiance). 0 only if the
/// luminaire cannot light x.
inline float expected_irradiance(const PunctualEmitter& emitter, const Vec3f& x, const Vec3f& n) {
  return std::visit([&](const auto& e) { return e.expected_irradiance(x, n); }, emitter);
}
/// The point that lights x, drawn by u0, u1 where there are many. The mean of the factor over u0, u1 is the
/// irradiance if nothing is in the way.
inline LuminaireSample sample_light(const PunctualEmitter& emitter, const Vec3f& x, const Vec3f& n, float u0,
                                    float u1) {
  return std::visit([&](const auto& e) { return e.sample(x, n, u0, u1); }, emitter);
}
inline bool is_at_infinity(const PunctualEmitter& emitter) {
  return std::visit([](const auto& e) { return e.kAtInfinity; }, emitter);
}
/// For a light tree; `strength`: strength_of, all bands. Pre: not at infinity.
LuminaireBounds bounds_of_light(const PunctualEmitter& emitter, float strength);
/// Where the light shines out of: what lies between a point of the luminaire and here parts it from the room.
/// Pre: not at infinity.
Vec3f mouth_of_light(const PunctualEmitter& emitter);
/// Start of a packet, all of which carry the same power. u0, u1 place it, u2, u3 turn it.
inline LightRay start_light_ray(const PunctualEmitter& emitter, float u0, float u1, float u2, float u3) {
  return std::visit([&](const auto& e) { return e.start_ray(u0, u1, u2, u3); }, emitter);
}

/// The same for 16 packets at most.
inline void start_light_rays(const PunctualEmitter& emitter, const LightNumbers& u,
                             std::span<LightRay> rays) {
  std::visit(
      [&](const auto& e) {
        if constexpr (requires { e.start_rays(u, rays); }) {
          e.start_rays(u, rays);
        } else {
          for (std::size_t i = 0; i < rays.size(); ++i)
            rays[i] = e.start_ray(u[0][i], u[1][i], u[2][i], u[3][i]);
        }
      },
      emitter);
}

}  // namespace reemit
