#include "solver/texture/room_textures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "mesh/pieces/texture_split.h"
#include "scenes/model/colour.h"
#include "scenes/model/colour_spectra.h"
#include "solver/texture/texture_lookup.h"

namespace reemit {
namespace {

/// Barycentric position of p, brought into the plane of three points.
Vec3 barycentric_of(const std::array<Vec3, 3>& corner, const Vec3& p) {
  const Vec3 e1 = corner[1] - corner[0];
  const Vec3 e2 = corner[2] - corner[0];
  const Vec3 n = e1.cross(e2);
  const double size = n.squaredNorm();
  if (!(size > 0)) return {1.0 / 3, 1.0 / 3, 1.0 / 3};
  const double u = n.dot((p - corner[0]).cross(e2)) / size;
  const double v = n.dot(e1.cross(p - corner[0])) / size;
  return {1 - u - v, u, v};
}

/// A part of a face over which texture coordinates are interpolated.
struct MappedPart {
  std::array<Vec3, 3> corner;
  std::array<const TexturePoint*, 3> point;
};

/// That part of a face which holds a point, or is next to it.
std::optional<MappedPart> part_around(const Surface& surface, const Face& face, const Vec3& p) {
  std::optional<MappedPart> best;
  double most = -std::numeric_limits<double>::infinity();
  for (const auto& t : texture_triangles(surface, face)) {
    MappedPart part;
    for (std::size_t k = 0; k < 3; ++k) {
      part.corner[k] = surface.positions[face.outer[t[k]]];
      part.point[k] = &surface.texture_points[face.texture_points[t[k]]];
    }
    const double inside = barycentric_of(part.corner, p).minCoeff();
    if (inside > most) {
      most = inside;
      best = part;
    }
  }
  return best;
}

/// Whole numbers by which coordinates may be moved, so that they keep their digits.
double shift_of(double lowest, TextureWrap wrap) {
  return wrap == TextureWrap::kClamp ? 0 : 2 * std::floor(lowest / 2);
}

}  // namespace

RoomTextures::RoomTextures(const Scene& scene, const ZoneMesh& mesh)
    : kind_(scene.bands.kind()), bands_(scene.bands.count()) {
  if (std::none_of(scene.surfaces.begin(), scene.surfaces.end(),
                   [&](const Surface& s) { return scene.is_textured(s); }))
    return;
  for (const Surface& surface : scene.surfaces) materials_.push_back(material_of(scene, surface));
  slot_.assign(mesh.triangle_count(), kNone);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (scene.is_textured(scene.surfaces[mesh.triangle(TriangleId(t)).surface.index()]))
      add_triangle(scene, mesh, TriangleId(t));
}

RoomTextures::OfMaterial RoomTextures::material_of(const Scene& scene, const Surface& surface) const {
  const Material& material = scene.material_of(surface);
  const MaterialTextures& textures = material.textures;
  const auto values = [&](const Spectrum& s) {
    Values v;
    for (const double x : s) v.push_back(static_cast<float>(x));
    return v;
  };
  OfMaterial of;
  of.textures = &textures;
  if (textures.reflectance) of.reflectance = &textures.reflectance;
  if (textures.emission) of.emission = &textures.emission;
  if (textures.opacity) of.opacity = &textures.opacity;
  const Spectrum& factor =
      textures.reflectance_factor.size() > 0 ? textures.reflectance_factor : material.reflectance;
  of.reflectance_factor = values(factor);
  of.most_reflectance = values(textures.reflectance ? textures.most_reflectance : factor);
  of.emission_factor = values(textures.emission_factor);
  of.has_colours = surface.has_vertex_colours;
  of.varies_reflectance = of.reflectance != nullptr || of.has_colours;
  of.varies_back = material.back_reflectance.size() == 0;
  of.is_cut_out = textures.is_cut_out();
  return of;
}

void RoomTextures::add_triangle(const Scene& scene, const ZoneMesh& mesh, TriangleId t) {
  const BaseTriangle& triangle = mesh.triangle(t);
  const Surface& surface = scene.surfaces[triangle.surface.index()];
  const OfMaterial& material = materials_[triangle.surface.index()];
  slot_[t.index()] = static_cast<std::uint32_t>(triangles_.size());
  if (material.is_cut_out && !triangle.is_curved())
    cut_outs_.push_back(static_cast<std::uint32_t>(t.index()));
  OfTriangle& of = triangles_.emplace_back();
  of.surface = static_cast<std::uint32_t>(triangle.surface.index());
  std::optional<MappedPart> part;
  const bool has_points = !triangle.is_curved() && triangle.face < surface.faces.size() &&
                          !surface.faces[triangle.face].texture_points.empty();
  const Vec3 corner[] = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
  if (has_points)
    part = part_around(surface, surface.faces[triangle.face], (corner[0] + corner[1] + corner[2]) / 3);
  const auto place = [&](const Texture* texture, Placement& placement) {
    if (texture == nullptr || !part) return;
    std::array<Eigen::Vector2d, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 share = barycentric_of(part->corner, corner[k]);
      Eigen::Vector3d at(0, 0, 1);
      for (std::size_t i = 0; i < 3; ++i)
        for (int c = 0; c < 2; ++c)
          at[c] += share[static_cast<Eigen::Index>(i)] *
                   part->point[i]->uv[texture->set][static_cast<std::size_t>(c)];
      uv[k] = texture->to_image * at;
    }
    const Eigen::Vector2d lowest = uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]);
    const Eigen::Vector2d shift(shift_of(lowest.x(), texture->wrap_u), shift_of(lowest.y(), texture->wrap_v));
    for (std::size_t k = 0; k < 3; ++k)
      placement.uv[k] = {static_cast<float>(uv[k].x() - shift.x()),
                         static_cast<float>(uv[k].y() - shift.y())};
    const Eigen::Vector2d d1 = uv[1] - uv[0];
    const Eigen::Vector2d d2 = uv[2] - uv[0];
    const double texels =
        std::abs(d1.x() * d2.y() - d1.y() * d2.x()) * texture->image->width * texture->image->height;
    // An image drawn out along a line has no texels to count, and is taken as it is.
    placement.texels_per_m =
        static_cast<float>(std::max(std::sqrt(texels / std::max(2 * mesh.triangle_area(t), 1e-300)), 1e-20));
  };
  place(material.reflectance, of.reflectance);
  place(material.emission, of.emission);
  place(material.opacity, of.opacity);
  if (!material.has_colours) {
    if (!colours_.empty()) colours_.emplace_back();
    return;
  }
  if (colours_.empty()) colours_.resize(triangles_.size() - 1);
  Colours& colours = colours_.emplace_back();
  for (std::size_t k = 0; k < 3; ++k) {
    Rgb& rgb = colours[k];
    rgb = {1, 1, 1};
    if (part) {
      const Vec3 share = barycentric_of(part->corner, corner[k]);
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
          sum += share[static_cast<Eigen::Index>(i)] * static_cast<double>(part->point[i]->colour[c]);
        rgb[c] = static_cast<float>(std::clamp(sum, 0.0, 1.0));
      }
    }
  }
}

void RoomTextures::in_bands(const Rgb& rgb, const TexelSpectra& spectra, Values& values) const {
  values.resize(bands_);
  if (kind_ == BandKind::kRgb) {
    std::copy(rgb.begin(), rgb.end(), values.begin());
  } else if (kind_ == BandKind::kGrey) {
    // Of grey its own value, to the last bit.
    static const Eigen::Array3f weights = rec709_luminance_weights().cast<float>();
    const bool is_grey = rgb[0] == rgb[1] && rgb[1] == rgb[2];
    values[0] = is_grey ? rgb[0] : weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2];
  } else {
    Rgb tinted;
    for (std::size_t c = 0; c < 3; ++c) tinted[c] = rgb[c] * spectra.tint[static_cast<Eigen::Index>(c)];
    spectra.spectra->values(tinted, values);
  }
}

Texel RoomTextures::value(const Texture& texture, const Placement& p, float u, float v, float size) {
  if (p.texels_per_m == 0) return texture.image->mean;
  const float w = 1 - u - v;
  return texture_value(texture, w * p.uv[0][0] + u * p.uv[1][0] + v * p.uv[2][0],
                       w * p.uv[0][1] + u * p.uv[1][1] + v * p.uv[2][1], size * p.texels_per_m);
}

void RoomTextures::reflectance(TriangleId t, float u, float v, float size, Values& rho) const {
  const OfTriangle& triangle = of(t);
  const OfMaterial& material = materials_[triangle.surface];
  Rgb rgb{1, 1, 1};
  if (material.reflectance != nullptr) {
    const Texel image = value(*material.reflectance, triangle.reflectance, u, v, size);
    std::copy_n(image.begin(), 3, rgb.begin());
  }
  if (material.has_colours) {
    const Colours& corner = colours_[slot_[t.index()]];
    for (std::size_t c = 0; c < 3; ++c)
      rgb[c] *= (1 - u - v) * corner[0][c] + u * corner[1][c] + v * corner[2][c];
  }
  in_bands(rgb, material.textures->reflectance_spectra, rho);
  for (std::size_t b = 0; b < bands_; ++b)
    rho[b] = std::min(material.reflectance_factor[b] * rho[b], material.most_reflectance[b]);
}

void RoomTextures::radiance(TriangleId t, float u, float v, float size, Values& radiance) const {
  const OfTriangle& triangle = of(t);
  const OfMaterial& material = materials_[triangle.surface];
  const Texel image = value(*material.emission, triangle.emission, u, v, size);
  in_bands({image[0], image[1], image[2]}, material.textures->emission_spectra, radiance);
  for (std::size_t b = 0; b < bands_; ++b) radiance[b] *= material.emission_factor[b];
}

float RoomTextures::opacity(TriangleId t, float u, float v) const {
  const OfTriangle& triangle = of(t);
  const OfMaterial& material = materials_[triangle.surface];
  auto opacity = static_cast<float>(material.textures->opacity_factor);
  if (material.opacity != nullptr) {
    const Texel image = value(*material.opacity, triangle.opacity, u, v, 0);
    opacity *= image[material.textures->opacity_is_colour ? 0 : 3];
  }
  const auto& cutoff = material.textures->opacity_cutoff;
  if (cutoff) return static_cast<double>(opacity) >= *cutoff ? 1.0F : 0.0F;
  return std::clamp(opacity, 0.0F, 1.0F);
}

double RoomTextures::texel_size(TriangleId t) const {
  const OfTriangle& triangle = of(t);
  const float finest = std::max(
      {triangle.reflectance.texels_per_m, triangle.emission.texels_per_m, triangle.opacity.texels_per_m});
  return finest > 0 ? 1 / static_cast<double>(finest) : std::numeric_limits<double>::infinity();
}

}  // namespace reemit
