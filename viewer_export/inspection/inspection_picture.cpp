#include "viewer_export/inspection/inspection_picture.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <variant>

#include "mesh/zones/side_cell.h"
#include "scenes/io/common/up_direction.h"
#include "viewer_export/formats/vertex_export.h"
#include "viewer_export/inspection/side_kinds.h"
#include "viewer_export/inspection/zone_sizes.h"

namespace reemit {
namespace {

/// Patches of round shapes are drawn with at least this many cells along each side.
constexpr std::uint32_t kRound = 2;
/// Of the crosses at luminaires without area, in diagonals of the room.
constexpr double kCross = 0.01;
/// From one set to the next, in widths of the room.
constexpr double kStep = 1.15;
const Rgba line_colour = rgba_of_srgb(0.63, 1, 0);

Rgba colour_of(SideKind kind) {
  const auto& [r, g, b] = style_of(kind).srgb;
  return rgba_of_srgb(r / 255.0, g / 255.0, b / 255.0);
}

/// The k-th number of a sequence in [0,1) whose neighbours lie far apart.
double scattered(std::size_t k, double step) {
  const double x = static_cast<double>(k) * step;
  return x - std::floor(x);
}

/// A fully saturated hue runs from 0 (red) over 2 (green) to 4 (blue).
std::array<double, 3> hue_rgb(double hue) {
  const auto near = [hue](double peak) { return std::clamp(2 - std::abs(hue - peak), 0.0, 1.0); };
  return {near(0), near(2), near(4)};
}

/// Hue by area on a logarithmic scale, red for the smallest and blue for the largest; lightness tells
/// neighbours apart. A few that are far from all others do not stretch the scale.
class ZoneColours {
 public:
  explicit ZoneColours(const ZoneMesh& mesh) : mesh_(mesh) {
    constexpr double kTail = 0.02;  // of the zones at either end, which look like their neighbours
    std::vector<double> areas;
    for (std::size_t z = 0; z < mesh.zone_count(); ++z)
      if (!mesh.is_sealed(ZoneId(z))) areas.push_back(mesh.zone_area(ZoneId(z)));
    if (areas.empty()) return;
    std::sort(areas.begin(), areas.end());
    const auto tail = static_cast<std::size_t>(kTail * static_cast<double>(areas.size()));
    smallest_ = areas[tail];
    largest_ = areas[areas.size() - 1 - tail];
  }

  Rgba operator()(ZoneId zone) const {
    constexpr double kGolden = 0.6180339887498949;
    constexpr double kPlastic = 0.7548776662466927;
    const double light = 0.5 + 0.5 * scattered(zone.index(), kGolden);
    const double white = 0.25 * scattered(zone.index(), kPlastic);
    if (mesh_.is_sealed(zone)) return rgba_of_srgb(0.7 * light, 0.7 * light, 0.7 * light);
    const double share = largest_ > smallest_
                             ? std::log(mesh_.zone_area(zone) / smallest_) / std::log(largest_ / smallest_)
                             : 0.5;
    std::array<double, 3> rgb = hue_rgb(4 * std::clamp(share, 0.0, 1.0));
    for (double& c : rgb) c = light * (white + (1 - white) * c);
    return rgba_of_srgb(rgb[0], rgb[1], rgb[2]);
  }

 private:
  const ZoneMesh& mesh_;
  double smallest_ = 0;  // [m2], of zones that light reaches, without the tails
  double largest_ = 0;
};

class InspectionArtist {
 public:
  InspectionArtist(const Scene& scene, const MeshResult& meshed)
      : scene_(scene), meshed_(meshed), mesh_(meshed.mesh), box_(bounds(scene)) {
    picture_.origin = single_precision_origin(box_.min, box_.max);
    picture_.up = up_direction(scene);
  }

  InspectionPicture draw() && {
    picture_.sets.push_back({"what meshing did", Vec3::Zero(), {}});
    draw_kinds(picture_.sets.back().objects);
    draw_luminaires(picture_.sets.back().objects);
    // Beside the room: in one place one would hide the other.
    picture_.sets.push_back({"zones by size", Vec3(kStep * std::max(width(), diagonal() / 4), 0, 0), {}});
    draw_zones(picture_.sets.back().objects);
    return std::move(picture_);
  }

 private:
  double width() const { return box_.size().x(); }
  double diagonal() const { return box_.size().norm(); }
  double gap() const { return back_gap(diagonal()); }

  /// Calls visit(corners, zone) for each of the cells of a side, moved off it by `lift` [m]; corners are
  /// counter-clockwise from the side. Cells are those of its zones, or the whole side if `whole` and flat.
  template <class Visit>
  void for_each_cell(SideId side, bool whole, double lift, const Visit& visit) const {
    const TriangleId t = triangle_of(side);
    const BaseTriangle& triangle = mesh_.triangle(t);
    const ZoneId first = mesh_.first_zone(t, is_front(side));
    const double sign = is_front(side) ? 1 : -1;
    const auto draw = [&](const CellCorners& cell, ZoneId zone) {
      std::array<Vec3, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [u, v] = cell.corner(c);
        corners[c] = mesh_.point(t, u, v) + sign * lift * mesh_.normal(t, u, v);
      }
      if (!is_front(side)) std::swap(corners[1], corners[2]);
      visit(corners, zone);
    };
    if (triangle.is_curved()) {
      const std::uint32_t n = std::max(triangle.divisions, kRound);
      for (std::uint32_t k = 0; k < n * n; ++k) {
        const SidePoint middle = cell_point({t, is_front(side), grid_cell(n, k)}, 1.0F / 3, 1.0F / 3);
        draw(grid_cell(n, k), mesh_.zone_at(t, static_cast<float>(middle.at.u),
                                            static_cast<float>(middle.at.v), is_front(side)));
      }
    } else if (whole || mesh_.is_group(first)) {
      draw({}, first);
    } else {
      for (std::size_t z = first.index(); z < mesh_.cell_zone_count() && mesh_.zone_side(ZoneId(z)) == side;
           ++z)
        draw(mesh_.zone_cell(ZoneId(z)).corners, ZoneId(z));
    }
  }

  double lift_of(SideId side) const { return is_front(side) ? 0 : gap(); }

  PictureObject object(const char* name) const { return {name, picture_.origin}; }

  static void keep(PictureObject object, std::vector<PictureObject>& objects) {
    object.finish();
    if (!object.indices().empty()) objects.push_back(std::move(object));
  }

  void draw_kinds(std::vector<PictureObject>& objects) const {
    const std::vector<SideKind> kinds = kinds_of_sides(scene_, meshed_);
    for (const SideKindSum& sum : sum_sides(mesh_, kinds)) {
      PictureObject part = object(style_of(sum.kind).name);
      const Rgba colour = colour_of(sum.kind);
      for (std::size_t s = 0; s < kinds.size(); ++s)
        if (kinds[s] == sum.kind && mesh_.has_zones(SideId(s)))
          for_each_cell(SideId(s), true, lift_of(SideId(s)),
                        [&](const auto& corners, ZoneId) { part.add_triangle(corners, colour); });
      keep(std::move(part), objects);
    }
  }

  void draw_zones(std::vector<PictureObject>& objects) const {
    const ZoneColours colour_of_zone(mesh_);
    for (const ZoneKind kind : kZoneKinds) {
      PictureObject part = object(name_of(kind));
      for (std::size_t s = 0; s < mesh_.side_count(); ++s) {
        const SideId side(s);
        if (!mesh_.has_zones(side) ||
            kind_of(mesh_, mesh_.first_zone(triangle_of(side), is_front(side))) != kind)
          continue;
        for_each_cell(side, false, lift_of(side), [&](const auto& corners, ZoneId zone) {
          part.add_triangle(corners, colour_of_zone(zone));
        });
      }
      keep(std::move(part), objects);
    }
  }

  /// Edges of luminous sides, off them, and crosses where those without area are.
  void draw_luminaires(std::vector<PictureObject>& objects) const {
    PictureObject lines = object("luminaires");
    PictureObject corners_of = object("");  // numbers the corners
    for (std::size_t s = 0; s < mesh_.side_count(); ++s) {
      const SideId side(s);
      if (mesh_.has_zones(side) && emits(scene_, mesh_, side))
        for_each_cell(side, true, lift_of(side) + gap(),
                      [&](const auto& corners, ZoneId) { corners_of.add_triangle(corners, line_colour); });
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    const std::vector<std::uint32_t>& corner = corners_of.indices();
    for (std::size_t i = 0; i < corner.size(); ++i)
      edges.insert(std::minmax(corner[i], corner[i % 3 == 2 ? i - 2 : i + 1]));
    const auto place = [&](std::uint32_t v) {
      const std::array<float, 3>& p = corners_of.vertices()[v].position;
      return Vec3(picture_.origin + Vec3(p[0], p[1], p[2]));
    };
    for (const auto& [a, b] : edges) lines.add_line(place(a), place(b), line_colour);
    for (const PunctualLight& light : scene_.lights)
      std::visit([&](const auto& l) { draw_cross(l, lines); }, light);
    keep(std::move(lines), objects);
  }

  template <class Light>
  void draw_cross(const Light& light, PictureObject& lines) const {
    const double reach = kCross * diagonal();
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 arm = reach * Vec3::Unit(axis);
      lines.add_line(light.position - arm, light.position + arm, line_colour);
    }
  }
  void draw_cross(const DirectionalLight& /*from no place*/, PictureObject& /*lines*/) const {}

  const Scene& scene_;
  const MeshResult& meshed_;
  const ZoneMesh& mesh_;
  Box box_;
  InspectionPicture picture_;
};

}  // namespace

InspectionPicture draw_inspection(const Scene& scene, const MeshResult& meshed) {
  return InspectionArtist(scene, meshed).draw();
}

}  // namespace reemit
