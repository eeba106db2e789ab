#include "scenes/io/native/native_view.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "scenes/io/native/native_ies_light.h"
#include "scenes/io/native/native_materials.h"
#include "scenes/model/limits.h"
#include "scenes/model/measures.h"

namespace reemit {

namespace {

/// Exactly one of the quantities must be given. `divisor`: the solid angle that turns a power into an
/// intensity.
struct LightQuantity {
  const char* key;
  bool photometric;
  double divisor;
};

Spectrum read_quantity(const JsonCursor& at, std::initializer_list<LightQuantity> choices,
                       const BandSet& bands) {
  const LightQuantity* chosen = nullptr;
  std::string names;
  for (const LightQuantity& quantity : choices) {
    names += (names.empty() ? "" : ", ") + std::string(quantity.key);
    if (!at.find(quantity.key)) continue;
    if (chosen)
      at.at(quantity.key).fail(fmt::format("\"{}\" is given already", chosen->key), "Keep one of the two.");
    chosen = &quantity;
  }
  if (!chosen) at.fail("the light has no strength", fmt::format("Give one of {}.", names));
  const JsonCursor value = at.at(chosen->key);
  const auto checked = [&value](const Spectrum& strength) {
    const std::string problem = strength_problem(strength, "the intensity [W/sr] or irradiance [W/m2]");
    if (!problem.empty()) value.fail(problem, kStrengthAdvice);
    return strength;
  };
  const auto colour = at.find("color");
  if (!chosen->photometric) {
    if (colour) colour->fail("a colour needs a photometric strength", "Give one value per band instead.");
    const Spectrum strength = read_emission(value, bands) / chosen->divisor;
    if (!(strength > 0).any()) value.fail("the light emits nothing", "Remove it or give it power.");
    return checked(strength);
  }
  const double amount = value.strength();
  if (!(amount > 0)) value.fail("the light emits nothing", "Remove it or give it power.");
  return checked(photometric_emission(amount, colour, bands) / chosen->divisor);
}

Vec3 read_direction(const JsonCursor& at) {
  const Vec3 direction = at.vec3();
  const double length = direction.stableNorm();
  if (!(length > 0) || !std::isfinite(length))
    at.fail("the direction has no length", "Give a vector that is not 0.");
  return direction / length;
}

std::string read_name(const JsonCursor& at, const std::string& otherwise) {
  const auto name = at.find("name");
  return name ? name->string() : otherwise;
}

PointLight read_point(const JsonCursor& at, const std::string& name, double unit, const BandSet& bands) {
  at.expect_object({"type", "name", "position", "intensity", "intensity_cd", "power", "flux_lm", "color"});
  constexpr double kSphere = 4 * std::numbers::pi;
  return {name, at.at("position").place() * unit,
          read_quantity(at,
                        {{"intensity", false, 1},
                         {"intensity_cd", true, 1},
                         {"power", false, kSphere},
                         {"flux_lm", true, kSphere}},
                        bands)};
}

SpotLight read_spot(const JsonCursor& at, const std::string& name, double unit, const BandSet& bands) {
  at.expect_object({"type", "name", "position", "direction", "look_at", "inner_angle_deg", "outer_angle_deg",
                    "intensity", "intensity_cd", "color"});
  SpotLight light;
  light.name = name;
  light.position = at.at("position").place() * unit;
  const auto look_at = at.find("look_at");
  if (look_at && at.find("direction"))
    look_at->fail("the direction is given already", "Keep one of the two.");
  if (look_at) {
    const Vec3 towards = look_at->place() * unit - light.position;
    if (!(towards.norm() > 0))
      look_at->fail("the light looks at its own position", "Move one of the two points.");
    light.direction = towards.normalized();
  } else if (const auto direction = at.find("direction")) {
    light.direction = read_direction(*direction);
  } else {
    at.fail("the light has no direction", "Give \"direction\", or \"look_at\", a point on its axis.");
  }
  const auto outer = at.find("outer_angle_deg");
  const auto inner = at.find("inner_angle_deg");
  light.outer_angle = (outer ? outer->number_in(0.01, 90) : 45) * kRadiansPerDegree;
  light.inner_angle = (inner ? inner->number_in(0, 90) : 0) * kRadiansPerDegree;
  if (light.inner_angle >= light.outer_angle) {
    at.fail("the inner angle of the spot is not smaller than the outer",
            "Both are half angles from the axis.");
  }
  light.intensity = read_quantity(at, {{"intensity", false, 1}, {"intensity_cd", true, 1}}, bands);
  return light;
}

DirectionalLight read_directional(const JsonCursor& at, const std::string& name, const BandSet& bands) {
  at.expect_object({"type", "name", "direction", "irradiance", "illuminance_lx", "color"});
  return {name, read_direction(at.at("direction")),
          read_quantity(at, {{"irradiance", false, 1}, {"illuminance_lx", true, 1}}, bands)};
}

Camera read_camera(const JsonCursor& at, const std::string& name, double unit) {
  at.expect_object({"name", "eye", "look_at", "up", "vertical_fov_deg", "size"});
  Camera camera;
  camera.name = name;
  camera.eye = at.at("eye").place() * unit;
  camera.look_at = at.at("look_at").place() * unit;
  if (const auto up = at.find("up")) camera.up = read_direction(*up);
  const Vec3 forward = camera.look_at - camera.eye;
  if (!(forward.norm() > 0))
    at.at("look_at").fail("the camera looks at its own eye", "Move one of the two points.");
  if (forward.normalized().cross(camera.up).norm() < 1e-6) {
    at.fail("the camera looks along its up direction", "Set \"up\" to a direction across the view.");
  }
  if (const auto fov = at.find("vertical_fov_deg")) camera.vertical_fov_deg = fov->number_in(0.01, 179);
  if (const auto size = at.find("size")) {
    size->expect_array(2, 2);
    camera.width = (*size)[0].integer_in(1, limits::kMostPixels);
    camera.height = (*size)[1].integer_in(1, limits::kMostPixels);
  }
  return camera;
}

}  // namespace

void read_lights(const JsonCursor& lights, double unit, const std::filesystem::path& folder, Scene& scene) {
  NativeIesLights measured(folder, unit, scene);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const JsonCursor at = lights[i];
    at.expect_object();
    const std::string& type = at.at("type").choice({"point", "spot", "directional", "ies"});
    const std::string name = read_name(at, fmt::format("{} {}", type, i));
    if (type == "point") {
      scene.lights.emplace_back(read_point(at, name, unit, scene.bands));
    } else if (type == "spot") {
      scene.lights.emplace_back(read_spot(at, name, unit, scene.bands));
    } else if (type == "directional") {
      scene.lights.emplace_back(read_directional(at, name, scene.bands));
    } else {
      scene.lights.emplace_back(measured.read(at, name));
    }
  }
}

void read_cameras(const JsonCursor& cameras, double unit, Scene& scene) {
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const JsonCursor at = cameras[i];
    at.expect_object();
    const std::string name = read_name(at, fmt::format("camera {}", i));
    for (const Camera& other : scene.cameras) {
      if (other.name == name)
        at.fail(fmt::format("a second camera named \"{}\"", name), "Give it another name.");
    }
    scene.cameras.push_back(read_camera(at, name, unit));
  }
}

}  // namespace reemit
