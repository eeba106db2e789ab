#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "scenes/io/common/polygon_loops.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Collects polygons into one Surface; corners and normals with the same coordinates are stored once.
class SurfaceBuilder {
 public:
  /// `source`: the file, for messages.
  SurfaceBuilder(std::string name, std::string source, MaterialId material);

  /// `source_line`: in the file; 0 = not known.
  void add(const Polygon& polygon, std::uint32_t source_line);
  void add(const CurvedShape& shape) { surface_.shapes.push_back(shape); }
  const Surface& surface() const { return surface_; }
  /// The builder is empty afterwards.
  Surface take() { return std::move(surface_); }

 private:
  using Key = std::array<double, 3>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  using Index = std::unordered_map<Key, std::uint32_t, KeyHash>;
  static std::uint32_t index_of(const Vec3& p, std::vector<Vec3>& points, Index& index);

  Surface surface_;
  Index positions_, normals_, texture_points_;
};

/// Adds the material in parentheses to the names of surfaces that would otherwise be called the same.
void tell_surfaces_apart(Scene& scene);

}  // namespace reemit
