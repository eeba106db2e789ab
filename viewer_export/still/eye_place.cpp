#include "viewer_export/still/eye_place.h"

#include <algorithm>
#include <cmath>

#include "solver/sampling/sphere_lattice.h"
#include "viewer_export/still/camera.h"

namespace reemit {
namespace {

constexpr int kSurroundRays = 256;
constexpr int kPictureSide = 16;     // rays across and down the picture
constexpr double kMostWrong = 0.95;  // share of sights without light from which on a place is wrong
constexpr double kOutside = 0.1;     // share of directions that meet nothing from which on it is outside

/// What rays from an eye met.
struct Sights {
  int all = 0;
  int nothing = 0;
  int lit = 0;
  int backs = 0;        ///< Of one-sided faces: a camera looks through them.
  int from_behind = 0;  ///< Sides that are not the front, those included.

  void add(const Room& room, const Solution& solution, const Vec3f& origin, const Vec3f& direction) {
    ++all;
    Hit hit;
    if (!room.rays().closest(origin, direction, hit)) {
      ++nothing;
      return;
    }
    if (!hit.front) ++from_behind;
    const ZoneId zone = room.mesh().zone_at(hit.triangle, hit.u, hit.v, hit.front);
    if (!zone.valid()) {
      ++backs;
      return;
    }
    bool lights = room.surfaces().emits(hit.triangle, hit.front);
    for (std::size_t b = 0; b < room.band_count(); ++b)
      lights = lights || solution.irradiance(zone, b).mean > 0;
    if (lights) ++lit;
  }
  int met() const { return all - nothing; }
  bool is_wrong() const { return lit < (1 - kMostWrong) * met(); }
};

bool is_dark(const Solution& solution) {
  const auto is_zero = [](double sum) { return sum == 0; };
  const ZoneSums& sums = solution.sums;
  return std::all_of(sums.direct.begin(), sums.direct.end(), is_zero) &&
         std::all_of(sums.caustic.begin(), sums.caustic.end(), is_zero) &&
         std::all_of(sums.indirect.begin(), sums.indirect.end(), is_zero);
}

Sights around(const Vec3f& eye, const Room& room, const Solution& solution) {
  Sights sights;
  for (int i = 0; i < kSurroundRays; ++i) {
    const auto [z, azimuth] = sphere_lattice(i, kSurroundRays);
    const double r = std::sqrt(1 - z * z);
    const Vec3 direction(r * std::cos(azimuth), r * std::sin(azimuth), z);
    sights.add(room, solution, eye, direction.cast<float>().normalized());
  }
  return sights;
}

Sights in_picture(const Camera& camera, const Room& room, const Solution& solution) {
  const PinholeCamera pinhole(camera, kPictureSide, kPictureSide, room.rays());
  Sights sights;
  for (int y = 0; y < kPictureSide; ++y)
    for (int x = 0; x < kPictureSide; ++x) {
      const PinholeCamera::Ray ray = pinhole.ray(x + 0.5, y + 0.5);
      sights.add(room, solution, ray.origin, ray.direction);
    }
  return sights;
}

}  // namespace

std::string eye_warning(const Camera& camera, const Room& room, const Solution& solution) {
  const Sights picture = in_picture(camera, room, solution);
  // From afar too few of the rays to all sides meet the room.
  const Vec3f eye = room.rays().normalised(camera.eye);
  const bool near = eye.norm() < 4;
  const Sights all = near ? around(eye, room, solution) : picture;
  if (all.met() == 0 && picture.met() == 0)
    return "nothing of the room is in the picture; check the eye and what it looks at";
  if (is_dark(solution)) return {};  // light tells nothing
  if (!all.is_wrong() || (picture.met() > 0 && !picture.is_wrong())) return {};
  const bool outside = !near || all.nothing > kOutside * all.all;
  if (outside && picture.backs > 0.5 * picture.met())
    return "the eye is outside of the room and looks in through the backs of one-sided faces, which are not "
           "shown; move it inside for a view with all walls";
  if (outside)
    return "the eye is outside of the room and sees its outer sides, where no light comes; move it inside";
  if (all.from_behind > kMostWrong * all.met())
    return "the eye is inside of a wall or a solid, where no light comes; move it into the room";
  return "no light comes to anything around the eye; it stands in a void or in a part of the room that the "
         "luminaires do not reach";
}

}  // namespace reemit
