#include "mesh/zones/zone_mesh.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace reemit {

void ZoneMesh::add_shapes() {
  const auto is_curved = [](const BaseTriangle& t) { return t.is_curved(); };
  const auto first = std::find_if(base_.triangles.begin(), base_.triangles.end(), is_curved);
  flat_count_ = static_cast<std::size_t>(first - base_.triangles.begin());
  std::size_t next = flat_count_;
  for (std::uint32_t s = 0; s < base_.shapes.size(); ++s) {
    curved_.emplace_back(base_.shapes[s]);
    first_patch_.emplace_back(next);
    for (std::uint32_t p = 0; p < curved_.back().count(); ++p, ++next)
      if (next >= base_.triangles.size() || base_.triangles[next].shape != s ||
          base_.triangles[next].patch != p)
        throw std::invalid_argument("patches of a curved shape that are missing or out of order");
  }
  if (next != base_.triangles.size()) throw std::invalid_argument("patches without a shape");
}

void ZoneMesh::check_backs() const {
  if (base_.backs.empty()) return;
  if (base_.backs.size() != base_.triangles.size())
    throw std::invalid_argument("backs of another number of triangles");
  for (std::size_t t = 0; t < base_.backs.size(); ++t)
    if (base_.backs[t].surface.valid() && (!base_.triangles[t].two_sided || base_.triangles[t].is_curved()))
      throw std::invalid_argument("the back of another face on a triangle that is one-sided or curved");
}

ZoneMesh::ZoneMesh(BaseMesh base, ZoneGroups groups, CellSplits splits)
    : base_(std::move(base)), splits_(std::move(splits)), groups_(std::move(groups)) {
  add_shapes();
  check_backs();
  triangle_area_.reserve(base_.triangles.size());
  triangle_normal_.reserve(base_.triangles.size());
  for (const BaseTriangle& t : base_.triangles) {
    for (const std::uint32_t v : t.vertex)
      if (v >= base_.vertices.size()) throw std::invalid_argument("base triangle with a vertex out of range");
    for (const std::uint32_t n : t.normal)
      if (n != BaseTriangle::kFlat && n >= base_.normals.size())
        throw std::invalid_argument("base triangle with a normal out of range");
    if (t.divisions == 0) throw std::invalid_argument("base triangle without zones");
    if (t.divisions > std::numeric_limits<std::uint16_t>::max())
      throw std::invalid_argument("base triangle of too many zones");
    if (t.is_curved()) {
      const CurvedPatches& shape = curved_[t.shape];
      triangle_area_.push_back(shape.patch_area());
      triangle_normal_.push_back(shape.normal(t.patch, 1.0 / 3, 1.0 / 3));
    } else {
      const Vec3& p0 = base_.vertices[t.vertex[0]];
      const Vec3 cross = (base_.vertices[t.vertex[1]] - p0).cross(base_.vertices[t.vertex[2]] - p0);
      const double length = cross.stableNorm();
      triangle_area_.push_back(0.5 * length);
      triangle_normal_.push_back(length > 0 ? Vec3(cross / length) : Vec3(Vec3::UnitZ()));
    }
  }
  add_cells();
  add_groups();
}

void ZoneMesh::add_cells() {
  if (!groups_.of_side.empty() && groups_.of_side.size() != side_count())
    throw std::invalid_argument("groups of another number of sides");
  const auto group_of = [&](std::size_t side) {
    return groups_.of_side.empty() ? ZoneGroups::kOwn : groups_.of_side[side];
  };
  sides_.reserve(side_count());
  std::size_t next_split = 0;
  std::size_t next_cut = 0;
  for (std::size_t s = 0; s < side_count(); ++s) {
    const BaseTriangle& t = triangle(triangle_of(SideId(s)));
    if (!is_front(SideId(s)) && !t.two_sided) {
      if (group_of(s) != ZoneGroups::kOwn) throw std::invalid_argument("group with a side without zones");
      sides_.push_back({ZoneId(), t.divisions});
    } else if (group_of(s) != ZoneGroups::kOwn) {
      sides_.push_back({ZoneId(), 1});  // numbered once all cells are
    } else {
      const std::size_t cells = std::size_t{t.divisions} * t.divisions;
      if (zone_side_.size() + cells >= std::numeric_limits<std::uint32_t>::max() - groups_.count)
        throw std::invalid_argument("more than 2^32-2 zones");
      sides_.push_back({ZoneId(zone_side_.size()), t.divisions});
      if (next_split < splits_.sides.size() && splits_.sides[next_split] == SideId(s)) {
        add_split_cells(SideId(s), next_cut);
        ++next_split;
      } else {
        zone_side_.insert(zone_side_.end(), cells, SideId(s));
        for (std::uint32_t c = 0; c < cells; ++c) zone_corners_.push_back(grid_cell(t.divisions, c));
      }
    }
  }
  if (nodes_.empty()) nodes_.push_back({0, CellSplits::kNotCut});
  if (next_split != splits_.sides.size() || next_cut != splits_.cuts.size())
    throw std::invalid_argument("splits of sides without cells, or more of them than cells");
}

void ZoneMesh::add_split_cells(SideId side, std::size_t& next_cut) {
  const std::uint32_t n = sides_[side.index()].divisions;
  const std::size_t first = nodes_.size();
  // Every cell has a cut at least: a damaged file must not make us allocate cells that are not there.
  if (std::size_t{n} * n > splits_.cuts.size() - next_cut)
    throw std::invalid_argument("splits that end too early");
  sides_[side.index()].nodes = static_cast<std::uint32_t>(first);
  nodes_.resize(first + std::size_t{n} * n);
  for (std::uint32_t c = 0; c < n * n; ++c) add_node(side, first + c, grid_cell(n, c), next_cut);
}

void ZoneMesh::add_node(SideId side, std::size_t node, const CellCorners& cell, std::size_t& next_cut) {
  if (next_cut >= splits_.cuts.size()) throw std::invalid_argument("splits that end too early");
  const std::uint32_t cut = splits_.cuts[next_cut++];
  if (cut == CellSplits::kNotCut) {
    const std::size_t first = sides_[side.index()].first_zone.index();
    nodes_[node] = {static_cast<std::uint32_t>(zone_side_.size() - first), cut};
    zone_side_.push_back(side);
    zone_corners_.push_back(cell);
    return;
  }
  if (cut > 3) throw std::invalid_argument("cells that are cut from a fourth corner");
  if (!can_halve(cell, cut - 1)) throw std::invalid_argument("cells that are cut too finely");
  const std::size_t parts = nodes_.size();
  nodes_[node] = {static_cast<std::uint32_t>(parts), cut};
  nodes_.resize(parts + 2);
  const CellHalves halves = halves_of(cell, cut - 1);
  add_node(side, parts, halves.first, next_cut);
  add_node(side, parts + 1, halves.second, next_cut);
}

ZoneId ZoneMesh::zone_in_parts(const Side& side, float u, float v) const {
  const ZoneCell cell = place_in_triangle(side.divisions, u, v);
  const Node* node = &nodes_[side.nodes + cell_number(side.divisions, cell)];
  if (node->cut != CellSplits::kNotCut) {
    InCell x = in_cell(side.divisions, cell, u, v);
    do node = &nodes_[node->at + half_of(x, node->cut - 1)];
    while (node->cut != CellSplits::kNotCut);
  }
  return ZoneId(side.first_zone.index() + node->at);
}

void ZoneMesh::add_groups() {
  if (groups_.sealed > groups_.count) throw std::invalid_argument("more sealed groups than groups");
  if (groups_.of_side.empty() && groups_.count > 0) throw std::invalid_argument("groups without members");
  if (groups_.of_side.empty()) return;
  first_member_.assign(groups_.count + 1, 0);
  for (const std::uint32_t g : groups_.of_side) {
    if (g == ZoneGroups::kOwn) continue;
    if (g >= groups_.count) throw std::invalid_argument("side with a group out of range");
    ++first_member_[g + 1];
  }
  for (std::uint32_t g = 0; g < groups_.count; ++g) {
    if (first_member_[g + 1] == 0) throw std::invalid_argument("group without members");
    first_member_[g + 1] += first_member_[g];
  }
  members_.resize(first_member_.back());
  members_area_.resize(first_member_.back());
  member_.resize(groups_.of_side.size());
  const std::size_t cells = zone_side_.size();
  std::vector<std::uint32_t> filled(groups_.count, 0);
  for (std::size_t s = 0; s < groups_.of_side.size(); ++s) {
    const std::uint32_t g = groups_.of_side[s];
    if (g == ZoneGroups::kOwn) continue;
    sides_[s].first_zone = ZoneId(cells + g);
    member_[s] = filled[g]++;
    const std::size_t place = first_member_[g] + member_[s];
    const SideId side(s);
    members_[place] = side;
    const bool is_first = member_[s] == 0;
    members_area_[place] = triangle_area(triangle_of(side)) + (is_first ? 0 : members_area_[place - 1]);
    const SideId first = members_[first_member_[g]];
    if (is_front(side) != is_front(first) || shows_front(side) != shows_front(first) ||
        surface(side) != surface(first))
      throw std::invalid_argument("group of several surfaces, or of fronts and backs");
  }
  for (std::uint32_t g = 0; g < groups_.count; ++g) zone_side_.push_back(members_[first_member_[g]]);
}

SideCell ZoneMesh::member_cell(ZoneId group, float& u) const {
  const std::size_t first = first_member(group);
  const std::size_t last = first + member_count(group) - 1;
  const double at = static_cast<double>(u) * members_area_[last];
  const auto begin = members_area_.begin();
  const auto found = std::upper_bound(begin + static_cast<std::ptrdiff_t>(first),
                                      begin + static_cast<std::ptrdiff_t>(last), at);
  const auto place = static_cast<std::size_t>(found - begin);
  const double before = place == first ? 0 : members_area_[place - 1];
  const double share = (at - before) / (members_area_[place] - before);
  constexpr float kBelowOne = 1 - 0x1p-24F;
  u = std::min(static_cast<float>(share), kBelowOne);
  return {triangle_of(members_[place]), is_front(members_[place]), {}};
}

double ZoneMesh::group_area(ZoneId group) const {
  return members_area_[first_member(group) + member_count(group) - 1];
}

double ZoneMesh::zone_area(ZoneId z) const {
  if (is_group(z)) return solid_share(z) * group_area(z);
  return solid_share(z) * triangle_area(zone_triangle(z)) * zone_corners_[z.index()].share();
}

void ZoneMesh::set_solid_shares(std::vector<float> shares) {
  const auto is_share = [](float s) { return s > 0 && s <= 1; };
  if (!shares.empty() &&
      (shares.size() != zone_count() || !std::all_of(shares.begin(), shares.end(), is_share)))
    throw std::invalid_argument("solid shares of zones that are missing or out of range");
  solid_shares_ = std::move(shares);
}

Vec3 ZoneMesh::zone_normal(ZoneId z) const {
  if (is_group(z)) {
    Vec3 sum = Vec3::Zero();
    for (std::uint32_t m = 0; m < member_count(z); ++m) {
      const TriangleId t = member_triangle(z, m);
      sum += triangle_area(t) * side_normal(side_of(t, zone_is_front(z)));
    }
    return sum.norm() > 1e-9 * group_area(z) ? Vec3(sum.normalized()) : side_normal(zone_side_[z.index()]);
  }
  const auto c = zone_barycentrics(z);
  const Vec3 n = normal(zone_triangle(z), (c[0].u + c[1].u + c[2].u) / 3, (c[0].v + c[1].v + c[2].v) / 3);
  return zone_is_front(z) ? n : Vec3(-n);
}

std::array<Barycentric, 3> ZoneMesh::zone_barycentrics(ZoneId z) const {
  return zone_corners_[z.index()].corners();
}

Vec3 ZoneMesh::point(TriangleId t, double u, double v) const {
  const BaseTriangle& tri = triangle(t);
  if (tri.is_curved()) return curved_[tri.shape].point(tri.patch, u, v);
  return (1 - u - v) * corner(t, 0) + u * corner(t, 1) + v * corner(t, 2);
}

Barycentric ZoneMesh::barycentric_of(TriangleId t, const Vec3& p) const {
  const BaseTriangle& tri = triangle(t);
  if (tri.is_curved()) return curved_[tri.shape].in_patch(tri.patch, p);
  const Vec3 e1 = corner(t, 1) - corner(t, 0);
  const Vec3 e2 = corner(t, 2) - corner(t, 0);
  const Vec3 d = p - corner(t, 0);
  const Vec3 n = e1.cross(e2);
  const double n2 = n.squaredNorm();
  return {d.cross(e2).dot(n) / n2, e1.cross(d).dot(n) / n2};
}

Vec3 ZoneMesh::zone_centroid(ZoneId z) const {
  if (is_group(z)) {
    Vec3 sum = Vec3::Zero();
    for (std::uint32_t m = 0; m < member_count(z); ++m) {
      const TriangleId t = member_triangle(z, m);
      sum += triangle_area(t) * point(t, 1.0 / 3, 1.0 / 3);
    }
    return sum / group_area(z);
  }
  const auto c = zone_barycentrics(z);
  return point(zone_triangle(z), (c[0].u + c[1].u + c[2].u) / 3, (c[0].v + c[1].v + c[2].v) / 3);
}

}  // namespace reemit
