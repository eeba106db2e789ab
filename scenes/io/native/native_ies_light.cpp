#include "scenes/io/native/native_ies_light.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "scenes/io/common/up_direction.h"
#include "scenes/io/native/native_materials.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"
#include "scenes/model/opening_reach.h"

namespace reemit {
namespace {

/// `down`: where the nadir points if the file does not say.
Vec3 nadir_of(const JsonCursor& at, const Vec3& position, double unit, const Vec3& down) {
  const auto direction = at.find("direction");
  const auto look_at = at.find("look_at");
  if (look_at && direction) look_at->fail("the direction is given already", "Keep one of the two.");
  const Vec3 aim =
      look_at ? Vec3(look_at->place() * unit - position) : (direction ? direction->vec3() : down);
  const double length = aim.stableNorm();
  if (!(length > 0) || !std::isfinite(length))
    (look_at ? *look_at : *direction).fail("the direction has no length", "Choose another point or vector.");
  return aim / length;
}

/// Direction of C = 0: across the aim, as near to what was asked for as that allows.
Vec3 plane_zero_of(const JsonCursor& at, const Vec3& nadir) {
  const auto given = at.find("c0");
  constexpr double kAlong = 0.999;  // within 2.6 degrees
  const Vec3 wanted = given ? given->vec3() : (std::fabs(nadir.x()) < kAlong ? Vec3(1, 0, 0) : Vec3(0, 0, 1));
  const Vec3 unit = wanted.stableNormalized();
  const Vec3 across = unit - unit.dot(nadir) * nadir;
  constexpr double kLeastSine = 1e-6;
  if (given && !(across.norm() > kLeastSine))
    given->fail("the direction of C = 0 has no length or lies along the aim", "Choose one across the aim.");
  return across.normalized();
}

Eigen::Matrix3d orientation_of(const JsonCursor& at, const Vec3& position, double unit, const Vec3& down) {
  const Vec3 nadir = nadir_of(at, position, unit, down);
  const Vec3 up = -nadir;
  Vec3 zero = plane_zero_of(at, nadir);
  if (const auto turn = at.find("rotate_deg"))
    zero = Eigen::AngleAxisd(turn->number() * std::numbers::pi / 180, up) * zero;
  Eigen::Matrix3d axes;
  axes.col(0) = zero;
  axes.col(1) = up.cross(zero);
  axes.col(2) = up;
  return axes;
}

/// From the given position to the middle of the opening: how far an opening of this size must stand off what
/// it is mounted on to touch it from outside [m].
Vec3 mount_offset(const JsonCursor& at, const PhotometricLight& light) {
  const auto mount = at.find("mount");
  const std::string kind = mount ? mount->choice({"free", "ceiling", "wall"}) : "free";
  const auto away = at.find("away");
  if (kind == "free") {
    if (away) away->fail("the luminaire is not mounted on anything", "Add \"mount\", or remove this.");
    return Vec3::Zero();
  }
  if (kind == "wall" && !away)
    mount->fail("the file does not say on which side of the wall the luminaire is",
                "Add \"away\": the direction from the wall into the room.");
  const Vec3 out = away ? away->vec3() : Vec3(-light.orientation.col(2));
  const double length = out.stableNorm();
  if (!(length > 0) || !std::isfinite(length))
    away->fail("the direction has no length", "Give the direction from what it is mounted on into the room.");
  const Vec3 unit = out / length;
  return opening_reach(light.opening, light.orientation.transpose() * unit) * unit;
}

}  // namespace

PhotometricLight NativeIesLights::read(const JsonCursor& at, const std::string& name) {
  at.expect_object({"type", "name", "file", "position", "direction", "look_at", "c0", "rotate_deg", "color",
                    "scale", "flux_lm", "opening", "mount", "away"});
  const JsonCursor path = at.at("file");
  const MeasuredLuminaire* file = nullptr;
  try {
    file = &library_.load(folder_ / path.string(), scene_.warnings, scene_.notes);
  } catch (const InputError& error) {
    throw InputError(path.where(), std::string("the luminaire cannot be read: ") + error.what(), "");
  }
  PhotometricLight light;
  light.name = name;
  light.position = at.at("position").place() * unit_;
  light.orientation = orientation_of(at, light.position, unit_, -up_direction(scene_));
  light.table = file->table;
  const auto opening = at.find("opening");
  if (!opening || opening->choice({"file", "point"}) == "file") light.opening = file->opening;
  light.position += mount_offset(at, light);
  const auto scale = at.find("scale");
  const auto flux = at.find("flux_lm");
  if (scale && flux) flux->fail("\"scale\" is given already", "Keep one of the two.");
  const double dimming =
      scale ? scale->strength() : (flux ? flux->strength() / light.table->total_flux() : 1.0);
  if (!(dimming > 0)) (scale ? *scale : *flux).fail("the light emits nothing", "Remove it or give it power.");
  light.intensity_per_candela = dimming * photometric_emission(1, at.find("color"), scene_.bands);
  const std::string problem = strength_problem(
      light.intensity_per_candela * light.table->greatest_intensity(), "the greatest intensity [W/sr]");
  if (!problem.empty()) (scale ? *scale : flux ? *flux : path).fail(problem, kStrengthAdvice);
  return light;
}

}  // namespace reemit
