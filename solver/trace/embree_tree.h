#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "solver/texture/room_textures.h"
#include "solver/trace/shape_hit.h"

namespace reemit {

/// Bits that depend on every bit of x [MUR3].
inline std::uint32_t mixed_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x85ebca6bU;
  x ^= x >> 13;
  x *= 0xc2b2ae35U;
  return x ^ (x >> 16);
}

/// How far rays without an end reach.
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What RayTracer gives to Embree to build its tree from. Throws ResourceError when Embree cannot be started
/// or runs out of memory.
class EmbreeTree {
 public:
  /// Geometry numbers. The triangles of kTriangles have their number in the base mesh, shapes theirs in
  /// BaseMesh::shapes, those of kFeet and kCutOuts their place in the list of triangles set apart.
  static constexpr unsigned kTriangles = 0;
  static constexpr unsigned kShapes = 1;
  static constexpr unsigned kFeet = 2;
  static constexpr unsigned kCutOuts = 3;

  EmbreeTree();
  ~EmbreeTree();
  EmbreeTree(const EmbreeTree&) = delete;
  EmbreeTree& operator=(const EmbreeTree&) = delete;

  /// `feet`: triangles that form a geometry of their own (kFeet), as do the cut-outs of textures, which must
  /// outlive the tree and may be null.
  void add_triangles(const std::vector<Vec3f>& vertices, std::span<const BaseTriangle> triangles,
                     const std::vector<std::uint32_t>& feet, const RoomTextures* textures);
  void add_shapes(const std::vector<CurvedShape>& shapes);
  /// Triangles kTriangles about which `filter` is asked whenever a ray meets one, and may let it pass.
  void add_filtered(const std::vector<Vec3f>& vertices,
                    const std::vector<std::array<std::uint32_t, 3>>& indices, RTCFilterFunctionN filter);
  /// Builds the tree.
  void commit();

  RTCScene scene() const { return scene_; }

 private:
  void add(const std::vector<Vec3f>& vertices, const std::vector<std::array<std::uint32_t, 3>>& indices,
           unsigned number, RTCFilterFunctionN filter = nullptr, const void* of_filter = nullptr);

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::vector<ShapeTarget> targets_;  // Embree keeps a pointer to them
};

}  // namespace reemit
