#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include "scenes/io/common/surface_builder.h"
#include "scenes/io/mgf/mgf_contexts.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Turns MGF faces into surfaces: one per object path, material and file.
class MgfSceneBuilder {
 public:
  /// Where the next faces belong.
  struct Target {
    const std::string& object;         ///< Names of the open objects joined by '/'; empty outside objects.
    const std::string& material_name;  ///< Empty: the unnamed material.
    const MgfMaterial& material;
    const std::string& file;
    std::uint32_t line;
  };

  /// Places faces in the room; a mirroring transform keeps fronts on their side. Throws InputError when the
  /// room grows beyond kMostFaces.
  void add(const std::vector<Polygon>& faces, const Eigen::Affine3d& transform, const Target& target);
  /// The same for a shape, which transforms of MGF leave what it is.
  void add(const CurvedShape& shape, const Eigen::Affine3d& transform, const Target& target);
  static constexpr std::size_t kMostFaces = 4'000'000;

  /// Moves everything into the scene, in order of first use.
  void finish(Scene& scene);

  std::vector<std::string> warnings;
  KindCounts refused;  ///< As in Scene.

 private:
  MaterialId material_id(const Target& target);
  void count(std::size_t faces, const Target& target);
  std::size_t surface_index(const Target& target);

  std::vector<Material> materials_;
  std::map<std::pair<std::string, MgfMaterial>, MaterialId> material_ids_;
  std::map<std::string, int> material_names_;
  std::vector<SurfaceBuilder> surfaces_;
  std::map<std::tuple<std::string, MaterialId, std::string>, std::size_t> surface_indices_;
  std::size_t face_count_ = 0;
};

}  // namespace reemit
