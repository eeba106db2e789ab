#include "scenes/io/native/native_shapes.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "scenes/io/common/surface_geometry.h"

namespace reemit {

namespace {

std::vector<std::uint32_t> append_loop(const JsonCursor& vertices, Surface& shape) {
  vertices.expect_array(3);
  std::vector<std::uint32_t> loop;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    loop.push_back(static_cast<std::uint32_t>(shape.positions.size()));
    shape.positions.push_back(vertices[i].place());
  }
  return loop;
}

}  // namespace

Surface read_polygon(const JsonCursor& at) {
  at.expect_object({"vertices", "holes"});
  Surface shape;
  Face face;
  face.outer = append_loop(at.at("vertices"), shape);
  if (const auto holes = at.find("holes")) {
    for (std::size_t i = 0; i < holes->size(); ++i) face.holes.push_back(append_loop((*holes)[i], shape));
  }
  shape.faces.push_back(std::move(face));
  return shape;
}

Surface read_quad(const JsonCursor& at) {
  at.expect_object({"corner", "u", "v"});
  const Vec3 corner = at.at("corner").place();
  const Vec3 u = at.at("u").place();
  const Vec3 v = at.at("v").place();
  if (!(u.cross(v).norm() > 0)) at.fail("u and v are parallel or zero", "Give two edges that span an area.");
  Surface shape;
  shape.positions = {corner, corner + u, corner + u + v, corner + v};
  shape.faces.push_back({{0, 1, 2, 3}, {}, {}, 0});
  return shape;
}

Surface read_box(const JsonCursor& at) {
  at.expect_object({"min", "max", "inward", "open"});
  const Vec3 low = at.at("min").place();
  const Vec3 high = at.at("max").place();
  if (!((high - low).array() > 0).all()) {
    at.at("max").fail("max must exceed min in every direction",
                      "Swap the corners, or use a quad for a flat thing.");
  }
  Surface shape;
  for (int i = 0; i < 8; ++i) {
    shape.positions.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                 i & 4 ? high.z() : low.z());
  }
  // Corner i has bit 0, 1, 2 set where it lies at the high x, y, z; loops run counter-clockwise seen from
  // outside.
  const std::vector<std::uint32_t> loops[] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& loop : loops) shape.faces.push_back({loop, {}, {}, 0});
  if (const auto open = at.find("open")) {
    const std::vector<std::string> names(std::begin(kBoxFaces), std::end(kBoxFaces));
    for (std::size_t i = 0; i < open->size(); ++i) {
      const std::string& name = (*open)[i].choice(names);
      const auto face = std::find(names.begin(), names.end(), name) - names.begin();
      shape.faces[static_cast<std::size_t>(face)].outer.clear();
    }
  }
  const auto inward = at.find("inward");
  if (inward && inward->boolean()) flip_surface(shape);
  return shape;
}

Surface read_mesh(const JsonCursor& at) {
  at.expect_object({"vertices", "faces"});
  Surface shape;
  const JsonCursor vertices = at.at("vertices");
  vertices.expect_array(3);
  for (std::size_t i = 0; i < vertices.size(); ++i) shape.positions.push_back(vertices[i].place());
  const JsonCursor faces = at.at("faces");
  faces.expect_array(1);
  const int last = static_cast<int>(shape.positions.size()) - 1;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    faces[i].expect_array(3);
    Face face;
    std::set<int> seen;
    for (std::size_t k = 0; k < faces[i].size(); ++k) {
      const int index = faces[i][k].integer_in(0, last);
      if (!seen.insert(index).second) {
        faces[i][k].fail(fmt::format("vertex {} stands twice in the face", index), "Name each vertex once.");
      }
      face.outer.push_back(static_cast<std::uint32_t>(index));
    }
    shape.faces.push_back(std::move(face));
  }
  return shape;
}

}  // namespace reemit
