#include "scenes/io/native/native_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
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

TexturePoint at_uv(double u, double v) {
  TexturePoint point;
  point.uv[0] = {u, v};
  return point;
}

/// "texture_coordinates", one pair for each of `count` corners or vertices; false if there are none.
bool read_coordinates(const JsonCursor& at, std::size_t count, Surface& shape) {
  const auto given = at.find("texture_coordinates");
  if (!given) return false;
  if (given->size() != count)
    given->fail(fmt::format("{} texture coordinates for {} vertices", given->size(), count),
                "Give one pair per vertex.");
  shape.texture_points.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const JsonCursor pair = (*given)[i];
    pair.expect_array(2, 2);
    constexpr double kMost = 1e5;
    shape.texture_points[i].uv[0] = {pair[0].number_in(-kMost, kMost), pair[1].number_in(-kMost, kMost)};
  }
  return true;
}

/// "colours", one per vertex: a grey number or red, green and blue, linear.
bool read_colours(const JsonCursor& at, std::size_t count, Surface& shape) {
  const auto given = at.find("colours");
  if (!given) return false;
  if (given->size() != count)
    given->fail(fmt::format("{} colours for {} vertices", given->size(), count), "Give one per vertex.");
  shape.texture_points.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const JsonCursor colour = (*given)[i];
    const bool is_grey = colour.is_number();
    if (!is_grey) colour.expect_array(3, 3);
    for (std::size_t c = 0; c < 3; ++c)
      shape.texture_points[i].colour[c] =
          static_cast<float>(is_grey ? colour.number_in(0, 1) : colour[c].number_in(0, 1));
  }
  shape.has_vertex_colours = true;
  return true;
}

}  // namespace

Surface read_polygon(const JsonCursor& at) {
  at.expect_object({"vertices", "holes", "texture_coordinates"});
  Surface shape;
  Face face;
  face.outer = append_loop(at.at("vertices"), shape);
  if (const auto holes = at.find("holes")) {
    for (std::size_t i = 0; i < holes->size(); ++i) face.holes.push_back(append_loop((*holes)[i], shape));
  }
  if (read_coordinates(at, face.outer.size(), shape)) face.texture_points = face.outer;
  shape.faces.push_back(std::move(face));
  return shape;
}

Surface read_quad(const JsonCursor& at) {
  at.expect_object({"corner", "u", "v", "texture_coordinates"});
  const Vec3 corner = at.at("corner").place();
  const Vec3 u = at.at("u").place();
  const Vec3 v = at.at("v").place();
  if (!(u.cross(v).norm() > 0)) at.fail("u and v are parallel or zero", "Give two edges that span an area.");
  Surface shape;
  shape.positions = {corner, corner + u, corner + u + v, corner + v};
  constexpr std::array<std::array<double, 2>, 4> kWhole{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  if (!read_coordinates(at, kWhole.size(), shape))
    for (const auto& uv : kWhole) shape.texture_points.push_back(at_uv(uv[0], uv[1]));
  shape.faces.push_back({{0, 1, 2, 3}, {}, {}, 0, {0, 1, 2, 3}});
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
  // Texture coordinates are lengths from the low corner, along the two axes of the face in order.
  for (std::size_t f = 0; f < std::size(loops); ++f) {
    Face face{loops[f], {}, {}, 0};
    const auto across = static_cast<Eigen::Index>(f / 2);
    for (const std::uint32_t corner : loops[f]) {
      const Vec3 from_low = shape.positions[corner] - low;
      face.texture_points.push_back(static_cast<std::uint32_t>(shape.texture_points.size()));
      shape.texture_points.push_back(at_uv(from_low[across == 0 ? 1 : 0], from_low[across == 2 ? 1 : 2]));
    }
    shape.faces.push_back(std::move(face));
  }
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

int read_vertex(const JsonCursor& at, std::size_t vertices) {
  const double index = at.number();
  if (index != std::floor(index) || index < 0 || index >= static_cast<double>(vertices))
    at.fail(fmt::format("there is no vertex {}", index),
            fmt::format("The mesh has {} vertices, numbered from 0 to {}.", vertices, vertices - 1));
  return static_cast<int>(index);
}

Surface read_mesh(const JsonCursor& at) {
  at.expect_object({"vertices", "faces", "texture_coordinates", "colours"});
  Surface shape;
  const JsonCursor vertices = at.at("vertices");
  vertices.expect_array(3);
  for (std::size_t i = 0; i < vertices.size(); ++i) shape.positions.push_back(vertices[i].place());
  const bool has_coordinates = read_coordinates(at, shape.positions.size(), shape);
  const bool has_points = read_colours(at, shape.positions.size(), shape) || has_coordinates;
  const JsonCursor faces = at.at("faces");
  faces.expect_array(1);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    faces[i].expect_array(3);
    Face face;
    std::set<int> seen;
    for (std::size_t k = 0; k < faces[i].size(); ++k) {
      const int index = read_vertex(faces[i][k], shape.positions.size());
      if (!seen.insert(index).second) {
        faces[i][k].fail(fmt::format("vertex {} stands twice in the face", index), "Name each vertex once.");
      }
      face.outer.push_back(static_cast<std::uint32_t>(index));
    }
    if (has_points) face.texture_points = face.outer;
    shape.faces.push_back(std::move(face));
  }
  return shape;
}

}  // namespace reemit
