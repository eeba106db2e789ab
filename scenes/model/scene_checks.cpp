#include "scenes/model/scene_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <type_traits>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/model/error.h"
#include "scenes/model/limits.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

std::string in_file(const Scene& scene, const std::string& what) {
  return scene.source.empty() ? what : scene.source + ": " + what;
}

std::string listed(const Spectrum& s) {
  std::string text;
  for (const double value : s) text += fmt::format("{}{:.6g}", text.empty() ? "" : " ", value);
  return text;
}

void check_size(Spectrum& s, const Scene& scene, const std::string& where, const char* what) {
  const auto bands = static_cast<Eigen::Index>(scene.bands.count());
  if (s.size() == 0) s = Spectrum::Zero(bands);
  if (s.size() != bands)
    throw InputError(where, fmt::format("{} has {} values", what, s.size()),
                     fmt::format("Give one value per band; the room has {}.", bands));
}

void check_fraction(const Spectrum& s, const std::string& where, const char* what) {
  if (!s.isFinite().all() || (s < 0).any() || (s > 1).any())
    throw InputError(
        where, fmt::format("{} {} is outside [0, 1]", what, listed(s)),
        "A surface cannot send back less than nothing or more light than it gets: give fractions, not "
        "percent or 0-255.");
}

void check_power(const Spectrum& s, const std::string& where, const char* what) {
  if (!s.isFinite().all() || (s < 0).any())
    throw InputError(where, fmt::format("{} {} is negative or not a number", what, listed(s)),
                     "Give a finite value of 0 or more in every band.");
  const std::string problem = strength_problem(s, what);
  if (!problem.empty()) throw InputError(where, problem, kStrengthAdvice);
}

void check_place(const Vec3& place, const char* what, const std::string& where) {
  if (!place.allFinite())
    throw InputError(where, fmt::format("{} has a coordinate that is infinite or not a number", what),
                     "Repair the coordinates in the program that wrote the file.");
  const std::string problem = place_problem(place);
  if (!problem.empty()) throw InputError(where, problem, kLengthAdvice);
}

/// A light or a camera, which need not be where the surfaces are.
void check_near_room(const Vec3& place, const char* what, const Box& room, const std::string& where) {
  check_place(place, what, where);
  const std::string problem = distance_problem(place, room.centre(), room.size().maxCoeff());
  if (!problem.empty())
    throw InputError(where, problem, "Move it nearer; for light from afar use a directional light.");
}

/// Takes from the specular parts what all parts together have more than 1.
void limit_to_all_light(Material& m, Scene& scene, const std::string& where) {
  NonDiffusePart& rest = m.non_diffuse;
  const Spectrum sum = m.share_of_light();
  if (sum.maxCoeff() <= Material::kAllLight) return;
  scene.warnings.push_back(fmt::format(
      "{}: it reflects and transmits {:.4g} of the light, more than it gets; its mirror and glass "
      "parts are made less until nothing is gained, so that it absorbs nothing. Give shares that add up to "
      "what it reflects.",
      where, sum.maxCoeff()));
  Spectrum excess = (sum - 1).max(0);
  const auto take = [&](Spectrum& s) {
    if (s.size() == 0) return;
    const Spectrum taken = excess.min(s);
    s -= taken;
    excess -= taken;
  };
  if (rest.angle_law != AngleLaw::kDielectric) take(rest.specular_transmittance);
  if (rest.angle_law != AngleLaw::kConductor) take(rest.specular_reflectance);
  take(rest.diffuse_transmittance);
}

void check_specular(Material& m, Scene& scene, const std::string& where) {
  NonDiffusePart& rest = m.non_diffuse;
  for (const double roughness : {rest.roughness, rest.transmission_roughness})
    if (!(roughness >= 0 && roughness <= 1))
      throw InputError(where, fmt::format("roughness {} is outside [0, 1]", roughness),
                       "Give 0 (a mirror) to 1.");
  if (!(rest.index_of_refraction >= 1 && rest.index_of_refraction <= NonDiffusePart::kLargestIndex))
    throw InputError(where, fmt::format("index of refraction {}", rest.index_of_refraction),
                     "Give 1 (no refraction) to 100; window glass has 1.52, water 1.33.");
  if (rest.angle_law == AngleLaw::kConductor) {
    check_size(rest.metal_eta, scene, where, "eta of the metal");
    check_size(rest.metal_k, scene, where, "k of the metal");
    constexpr double kMost = NonDiffusePart::kLargestIndex;
    if (!(rest.metal_eta > 0 && rest.metal_eta <= kMost).all() ||
        !(rest.metal_k >= 0 && rest.metal_k <= kMost).all())
      throw InputError(
          where, fmt::format("eta {} and k {} of a metal", listed(rest.metal_eta), listed(rest.metal_k)),
          "Give an eta above 0 and a k of 0 or more, neither above 100.");
    if (rest.transmits_specularly())
      throw InputError(where, "a metal with eta and k that lets light through",
                       "Give the shares of a half-silvered sheet as mirror and transmittance.");
  }
  if (rest.absorption_per_m.size() > 0) {
    check_size(rest.absorption_per_m, scene, where, "absorption");
    if (!rest.absorption_per_m.isFinite().all() || (rest.absorption_per_m < 0).any())
      throw InputError(where, fmt::format("absorption {} per metre", listed(rest.absorption_per_m)),
                       "Give a finite value of 0 or more in every band.");
  }
  limit_to_all_light(m, scene, where);
  // Light that crosses a face meets its back on the way out.
  if (rest.transmits_specularly() || rest.transmits_diffusely()) m.two_sided = true;
}

void check_material(Material& m, Scene& scene, const std::string& where) {
  check_size(m.reflectance, scene, where, "reflectance");
  check_size(m.emitted_radiance, scene, where, "emitted radiance");
  check_fraction(m.reflectance, where, "reflectance");
  check_power(m.emitted_radiance, where, "emitted radiance");
  NonDiffusePart& rest = m.non_diffuse;
  const auto check_rest = [&](Spectrum& s, const char* what) {
    if (s.size() == 0) return;
    check_size(s, scene, where, what);
    check_fraction(s, where, what);
  };
  check_rest(m.back_reflectance, "reflectance of the back");
  check_rest(rest.specular_reflectance, "specular reflectance");
  check_rest(rest.diffuse_transmittance, "diffuse transmittance");
  check_rest(rest.specular_transmittance, "specular transmittance");
  check_specular(m, scene, where);
  constexpr double kNarrowest = 1e4;
  if (!(m.emission_exponent >= 0 && m.emission_exponent <= kNarrowest))
    throw InputError(where, fmt::format("emission exponent {}", m.emission_exponent),
                     "Give 0 (Lambertian) to 10000 (a narrow beam).");
  if (m.emits_both_sides && !m.two_sided)
    throw InputError(where, "emits from both sides but is one-sided",
                     "Make the material two-sided, or let only its front emit.");
}

std::string face_name(const Scene& scene, const Surface& surface, std::size_t face) {
  const std::uint32_t line = surface.faces[face].source_line;
  const std::string& file = surface.source.empty() ? scene.source : surface.source;
  return fmt::format("{}{}surface '{}', face {}", file,
                     line != 0 ? fmt::format(":{}: ", line) : (file.empty() ? "" : ": "), surface.name,
                     face + 1);
}

void check_loop(const std::vector<std::uint32_t>& loop, const std::vector<Vec3>& points,
                const std::string& where) {
  if (loop.size() < 3)
    throw InputError(where, fmt::format("a loop has {} vertices", loop.size()),
                     "A polygon and each of its holes need at least 3 vertices.");
  for (const std::uint32_t index : loop) {
    if (index >= points.size())
      throw InputError(where, fmt::format("vertex index {} is out of range", index),
                       fmt::format("The surface has {} vertices, counted from 0.", points.size()));
    check_place(points[index], "a vertex", where);
  }
}

// Unit normals, one per outer vertex; false if that cannot be had.
bool usable_normals(const Face& face, Surface& surface, const std::string& where) {
  if (face.normals.size() != face.outer.size())
    throw InputError(where, fmt::format("{} normals for {} vertices", face.normals.size(), face.outer.size()),
                     "Give one normal per outer vertex, or none.");
  for (const std::uint32_t index : face.normals) {
    if (index >= surface.normals.size())
      throw InputError(where, fmt::format("normal index {} is out of range", index),
                       fmt::format("The surface has {} normals, counted from 0.", surface.normals.size()));
    Vec3& normal = surface.normals[index];
    const double length = normal.stableNorm();
    if (!std::isfinite(length) || length <= 0) return false;
    if (std::abs(length - 1) > 1e-12) normal /= length;
  }
  return true;
}

void check_shape(const CurvedShape& shape, const std::string& where) {
  const auto [low, high] = shape_bounds(shape);
  check_place(low, "it", where);
  check_place(high, "it", where);
  // In this order: areas of what has negative radii may be positive.
  const bool is_sound = std::visit(
      [](const auto& s) {
        using Kind = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<Kind, Disk>)
          return s.inner_radius >= 0 && s.inner_radius < s.radius &&
                 std::abs(s.normal.squaredNorm() - 1) < 1e-9;
        else if constexpr (std::is_same_v<Kind, Cone>)
          return s.base_radius >= 0 && s.top_radius >= 0;
        else
          return s.radius > 0;
      },
      shape);
  if (!is_sound || !(shape_area(shape) > 0))
    throw InputError(
        where,
        "it has no area: a radius or length is zero or negative, a hole as wide as its disk, or a "
        "normal not of length 1",
        "Give a positive radius and length, or remove the shape.");
}

void check_direction(Vec3& direction, const std::string& where) {
  const double length = direction.stableNorm();
  if (!std::isfinite(length) || length <= 0)
    throw InputError(where, "the direction is zero or not a number",
                     "Give a direction of any length above 0.");
  direction /= length;
}

// The power of a light: as check_power, and some of it.
void check_strength(Spectrum& s, const Scene& scene, const std::string& where, const char* what) {
  check_size(s, scene, where, what);
  check_power(s, where, what);
  if (!(s > 0).any())
    throw InputError(where, fmt::format("the light emits nothing: its {} is 0", what),
                     "Remove it or give it power.");
}

void check_light(PointLight& light, Scene& scene, const Box& room, const std::string& where) {
  check_strength(light.intensity, scene, where, "intensity");
  check_near_room(light.position, "the position", room, where);
}

void check_light(SpotLight& light, Scene& scene, const Box& room, const std::string& where) {
  check_strength(light.intensity, scene, where, "intensity");
  check_near_room(light.position, "the position", room, where);
  check_direction(light.direction, where);
  constexpr double kSlack = 1e-6;  // pi/2 written with single precision
  if (!(light.inner_angle >= 0 && light.inner_angle < light.outer_angle &&
        light.outer_angle <= std::numbers::pi / 2 + kSlack))
    throw InputError(where,
                     fmt::format("cone angles {:.4g} and {:.4g} rad", light.inner_angle, light.outer_angle),
                     "Half angles must satisfy 0 <= inner < outer <= pi/2.");
}

void check_light(DirectionalLight& light, Scene& scene, const Box&, const std::string& where) {
  check_strength(light.irradiance, scene, where, "irradiance");
  check_direction(light.direction, where);
}

void check_light(PhotometricLight& light, Scene& scene, const Box& room, const std::string& where) {
  if (!light.table) throw InputError(where, "it has no intensities", "Name the file of the luminaire.");
  check_size(light.intensity_per_candela, scene, where, "intensity");
  Spectrum greatest = light.intensity_per_candela * light.table->greatest_intensity();
  check_strength(greatest, scene, where, "intensity");
  constexpr double kSlack = 1e-6;
  const Eigen::Matrix3d square = light.orientation.transpose() * light.orientation;
  if (!square.isApprox(Eigen::Matrix3d::Identity(), kSlack))
    throw InputError(where, "its axes are not unit vectors at right angles",
                     "Place the luminaire by rotations only.");
  const Vec3 size = light.opening.size();
  if (!size.allFinite() || (size.array() < 0).any())
    throw InputError(where, "the size of its opening is negative or not a number", "Give 0 or more.");
  const Vec3 reach = Vec3::Constant(size.maxCoeff());
  check_near_room(light.position - reach, "the position", room, where);
  check_near_room(light.position + reach, "the position", room, where);
}

void check_camera(const Camera& camera, const Box& room, const std::string& where) {
  if (!camera.up.allFinite()) throw InputError(where, "up is not a number", "Give finite x, y, z.");
  check_near_room(camera.eye, "the eye", room, where);
  check_place(camera.look_at, "the look-at point", where);
  const Vec3 view = camera.look_at - camera.eye;
  if (view.stableNorm() <= 0)
    throw InputError(where, "the eye is the point it looks at", "Move one of the two.");
  constexpr double kLeastSine = 1e-6;
  if (camera.up.stableNorm() <= 0 ||
      view.stableNormalized().cross(camera.up.stableNormalized()).norm() < kLeastSine)
    throw InputError(where, "up is zero or along the viewing direction", "Choose another up vector.");
  if (!(camera.vertical_fov_deg > 0 && camera.vertical_fov_deg < 180))
    throw InputError(where, fmt::format("field of view {:.6g} degrees", camera.vertical_fov_deg),
                     "It must lie between 0 and 180 degrees.");
  using limits::kMostPixels;
  if (camera.width < 1 || camera.height < 1 || camera.width > kMostPixels || camera.height > kMostPixels)
    throw InputError(where, fmt::format("image of {} x {} pixels", camera.width, camera.height),
                     fmt::format("Width and height must be 1 ... {}.", kMostPixels));
}

}  // namespace

void check_materials(Scene& scene) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    const std::string name =
        m.name.empty() ? fmt::format("material {}", i + 1) : fmt::format("material '{}'", m.name);
    check_material(m, scene, in_file(scene, name));
  }
}

void check_geometry(Scene& scene) {
  std::erase_if(scene.surfaces, [](const Surface& s) { return s.empty(); });
  if (scene.surfaces.empty()) {
    // What was left out says why.
    const std::size_t told = std::min<std::size_t>(scene.warnings.size(), 3);
    const auto last = scene.warnings.end() - static_cast<std::ptrdiff_t>(told);
    throw InputError(in_file(scene, "room"), "it has no faces",
                     fmt::format("A room needs at least one polygon.{}{}", told > 0 ? " " : "",
                                 fmt::join(last, scene.warnings.end(), " ")));
  }
  std::size_t flattened = 0;
  for (Surface& surface : scene.surfaces) {
    if (surface.material.index() >= scene.materials.size())
      throw InputError(in_file(scene, fmt::format("surface '{}'", surface.name)), "it has no material",
                       "Give every surface a material of the room.");
    for (std::size_t i = 0; i < surface.shapes.size(); ++i)
      check_shape(surface.shapes[i],
                  in_file(scene, fmt::format("surface '{}', shape {}", surface.name, i + 1)));
    for (std::size_t i = 0; i < surface.faces.size(); ++i) {
      Face& face = surface.faces[i];
      const std::string where = face_name(scene, surface, i);
      check_loop(face.outer, surface.positions, where);
      for (const auto& hole : face.holes) check_loop(hole, surface.positions, where);
      if (!face.normals.empty() && !usable_normals(face, surface, where)) {
        face.normals.clear();
        ++flattened;
      }
    }
  }
  const double longest = bounds(scene).size().maxCoeff();
  if (longest < limits::kSmallestRoom)
    throw InputError(
        in_file(scene, "room"),
        fmt::format("its longest side is {:g} m; the least is {:g} m", longest, limits::kSmallestRoom),
        kLengthAdvice);
  if (flattened > 0)
    scene.warnings.push_back(fmt::format(
        "{} face(s) have a shading normal that is zero or not a number and are shown flat.", flattened));
}

void check_luminous_surfaces(const Scene& scene) {
  constexpr double kFlat = 1e-12;  // area over the square of the size of a face whose corners lie on a line
  for (const Surface& surface : scene.surfaces) {
    if (!scene.material_of(surface).emits() || !surface.shapes.empty()) continue;
    const bool has_area = std::any_of(surface.faces.begin(), surface.faces.end(), [&](const Face& face) {
      const Vec3& first = surface.positions[face.outer[0]];
      double size2 = 0;
      for (const std::uint32_t v : face.outer)
        size2 = std::max(size2, (surface.positions[v] - first).squaredNorm());
      return 2 * outline_area(surface.positions, face.outer).norm() > kFlat * size2;
    });
    if (!has_area)
      throw InputError(in_file(scene, fmt::format("surface '{}'", surface.name)),
                       "it is a luminaire without an area: the corners of its faces lie on a line",
                       "Give it an area, use a point light, or remove it.");
  }
}

void check_lights(Scene& scene) {
  const Box room = bounds(scene);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    std::visit(
        [&](auto& light) {
          const std::string name =
              light.name.empty() ? fmt::format("light {}", i + 1) : fmt::format("light '{}'", light.name);
          check_light(light, scene, room, in_file(scene, name));
        },
        scene.lights[i]);
  }
}

void check_sky(Scene& scene) {
  if (!scene.sky) return;
  Sky& sky = *scene.sky;
  const std::string where = in_file(scene, "sky");
  if (sky.kind != SkyKind::kImage && sky.kind != SkyKind::kNone)
    check_strength(sky.irradiance, scene, where, "irradiance");
  if (sky.kind == SkyKind::kImage &&
      (!sky.image ||
       sky.image->radiance.size() != sky.image->rows * sky.image->columns * scene.bands.count()))
    throw InputError(where, "its image does not have one value per pixel and band", "Read it again.");
  if (sky.ground_reflectance.size() > 0) {
    check_size(sky.ground_reflectance, scene, where, "reflectance of the ground");
    check_fraction(sky.ground_reflectance, where, "reflectance of the ground");
  }
  if (!sky.sun) return;
  if (sky.sun->irradiance.size() > 0) {
    check_size(sky.sun->irradiance, scene, where, "irradiance of the sun");
    check_power(sky.sun->irradiance, where, "irradiance of the sun");
  }
  if (!(sky.sun->altitude > 0 && sky.sun->altitude <= std::numbers::pi / 2) ||
      !std::isfinite(sky.sun->azimuth) || !(sky.sun->half_angle > 0 && sky.sun->half_angle < 0.2))
    throw InputError(where, "the sun is not above the horizon", "Give an altitude between 0 and 90 degrees.");
}

void check_cameras(Scene& scene) {
  const Box room = bounds(scene);
  std::set<std::string> names;
  for (Camera& camera : scene.cameras) {
    if (camera.name.empty()) camera.name = "camera";
    const std::string base = camera.name;
    for (int n = 2; !names.insert(camera.name).second; ++n) camera.name = fmt::format("{}_{}", base, n);
    check_camera(camera, room, in_file(scene, fmt::format("camera '{}'", camera.name)));
  }
}

}  // namespace reemit
