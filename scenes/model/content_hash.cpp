#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "scenes/model/fnv1a.h"
#include "scenes/model/scene.h"

namespace reemit {
namespace {

// Numbers enter as little-endian bytes whatever the machine, and -0 as 0.
class Hasher {
 public:
  void add(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8)
      hash_.add(static_cast<std::uint32_t>((value >> shift) & 0xffU));
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value)); }
  void add(bool value) { add(std::uint64_t{value}); }
  void add(const Vec3& v) {
    for (const double x : v) add(x);
  }
  void add(const Spectrum& s) {
    add(static_cast<std::uint64_t>(s.size()));
    for (const double x : s) add(x);
  }
  void add(const std::vector<double>& numbers) {
    add(std::uint64_t{numbers.size()});
    for (const double x : numbers) add(x);
  }
  std::uint64_t state() const { return hash_.state(); }

 private:
  Fnv1a hash_;
};

/// Nothing is added for a material without such a part.
void add_non_diffuse(Hasher& hash, const NonDiffusePart& part) {
  const NonDiffusePart none;
  const Spectrum* shares[] = {&part.specular_reflectance,
                              &part.diffuse_transmittance,
                              &part.specular_transmittance,
                              &part.absorption_per_m,
                              &part.metal_eta,
                              &part.metal_k};
  const auto numbers_of = [](const NonDiffusePart& p) {
    return std::array{p.roughness,
                      p.transmission_roughness,
                      p.index_of_refraction,
                      static_cast<double>(p.angle_law),
                      p.is_solid ? 1.0 : 0.0,
                      static_cast<double>(p.lobe)};
  };
  const auto numbers = numbers_of(part);
  if (std::all_of(std::begin(shares), std::end(shares), [](const Spectrum* s) { return s->size() == 0; }) &&
      numbers == numbers_of(none))
    return;
  for (const Spectrum* share : shares) hash.add(*share);
  for (const double number : numbers) hash.add(number);
}

void add_texture(Hasher& hash, const Texture& t) {
  hash.add(bool{t});
  if (!t) return;
  hash.add(t.image->hash);
  for (const std::uint64_t number : {std::uint64_t{t.set}, std::uint64_t(t.wrap_u), std::uint64_t(t.wrap_v)})
    hash.add(number);
  hash.add(t.nearest);
  for (const double x : t.to_image.reshaped()) hash.add(x);
}

void add_spectra(Hasher& hash, const TexelSpectra& spectra) {
  if (spectra.spectra)
    for (const float tint : spectra.tint) hash.add(static_cast<double>(tint));
}

/// Nothing is added for a material without any.
void add_textures(Hasher& hash, const MaterialTextures& textures) {
  if (!textures.any()) return;
  add_texture(hash, textures.reflectance);
  add_texture(hash, textures.emission);
  add_texture(hash, textures.opacity);
  hash.add(textures.reflectance_factor);
  hash.add(textures.emission_factor);
  hash.add(textures.opacity_is_colour);
  hash.add(textures.opacity_factor);
  hash.add(textures.opacity_cutoff.value_or(-1.0));
  add_spectra(hash, textures.reflectance_spectra);
  add_spectra(hash, textures.emission_spectra);
}

void add_texture_point(Hasher& hash, const TexturePoint& point, bool has_colours) {
  for (const auto& uv : point.uv)
    for (const double x : uv) hash.add(x);
  // Colours that the surface does not show count as white.
  for (const float x : has_colours ? point.colour : TexturePoint{}.colour) hash.add(static_cast<double>(x));
}

void add_material(Hasher& hash, const Material& m) {
  hash.add(m.reflectance);
  if (m.back_reflectance.size() > 0) hash.add(m.back_reflectance);
  hash.add(m.emitted_radiance);
  hash.add(m.two_sided);
  hash.add(m.emits_both_sides);
  if (m.emission_exponent != 0) hash.add(m.emission_exponent);
  add_non_diffuse(hash, m.non_diffuse);
  add_textures(hash, m.textures);
}

// The corners themselves rather than their indices, so that vertices no face uses do not count.
void add_loop(Hasher& hash, std::span<const std::uint32_t> loop, const std::vector<Vec3>& points) {
  hash.add(std::uint64_t{loop.size()});
  for (const std::uint32_t index : loop) hash.add(points[index]);
}

void add_shape(Hasher& hash, const CurvedShape& shape) {
  hash.add(std::uint64_t{shape.index()});
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    hash.add(sphere->centre);
    hash.add(sphere->radius);
    hash.add(sphere->inward);
    return;
  }
  const Frustum f = frustum_of(shape);
  for (const Vec3& v : {f.base, f.axis}) hash.add(v);
  for (const double x : {f.height, f.r0, f.r1}) hash.add(x);
  hash.add(f.inward);
}

void add_surface(Hasher& hash, const Surface& surface, bool is_textured) {
  hash.add(std::uint64_t{surface.faces.size()});
  for (const Face& face : surface.faces) {
    add_loop(hash, face.outer, surface.positions);
    hash.add(std::uint64_t{face.holes.size()});
    for (const auto& hole : face.holes) add_loop(hash, hole, surface.positions);
    add_loop(hash, face.normals,
             surface.normals);  // creases, and with them shared vertices, follow from these
    if (is_textured)
      for (const std::uint32_t point : face.texture_points)
        add_texture_point(hash, surface.texture_points[point], surface.has_vertex_colours);
  }
  if (surface.shapes.empty()) return;
  hash.add(std::uint64_t{surface.shapes.size()});
  for (const CurvedShape& shape : surface.shapes) add_shape(hash, shape);
}

void add_sky(Hasher& hash, const Sky& sky) {
  hash.add(static_cast<std::uint64_t>(sky.kind));
  hash.add(sky.up);
  hash.add(sky.north);
  hash.add(sky.irradiance);
  const SkyGradation& g = sky.gradation;
  for (const double x : {g.a, g.b, g.c, g.d, g.e}) hash.add(x);
  if (g.is_all_weather) hash.add(std::uint64_t{1});
  hash.add(sky.ground_reflectance);
  if (sky.image) {
    hash.add(std::uint64_t{sky.image->columns});
    for (const float x : sky.image->radiance) hash.add(static_cast<double>(x));
  }
  if (!sky.sun) return;
  for (const double x : {sky.sun->altitude, sky.sun->azimuth, sky.sun->half_angle}) hash.add(x);
  hash.add(sky.sun->irradiance);
}

}  // namespace

std::string content_hash(const Scene& scene) {
  Hasher hash;
  hash.add(static_cast<std::uint64_t>(scene.bands.kind()));
  hash.add(std::uint64_t{scene.bands.centres_nm().size()});
  for (const double centre : scene.bands.centres_nm()) hash.add(centre);
  hash.add(std::uint64_t{scene.surfaces.size()});
  for (const Surface& surface : scene.surfaces) {
    add_material(hash, scene.material_of(surface));
    add_surface(hash, surface, scene.is_textured(surface));
  }
  hash.add(std::uint64_t{scene.lights.size()});
  for (const PunctualLight& light : scene.lights) {
    hash.add(std::uint64_t{light.index()});
    std::visit([&hash](const auto& l) { l.for_each_value([&hash](const auto& x) { hash.add(x); }); }, light);
  }
  if (scene.sky) add_sky(hash, *scene.sky);
  return fmt::format("{:016x}", hash.state());
}

}  // namespace reemit
