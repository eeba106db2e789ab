#pragma once
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "mesh/build_mesh.h"
#include "mesh/shapes/room_shapes.h"
#include "scenes/model/scene.h"

namespace reemit::test {

/// Values of the three bands of a room of colours.
inline Spectrum rgb(double r, double g, double b) {
  return Spectrum{{r, g, b}};
}

/// A room built quad by quad with its zones, without readers or mesher, so that tests of the solver stand on
/// their own.
class RoomBuilder {
 public:
  explicit RoomBuilder(BandSet bands = BandSet::grey()) { scene_.bands = std::move(bands); }

  Spectrum flat(double value) const {
    return Spectrum::Constant(static_cast<Eigen::Index>(scene_.bands.count()), value);
  }

  /// Lambertian material; reflectance [1] and exitance [W/m2] the same in all bands.
  MaterialId material(const std::string& name, double reflectance, double exitance = 0,
                      bool two_sided = false) {
    return material(name, flat(reflectance), flat(exitance), two_sided);
  }
  MaterialId material(const std::string& name, const Spectrum& reflectance, const Spectrum& exitance,
                      bool two_sided = false) {
    Material m;
    m.name = name;
    m.reflectance = reflectance;
    m.emitted_radiance = exitance / 3.14159265358979323846;
    m.two_sided = two_sided;
    scene_.materials.push_back(m);
    return MaterialId(scene_.materials.size() - 1);
  }

  /// Planar quad as a surface of its own, corners counter-clockwise from the front, two base triangles of n*n
  /// zones.
  RoomBuilder& quad(MaterialId material, const std::array<Vec3, 4>& corners, std::uint32_t divisions) {
    return polygon("quad", material, corners, divisions);
  }

  /// A triangle as a surface of its own, corners counter-clockwise from the front.
  RoomBuilder& triangle(MaterialId material, const std::array<Vec3, 3>& corners, std::uint32_t divisions) {
    return polygon("triangle", material, corners, divisions);
  }

  /// Inside of an axis-parallel box; materials of x0, x1, y0, y1, z0, z1. An invalid id leaves that side
  /// open.
  RoomBuilder& box(const Vec3& low, const Vec3& high, const std::array<MaterialId, 6>& m,
                   std::uint32_t divisions) {
    const std::array<std::array<Vec3, 4>, 6> faces = box_faces(low, high);
    for (std::size_t i = 0; i < 6; ++i)
      if (m[i].valid()) quad(m[i], faces[i], divisions);
    return *this;
  }

  /// Outside of an axis-parallel box.
  RoomBuilder& solid(const Vec3& low, const Vec3& high, MaterialId material, std::uint32_t divisions) {
    for (const auto& [a, b, c, d] : box_faces(low, high)) quad(material, {a, d, c, b}, divisions);
    return *this;
  }

  /// A curved shape as a surface of its own; every patch has n*n zones.
  RoomBuilder& shape(MaterialId material, const CurvedShape& shape, std::uint32_t divisions) {
    Surface s;
    s.name = "shape" + std::to_string(scene_.surfaces.size());
    s.material = material;
    s.shapes.push_back(shape);
    scene_.surfaces.push_back(s);
    shapes_.exact.push_back(shape);
    shapes_.surface.emplace_back(scene_.surfaces.size() - 1);
    shapes_.index.push_back(0);
    shape_divisions_.push_back(divisions);
    return *this;
  }

  Scene& scene() { return scene_; }
  const Scene& scene() const { return scene_; }
  MeshResult mesh() const {
    BaseMesh base = base_;
    MeshReport report;
    report.surfaces.resize(scene_.surfaces.size());
    append_patches(scene_, shapes_, base, report);
    for (BaseTriangle& t : base.triangles)
      if (t.is_curved()) t.divisions = shape_divisions_[t.shape];
    return {ZoneMesh(std::move(base)), MeshReport{}};
  }

 private:
  RoomBuilder& polygon(const char* name, MaterialId material, std::span<const Vec3> corners,
                       std::uint32_t divisions) {
    Surface s;
    s.name = name + std::to_string(scene_.surfaces.size());
    s.material = material;
    s.positions.assign(corners.begin(), corners.end());
    s.faces.emplace_back().outer.resize(corners.size());
    std::iota(s.faces[0].outer.begin(), s.faces[0].outer.end(), 0U);
    scene_.surfaces.push_back(s);
    const auto first = static_cast<std::uint32_t>(base_.vertices.size());
    base_.vertices.insert(base_.vertices.end(), corners.begin(), corners.end());
    for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) {
      BaseTriangle t;
      t.vertex = {first, first + k, first + k + 1};
      t.surface = SurfaceId(scene_.surfaces.size() - 1);
      t.divisions = divisions;
      t.two_sided = scene_.materials[material.index()].two_sided;
      base_.triangles.push_back(t);
    }
    return *this;
  }

  /// Fronts inside.
  static std::array<std::array<Vec3, 4>, 6> box_faces(const Vec3& low, const Vec3& high) {
    const auto p = [&](int x, int y, int z) {
      return Vec3(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
    };
    return {{{p(0, 0, 0), p(0, 1, 0), p(0, 1, 1), p(0, 0, 1)},
             {p(1, 0, 0), p(1, 0, 1), p(1, 1, 1), p(1, 1, 0)},
             {p(0, 0, 0), p(0, 0, 1), p(1, 0, 1), p(1, 0, 0)},
             {p(0, 1, 0), p(1, 1, 0), p(1, 1, 1), p(0, 1, 1)},
             {p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0)},
             {p(0, 0, 1), p(0, 1, 1), p(1, 1, 1), p(1, 0, 1)}}};
  }

  Scene scene_;
  BaseMesh base_;
  RoomShapes shapes_;
  std::vector<std::uint32_t> shape_divisions_;
};

}  // namespace reemit::test
