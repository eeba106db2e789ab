#pragma once
#include <array>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit::test {

/// Relative; of areas, which are sums of few products.
inline constexpr double kExact = 1e-9;

/// A room put together by hand: one surface per call, grey materials.
class TestRoom {
 public:
  TestRoom() { scene_.source = "test-room"; }

  MaterialId material(bool two_sided = true, double radiance = 0) {
    Material m;
    m.name = "material" + std::to_string(scene_.materials.size());
    m.reflectance = Spectrum::Constant(1, 0.5);
    m.emitted_radiance = Spectrum::Constant(1, radiance);
    m.two_sided = two_sided;
    scene_.materials.push_back(m);
    return MaterialId(scene_.materials.size() - 1);
  }

  /// An empty surface to add faces to.
  SurfaceId surface(const std::string& name, MaterialId m) {
    Surface s;
    s.name = name;
    s.source = "test-room";
    s.material = m;
    scene_.surfaces.push_back(s);
    return SurfaceId(scene_.surfaces.size() - 1);
  }

  Face& add(SurfaceId id, const std::vector<Vec3>& outline) {
    Surface& s = scene_.surfaces[id.index()];
    Face f;
    for (const Vec3& p : outline) f.outer.push_back(index(s, p));
    s.faces.push_back(f);
    s.faces.back().source_line = static_cast<std::uint32_t>(s.faces.size());
    return s.faces.back();
  }

  void add_hole(SurfaceId id, const std::vector<Vec3>& outline) {
    Surface& s = scene_.surfaces[id.index()];
    auto& hole = s.faces.back().holes.emplace_back();
    for (const Vec3& p : outline) hole.push_back(index(s, p));
  }

  SurfaceId polygon(const std::string& name, MaterialId m, const std::vector<Vec3>& outline) {
    const SurfaceId id = surface(name, m);
    add(id, outline);
    return id;
  }

  /// Box with its fronts outside, or inside if `inwards`.
  SurfaceId box(const std::string& name, MaterialId m, const Vec3& lo, const Vec3& hi, bool inwards = false) {
    const SurfaceId id = surface(name, m);
    for (auto f : box_faces(lo, hi)) {
      if (inwards) std::reverse(f.begin(), f.end());
      add(id, f);
    }
    return id;
  }

  static std::vector<std::vector<Vec3>> box_faces(const Vec3& lo, const Vec3& hi) {
    const auto p = [&](int i) {
      return Vec3((i & 1) != 0 ? hi.x() : lo.x(), (i & 2) != 0 ? hi.y() : lo.y(),
                  (i & 4) != 0 ? hi.z() : lo.z());
    };
    return {{p(0), p(2), p(3), p(1)}, {p(4), p(5), p(7), p(6)}, {p(0), p(1), p(5), p(4)},
            {p(2), p(6), p(7), p(3)}, {p(0), p(4), p(6), p(2)}, {p(1), p(3), p(7), p(5)}};
  }

  Scene& scene() { return scene_; }

 private:
  static std::uint32_t index(Surface& s, const Vec3& p) {
    for (std::size_t i = 0; i < s.positions.size(); ++i)
      if (s.positions[i] == p) return static_cast<std::uint32_t>(i);
    s.positions.push_back(p);
    return static_cast<std::uint32_t>(s.positions.size() - 1);
  }

  Scene scene_;
};

/// Rectangle in the plane z, front up.
inline std::vector<Vec3> floor_rectangle(double x0, double y0, double x1, double y1, double z = 0) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

inline std::vector<Vec3> reversed(std::vector<Vec3> outline) {
  return {outline.rbegin(), outline.rend()};
}

/// Area of the base triangles of a surface, one side, those whose backs show its front among them [m2].
inline double meshed_area(const ZoneMesh& mesh, SurfaceId s) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    if (mesh.surface(t, true) == s) sum += mesh.triangle_area(t);
    if (mesh.is_back_to_back(t) && mesh.surface(t, false) == s) sum += mesh.triangle_area(t);
  }
  return sum;
}

/// Largest relative gap of input = meshed + removed + welded over all surfaces, and of the report against the
/// mesh.
inline double worst_book_gap(const MeshResult& r) {
  double worst = 0;
  for (std::size_t s = 0; s < r.report.surfaces.size(); ++s) {
    const SurfaceAreas& a = r.report.surfaces[s];
    if (a.input == 0) continue;
    worst = std::max(worst, std::abs(a.input - a.meshed - a.removed - a.welded) / a.input);
    worst = std::max(worst, std::abs(a.meshed - meshed_area(r.mesh, SurfaceId(s))) / a.input);
  }
  return worst;
}

/// Base edges that do not have exactly two triangles.
inline std::size_t open_edges(const ZoneMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const BaseTriangle& t : mesh.base().triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax({t.vertex[k], t.vertex[(k + 1) % 3]}));
  std::sort(edges.begin(), edges.end());
  std::size_t open = 0;
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if (j - i != 2) ++open;
  }
  return open;
}

}  // namespace reemit::test
