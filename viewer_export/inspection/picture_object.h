#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

/// Colour of a vertex: linear, 8 bits, opaque.
using Rgba = std::array<std::uint8_t, 4>;
/// Of sRGB components [0,1].
Rgba rgba_of_srgb(double r, double g, double b);

/// One named object of a picture: coloured triangles, or lines. Positions are floats relative to an origin.
class PictureObject {
 public:
  /// As it lies in the file.
  struct Vertex {
    std::array<float, 3> position;
    Rgba colour;
  };

  PictureObject(std::string name, const Vec3& origin) : name_(std::move(name)), origin_(origin) {}

  /// Corners counter-clockwise from where it is seen [m]. Triangles whose corners fall on one another in
  /// single precision are left out.
  void add_triangle(const std::array<Vec3, 3>& corners, const Rgba& colour);
  /// An object has lines or triangles, not both.
  void add_line(const Vec3& from, const Vec3& to, const Rgba& colour);
  /// Frees what only adding needs.
  void finish() { known_.clear(); }

  const std::string& name() const { return name_; }
  const std::vector<Vertex>& vertices() const { return vertices_; }
  /// Of vertices, three for a triangle, two for a line.
  const std::vector<std::uint32_t>& indices() const { return indices_; }
  bool has_lines() const { return has_lines_; }

 private:
  using Key = std::array<std::uint32_t, 4>;  // the bits of a vertex
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  std::uint32_t vertex_at(const Vec3& p, const Rgba& colour);

  std::string name_;
  Vec3 origin_;
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> indices_;
  bool has_lines_ = false;
  std::unordered_map<Key, std::uint32_t, KeyHash> known_;
};

}  // namespace reemit
