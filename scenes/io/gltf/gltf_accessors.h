#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/io/gltf/gltf_model.h"
#include "scenes/model/vec.h"

namespace reemit {

/// Reads accessors with every index, offset and length checked against what the file holds. `where` is the
/// JSON pointer of what uses the accessor, for the InputError.
class GltfAccessors {
 public:
  explicit GltfAccessors(const GltfModel& gltf) : gltf_(gltf) {}

  /// Vectors of three numbers; normalized integers become [0,1] or [-1,1]. Every number is finite.
  std::vector<Vec3> vec3(int accessor, const std::string& where) const;
  std::vector<Eigen::Vector4d> vec4(int accessor, const std::string& where) const;
  std::vector<std::array<double, 2>> vec2(int accessor, const std::string& where) const;
  /// Unsigned integers, each below `limit`.
  std::vector<std::uint32_t> indices(int accessor, std::size_t limit, const std::string& where) const;
  /// The bytes of a buffer view.
  std::pair<const unsigned char*, std::size_t> view_bytes(int view, const std::string& where) const;

 private:
  std::vector<double> numbers(int accessor, int components, const std::string& where) const;
  void apply_sparse(const tinygltf::Accessor& accessor, int components, const std::string& where,
                    std::vector<double>& values) const;
  [[noreturn]] void fail(const std::string& where, const std::string& problem) const;

  const GltfModel& gltf_;
};

}  // namespace reemit
