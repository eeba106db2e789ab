#include "solver/texture/zone_means.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mesh/zones/zone_cells.h"

namespace reemit {
namespace {

/// Of a zone without a solid point: it catches nothing, but nothing is divided by 0 either.
constexpr double kLeastSolid = 1e-4;

/// Means over a cell; those of reflectance and radiance are of the product with the opacity.
struct CellMeans {
  double solid = 1;
  std::array<double, RoomTextures::kMostBands> reflectance{}, plain{}, radiance{};
};

CellMeans means_of(const RoomTextures& textures, const ZoneMesh& mesh, const SideCell& cell,
                   std::size_t all_bands) {
  const std::size_t bands =
      std::min(all_bands, RoomTextures::kMostBands);  // more only without images in colour
  const SurfaceId surface = mesh.triangle(cell.triangle).surface;
  const bool varies = textures.varies_reflectance(surface) && (cell.front || textures.varies_back(surface));
  const bool glows = textures.varies_emission(surface);
  const bool is_cut_out = textures.is_cut_out(surface) && !mesh.triangle(cell.triangle).is_curved();
  CellMeans means;
  const double edge = std::sqrt(2 * mesh.triangle_area(cell.triangle)) / cell.divisions;  // about
  const double texel = textures.texel_size(cell.triangle);
  const int n = static_cast<int>(std::clamp<double>(std::ceil(8 * edge / texel), 4, kMostMeanDivisions));
  // What each point stands for, where there are too few of them.
  const double spot = edge / n > 0.5 * texel ? edge / n : 0;
  CellMeans sum;
  sum.solid = 0;
  RoomTextures::Values values;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(n * n); ++k) {
    const auto corner = zone_corners(static_cast<std::uint32_t>(n), k);
    const SidePoint at = cell_point(cell, static_cast<float>((corner[0].u + corner[1].u + corner[2].u) / 3),
                                    static_cast<float>((corner[0].v + corner[1].v + corner[2].v) / 3));
    const auto u = static_cast<float>(at.at.u);
    const auto v = static_cast<float>(at.at.v);
    const double solid = is_cut_out ? static_cast<double>(textures.opacity(cell.triangle, u, v)) : 1;
    sum.solid += solid;
    if (varies) {
      textures.reflectance(cell.triangle, u, v, static_cast<float>(spot), values);
      for (std::size_t b = 0; b < bands; ++b) {
        sum.reflectance[b] += solid * static_cast<double>(values[b]);
        sum.plain[b] += static_cast<double>(values[b]);
      }
    }
    if (glows) {
      textures.radiance(cell.triangle, u, v, static_cast<float>(spot), values);
      for (std::size_t b = 0; b < bands; ++b) sum.radiance[b] += solid * static_cast<double>(values[b]);
    }
  }
  const double points = static_cast<double>(n) * n;
  means.solid = sum.solid / points;
  for (std::size_t b = 0; b < bands; ++b) {
    means.reflectance[b] = sum.reflectance[b] / points;
    means.plain[b] = sum.plain[b] / points;
    means.radiance[b] = sum.radiance[b] / points;
  }
  return means;
}

}  // namespace

ZoneTextureMeans zone_texture_means(const RoomTextures& textures, const ZoneMesh& mesh, std::size_t bands) {
  ZoneTextureMeans result;
  if (textures.empty()) return result;
  bool varies = false;
  bool glows = false;
  bool cut = false;
  const auto is_textured = [&](SurfaceId s) {
    return textures.varies_reflectance(s) || textures.varies_emission(s) || textures.is_cut_out(s);
  };
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const SurfaceId s = mesh.triangle(TriangleId(t)).surface;
    varies = varies || textures.varies_reflectance(s);
    glows = glows || textures.varies_emission(s);
    cut = cut || textures.is_cut_out(s);
  }
  const ZoneCells cells(mesh);
  std::vector<std::size_t> textured;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (is_textured(mesh.triangle(cells.cell(i).triangle).surface)) textured.push_back(i);
  std::vector<CellMeans> means(textured.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, textured.size(), 64), [&](const auto& range) {
    for (std::size_t k = range.begin(); k != range.end(); ++k)
      means[k] = means_of(textures, mesh, cells.cell(textured[k]), bands);
  });
  const std::size_t zones = mesh.zone_count();
  std::vector<double> area(zones, 0.0);
  std::vector<double> solid(zones, 0.0);
  std::vector<double> reflectance(varies ? zones * bands : 0, 0.0);
  std::vector<double> plain(reflectance);
  std::vector<double> radiance(glows ? zones * bands : 0, 0.0);
  for (std::size_t k = 0; k < textured.size(); ++k) {
    const std::size_t z = cells.zone(textured[k]).index();
    const double a = cells.area(textured[k]);
    area[z] += a;
    solid[z] += a * means[k].solid;
    for (std::size_t b = 0; b < bands; ++b) {
      if (varies) reflectance[z * bands + b] += a * means[k].reflectance[b];
      if (varies) plain[z * bands + b] += a * means[k].plain[b];
      if (glows) radiance[z * bands + b] += a * means[k].radiance[b];
    }
  }
  if (cut) result.solid.assign(zones, 1.0F);
  for (std::size_t z = 0; z < zones; ++z) {
    if (!(area[z] > 0)) continue;
    const bool is_there = solid[z] > kLeastSolid * area[z];
    if (cut) result.solid[z] = static_cast<float>(std::clamp(solid[z] / area[z], kLeastSolid, 1.0));
    const double there = std::max(solid[z], kLeastSolid * area[z]);
    for (std::size_t b = 0; b < bands; ++b) {
      const std::size_t i = z * bands + b;
      if (varies) reflectance[i] = is_there ? reflectance[i] / there : plain[i] / area[z];
      if (glows) radiance[i] /= there;
    }
  }
  result.reflectance = std::move(reflectance);
  result.radiance = std::move(radiance);
  return result;
}

}  // namespace reemit
