#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "scenes/model/scene.h"

namespace reemit::hit_paths {

/// Where a ray met the room as it was read.
struct RoomHit {
  double distance = 0;  ///< [m]
  Vec3 point{0, 0, 0};
  Vec3 normal{0, 0, 1};  ///< Unit, on the side that the ray came from.
  bool front = true;
  const Material* material = nullptr;
  std::uint32_t part = 0;  ///< For RayStart::part.
};

struct RayStart {
  static constexpr std::uint32_t kFree = 0xffffffff;
  Vec3 point{0, 0, 0};
  std::uint32_t part = kFree;  ///< RoomHit::part of the surface that the ray leaves; kFree in free space.
};

/// The room of the file, for a reference: its polygons and round shapes just as they were read, all in double
/// precision, found through a tree of boxes. Nothing of the mesher, of RayTracer or of Embree is in it: no
/// welding, no cuts, no triangles, no tolerance but one. Holes are where a ray crosses an even number of
/// outlines, so that holes drawn by seams are holes whatever their winding. Const members may be called from
/// any thread.
class PolygonRoom {
 public:
  explicit PolygonRoom(const Scene& scene);

  /// Nearest surface along a ray of unit direction that is not the back of a one-sided face if
  /// `through_backs`.
  std::optional<RoomHit> closest(const RayStart& start, const Vec3& direction, bool through_backs) const;

  double diagonal() const { return diagonal_; }  ///< Of the bounding box [m].

 private:
  struct Polygon {
    Vec3 origin, u, v, normal;  // right-handed; the normal points to the front
    std::vector<std::vector<Eigen::Vector2d>> loops;
  };
  struct Part {
    Box box;
    const Material* material = nullptr;
    std::uint32_t polygon = 0;         // into polygons_, or
    std::uint32_t shape = kNoShape;    // into shapes_
    std::vector<std::uint32_t> twins;  // polygons in the same plane that overlap this one
  };
  struct Node {
    Box box;
    std::uint32_t first = 0;  // part of a leaf, or the second child of a branch (the first one follows it)
    std::uint32_t count = 0;  // parts of a leaf; 0: a branch
  };
  static constexpr std::uint32_t kNoShape = 0xffffffff;

  void add_face(const Surface& surface, const Face& face, const Material& material);
  void add_polygon(std::vector<std::vector<Vec3>> loops, const Material& material);
  void add_shape(const CurvedShape& shape, const Material& material);
  std::uint32_t build(std::size_t first, std::size_t last);
  void find_twins();
  /// Distance to one part in (near, far), and the front normal there; nothing if it is not met.
  std::optional<double> meet(const Part& part, const Vec3& origin, const Vec3& direction, double near,
                             double far, Vec3& normal) const;
  template <class Use>
  void walk(const Vec3& origin, const Vec3& direction, double& far, Use&& use) const;
  const Part& winner(std::uint32_t part, const Vec3& point, const Vec3& direction) const;

  std::vector<Polygon> polygons_;
  std::vector<CurvedShape> shapes_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> order_;  // of the parts, in the leaves
  std::vector<Node> nodes_;
  double diagonal_ = 0;
};

}  // namespace reemit::hit_paths
