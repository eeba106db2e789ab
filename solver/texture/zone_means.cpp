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
constexpr std::size_t kCellsInTurn = std::size_t{1} << 16;

/// Means over a cell; those of reflectance and radiance are of the product with the opacity. Empty where
/// nothing varies.
struct CellMeans {
  double solid = 0;
  std::vector<double> reflectance, plain, radiance;
};

void add(const RoomTextures::Values& values, double weight, std::vector<double>& sum) {
  for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += weight * static_cast<double>(values[b]);
}

/// [m]; of a curved patch, of the triangle between its corners.
double longest_edge(const ZoneMesh& mesh, const SideCell& cell) {
  const std::array<Vec3, 3> corners = corner_points(mesh, cell);
  double edge = 0;
  for (std::size_t k = 0; k < 3; ++k) edge = std::max(edge, (corners[(k + 1) % 3] - corners[k]).norm());
  return edge;
}

/// The middles of the n x n parts of a cell.
std::vector<InCell> middles_of_parts(int n) {
  std::vector<InCell> middles;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(n * n); ++k) {
    const auto corner = grid_cell(static_cast<std::uint32_t>(n), k).corners();
    middles.push_back({static_cast<float>((corner[0].u + corner[1].u + corner[2].u) / 3),
                       static_cast<float>((corner[0].v + corner[1].v + corner[2].v) / 3)});
  }
  return middles;
}

/// Takes means over cells. One per thread.
class CellReader {
 public:
  CellReader(const RoomTextures& textures, const ZoneMesh& mesh, std::size_t bands)
      : textures_(textures), mesh_(mesh), bands_(bands) {}

  /// `cells`: of its zone.
  CellMeans means_of(const SideCell& cell, std::uint32_t cells) {
    const SurfaceId surface = mesh_.triangle(cell.triangle).surface;
    const bool varies =
        textures_.varies_reflectance(surface) && (cell.front || textures_.varies_back(surface));
    const bool glows = textures_.varies_emission(surface);
    const bool is_cut_out = textures_.is_cut_out(surface) && !mesh_.triangle(cell.triangle).is_curved();
    const double edge = longest_edge(mesh_, cell);
    const double texel = textures_.texel_size(cell.triangle);
    const double shared = is_cut_out ? 1 : std::sqrt(static_cast<double>(cells));
    const int n =
        static_cast<int>(std::ceil(std::clamp<double>(8 * edge / texel, 4, kMostMeanDivisions) / shared));
    // What each point stands for, where there are too few of them.
    const auto spot = static_cast<float>(edge / n > 0.5 * texel ? edge / n : 0);
    CellMeans sum;
    if (varies) sum.reflectance.assign(bands_, 0.0);
    if (varies && is_cut_out) sum.plain.assign(bands_, 0.0);
    if (glows) sum.radiance.assign(bands_, 0.0);
    for (const InCell& middle : middles(n)) {
      const SidePoint at = cell_point(cell, middle.a, middle.b);
      const auto u = static_cast<float>(at.at.u);
      const auto v = static_cast<float>(at.at.v);
      const double solid = is_cut_out ? static_cast<double>(textures_.opacity(cell.triangle, u, v)) : 1;
      sum.solid += solid;
      if (varies) {
        textures_.reflectance(cell.triangle, u, v, spot, values_);
        add(values_, solid, sum.reflectance);
        add(values_, 1, sum.plain);
      }
      if (glows) {
        textures_.radiance(cell.triangle, u, v, spot, values_);
        add(values_, solid, sum.radiance);
      }
    }
    if (!is_cut_out) sum.plain = sum.reflectance;
    const double points = static_cast<double>(n) * n;
    sum.solid /= points;
    for (std::vector<double>* values_sum : {&sum.reflectance, &sum.plain, &sum.radiance})
      for (double& x : *values_sum) x /= points;
    return sum;
  }

 private:
  const std::vector<InCell>& middles(int n) {
    std::vector<InCell>& of = middles_[static_cast<std::size_t>(n)];
    if (of.empty()) of = middles_of_parts(n);
    return of;
  }

  const RoomTextures& textures_;
  const ZoneMesh& mesh_;
  std::size_t bands_;
  RoomTextures::Values values_;
  std::array<std::vector<InCell>, kMostMeanDivisions + 1> middles_;
};

/// Adds a cell of this area to a zone, whose row of the sums begins at `first`.
void add(const std::vector<double>& means, double area, std::size_t first, std::vector<double>& sums) {
  for (std::size_t b = 0; b < means.size(); ++b) sums[first + b] += area * means[b];
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
  const std::size_t zones = mesh.zone_count();
  std::vector<std::size_t> textured;
  std::vector<std::uint32_t> cells_of_zone(zones, 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!is_textured(mesh.triangle(cells.cell(i).triangle).surface)) continue;
    textured.push_back(i);
    ++cells_of_zone[cells.zone(i).index()];
  }
  std::vector<double> area(zones, 0.0);
  std::vector<double> solid(zones, 0.0);
  std::vector<double> reflectance(varies ? zones * bands : 0, 0.0);
  std::vector<double> plain(reflectance);
  std::vector<double> radiance(glows ? zones * bands : 0, 0.0);
  // By turns, so that the means of all cells of a large room need not be kept.
  for (std::size_t first = 0; first < textured.size(); first += kCellsInTurn) {
    std::vector<CellMeans> means(std::min(kCellsInTurn, textured.size() - first));
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, means.size(), 64), [&](const auto& range) {
      CellReader reader(textures, mesh, bands);
      for (std::size_t k = range.begin(); k != range.end(); ++k) {
        const std::size_t i = textured[first + k];
        means[k] = reader.means_of(cells.cell(i), cells_of_zone[cells.zone(i).index()]);
      }
    });
    for (std::size_t k = 0; k < means.size(); ++k) {
      const std::size_t z = cells.zone(textured[first + k]).index();
      const double a = cells.area(textured[first + k]);
      area[z] += a;
      solid[z] += a * means[k].solid;
      add(means[k].reflectance, a, z * bands, reflectance);
      add(means[k].plain, a, z * bands, plain);
      add(means[k].radiance, a, z * bands, radiance);
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

void measure_cut_outs(const Scene& scene, ZoneMesh& mesh) {
  const bool any = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                               [&](const Surface& s) { return scene.material_of(s).textures.is_cut_out(); });
  if (any && mesh.solid_shares().empty())
    mesh.set_solid_shares(zone_texture_means(RoomTextures(scene, mesh), mesh, scene.bands.count()).solid);
}

}  // namespace reemit
