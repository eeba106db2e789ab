#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace reemit {

/// The arguments of an MGF `xf`, `i` or `ies` entity: similarity transforms (rotation, translation, uniform
/// scale, mirroring), some of which repeat their contents as an array [MGF].
class MgfTransform {
 public:
  /// No arguments: identity, one instance.
  MgfTransform() = default;
  /// Parses -t -rx -ry -rz -s -mx -my -mz -i -a. Throws InputError at `where` if an argument is unknown or
  /// malformed or the arrays hold more than kMostInstances.
  MgfTransform(std::span<const std::string_view> arguments, const std::string& where);

  static constexpr std::int64_t kMostInstances = 10'000'000;

  /// Product of the -a counts, >= 1.
  std::int64_t instance_count() const { return instances_; }
  /// Transform of one instance, 0 <= instance < instance_count(); the last array runs fastest.
  Eigen::Affine3d instance(std::int64_t instance) const;

 private:
  struct Step {
    bool array = false;
    std::int64_t count = 1;  // repetitions (-i) or instances (-a)
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  };
  std::vector<Step> steps_;
  std::int64_t instances_ = 1;
};

}  // namespace reemit
