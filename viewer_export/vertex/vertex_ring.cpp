#include "viewer_export/vertex/vertex_ring.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mesh/zones/zone_cells.h"
#include "scenes/model/measures.h"
#include "viewer_export/vertex/kept_cells.h"

namespace reemit {
namespace {

constexpr std::uint32_t kLeftOut = 0xffffffff;

Vec3 to_vec3(const OpenMesh::Vec3d& v) {
  return {v[0], v[1], v[2]};
}

/// By zone, all bands together [W/m2].
std::vector<double> irradiance_of_zones(const Solution& solution) {
  std::vector<double> irradiance(solution.mesh.zone_count(), 0.0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, irradiance.size(), 4096), [&](const auto& range) {
    for (std::size_t z = range.begin(); z != range.end(); ++z)
      for (std::size_t b = 0; b < solution.bands.count(); ++b)
        irradiance[z] += solution.irradiance(ZoneId(z), b).mean;
  });
  return irradiance;
}

/// Incident power that a packet brought on average [W]; 0 where zones are known exactly.
double watts_per_packet(const Solution& solution, const std::vector<double>& irradiance) {
  if (solution.record.rays == 0 || solution.settings.method == SolveMethod::kMatrix) return 0;
  double power = 0;
  for (std::size_t z = 0; z < irradiance.size(); ++z)
    power += solution.mesh.zone_area(ZoneId(z)) * irradiance[z];
  return power / static_cast<double>(solution.record.rays);
}

/// Takes the zones that something covers out of a ring. A zone under a thing that stands there gets no light,
/// or what little comes in by the sliver between a round foot and the straight edges of its footprint; the
/// line of contact, along which faces are cut, has such zones on one side and visible ones on the other, and
/// their mean would draw a dark border around every thing. Zones that are dark only because packets happened
/// to miss them stay in. A ring that is dark all around is left as it is.
void leave_out_covered(const std::vector<double>& irradiance_of_zone, double watts, std::size_t first,
                       std::vector<RingCell>& rings) {
  /// Irradiance over the mean of the ring below which a zone is covered. Shadows on zones in sight may be as
  /// dark; nothing is lost there, as light is gathered beside the vertex and not all over the zones.
  constexpr double kCovered = 0.1;
  /// Packets that the mean of the ring stands for on a zone: odds of 1 in 10,000,000 to get a tenth of that.
  constexpr double kSureOf = 20;
  const auto irradiance = [&](const RingCell& ring) { return irradiance_of_zone[ring.zone.index()]; };
  double power = 0;
  double area = 0;
  for (std::size_t i = first; i < rings.size(); ++i) {
    power += rings[i].area * irradiance(rings[i]);
    area += rings[i].area;
  }
  if (!(power > 0)) return;
  const double mean = power / area;
  const auto covered = [&](const RingCell& ring) {
    return ring.area * mean > kSureOf * watts && irradiance(ring) < kCovered * mean;
  };
  rings.erase(std::remove_if(rings.begin() + static_cast<std::ptrdiff_t>(first), rings.end(), covered),
              rings.end());
}

/// Rings of vertices that follow each other in the topology, empty for those that are left out.
struct RingBlock {
  std::vector<std::size_t> sizes;
  std::vector<RingCell> rings;
};
constexpr std::size_t kVerticesPerBlock = 1024;

/// Area over the square of the longest edge: small for slivers.
double shape(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? triangle_area(a, b, c) / longest : 0;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> cut_into_triangles(const std::vector<Vec3>& polygon) {
  std::vector<std::uint32_t> left(polygon.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    const auto at = [&](std::size_t i) -> const Vec3& { return polygon[left[i % n]]; };
    const auto on_side = [&](std::size_t i) { return shape(at(i + n - 1), at(i), at(i + 1)) < 1e-6; };
    // An ear next to a vertex on a side uses that vertex up; any other could leave only a line behind.
    bool any_on_side = false;
    for (std::size_t i = 0; i < n; ++i) any_on_side = any_on_side || on_side(i);
    std::size_t best = 0;
    double best_shape = -1;
    for (std::size_t i = 0; i < n; ++i) {
      if (on_side(i)) continue;
      if (any_on_side && !on_side(i + n - 1) && !on_side(i + 1)) continue;
      const double s = shape(at(i + n - 1), at(i), at(i + 1));
      if (s > best_shape) {
        best = i;
        best_shape = s;
      }
    }
    triangles.push_back({left[(best + n - 1) % n], left[best], left[(best + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  if (left.size() == 3) triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

VertexRings::VertexRings(const SurfaceModel& surfaces, const Solution& solution, bool all_zones,
                         const std::vector<SurfaceId>& only) {
  const ZoneMesh& mesh = solution.mesh;
  const ZoneTopology topology = make_zone_topology(mesh, solution.mesh_settings.crease_angle_deg);
  const ZoneCells cells(mesh);
  const std::vector<bool> kept = kept_cells(surfaces, solution, cells, all_zones, only);
  const std::vector<double> irradiance = irradiance_of_zones(solution);
  const double watts = watts_per_packet(solution, irradiance);
  std::vector<RingBlock> blocks((topology.n_vertices() + kVerticesPerBlock - 1) / kVerticesPerBlock);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const std::size_t first = i * kVerticesPerBlock;
    const std::size_t last = std::min(first + kVerticesPerBlock, topology.n_vertices());
    for (std::size_t v = first; v < last; ++v) {
      const OpenMesh::VertexHandle vertex(static_cast<int>(v));
      const Vec3 position = to_vec3(topology.point(vertex));
      std::vector<RingCell>& rings = blocks[i].rings;
      const std::size_t begin = rings.size();
      for (auto face = topology.cvf_iter(vertex); face.is_valid(); ++face) {
        const auto c = static_cast<std::size_t>(face->idx());
        if (!kept[c]) continue;
        const SideCell cell = cells.cell(c);
        rings.push_back({cells.zone(c), cell, mesh.barycentric_of(cell.triangle, position), cells.area(c)});
      }
      if (rings.size() > begin) leave_out_covered(irradiance, watts, begin, rings);
      blocks[i].sizes.push_back(rings.size() - begin);
    }
  });
  std::vector<std::uint32_t> number(topology.n_vertices(), kLeftOut);
  first_.push_back(0);
  for (std::size_t v = 0; v < topology.n_vertices(); ++v) {
    const std::size_t size = blocks[v / kVerticesPerBlock].sizes[v % kVerticesPerBlock];
    if (size == 0) continue;
    const OpenMesh::VertexHandle vertex(static_cast<int>(v));
    number[v] = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(to_vec3(topology.point(vertex)));
    normals_.push_back(to_vec3(topology.normal(vertex)));
    first_.push_back(first_.back() + size);
  }
  rings_.reserve(first_.back());
  for (const RingBlock& block : blocks) rings_.insert(rings_.end(), block.rings.begin(), block.rings.end());
  add_triangles(topology, kept, number);
}

void VertexRings::add_triangles(const ZoneTopology& topology, const std::vector<bool>& kept_cells,
                                const std::vector<std::uint32_t>& number) {
  std::vector<Vec3> polygon;
  std::vector<std::uint32_t> corners;
  for (const auto face : topology.faces()) {
    if (!kept_cells[static_cast<std::size_t>(face.idx())]) continue;
    polygon.clear();
    corners.clear();
    for (auto v = topology.cfv_ccwiter(face); v.is_valid(); ++v) {
      polygon.push_back(to_vec3(topology.point(*v)));
      corners.push_back(number[static_cast<std::size_t>(v->idx())]);
    }
    for (const auto& t : cut_into_triangles(polygon))
      triangles_.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  }
}

double VertexRings::area(std::size_t vertex) const {
  double sum = 0;
  for (const RingCell* r = begin(vertex); r != end(vertex); ++r) sum += r->area;
  return sum / 3;
}

}  // namespace reemit
