#include "scenes/io/mgf/mgf_transform.h"

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"
#include "scenes/model/vec.h"

namespace reemit {
namespace {

// Takes arguments from the front and complains about what it finds there.
class Arguments {
 public:
  Arguments(std::span<const std::string_view> words, const std::string& where)
      : words_(words), where_(where) {}

  bool empty() const { return words_.empty(); }
  std::string_view word() {
    const std::string_view first = words_.front();
    words_ = words_.subspan(1);
    return first;
  }
  double number(std::string_view option) {
    const auto value = words_.empty() ? std::nullopt : parse_number(word());
    if (!value)
      throw InputError(where_, fmt::format("'{}' lacks a number", option),
                       "See 'xf' in the MGF description.");
    return *value;
  }
  std::int64_t count(std::string_view option, std::int64_t least) {
    const auto value = words_.empty() ? std::nullopt : parse_integer(word());
    if (!value || *value < least || *value > MgfTransform::kMostInstances)
      throw InputError(
          where_, fmt::format("'{}' lacks a sensible count", option),
          fmt::format("Give a whole number from {} to {}.", least, MgfTransform::kMostInstances));
    return *value;
  }

 private:
  std::span<const std::string_view> words_;
  const std::string& where_;
};

// Degrees to a rotation that is exact for multiples of 90, so that axis-aligned rooms stay axis-aligned.
Eigen::Affine3d rotation(double degrees, const Vec3& axis) {
  const double turn = std::remainder(degrees, 360.0);
  const double quarters = turn / 90;
  if (quarters == std::round(quarters)) {
    constexpr std::array<double, 4> kCos = {1, 0, -1, 0}, kSin = {0, 1, 0, -1};
    const auto q = static_cast<std::size_t>(std::lround(quarters) + 4) % 4;
    const Eigen::Matrix3d along = axis * axis.transpose();
    Eigen::Matrix3d cross;
    cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    const Eigen::Matrix3d turned = along + kCos[q] * (Eigen::Matrix3d::Identity() - along) + kSin[q] * cross;
    return Eigen::Affine3d(turned);
  }
  return Eigen::Affine3d(Eigen::AngleAxisd(turn * std::numbers::pi / 180, axis));
}

Eigen::Affine3d power(Eigen::Affine3d base, std::int64_t exponent) {
  if (base.linear() ==
      Eigen::Matrix3d::Identity())  // most arrays: one rounding instead of one per repetition
    return Eigen::Affine3d(Eigen::Translation3d(static_cast<double>(exponent) * base.translation()));
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = base * result;
    if (exponent > 1) base = base * base;
  }
  return result;
}

Eigen::Affine3d scaling(double x, double y, double z) {
  return Eigen::Affine3d(Eigen::Scaling(x, y, z));
}

Eigen::Affine3d parse_one(std::string_view option, Arguments& arguments, const std::string& where) {
  if (option == "-t") {
    const double x = arguments.number(option);
    const double y = arguments.number(option);
    const double z = arguments.number(option);
    return Eigen::Affine3d(Eigen::Translation3d(x, y, z));
  }
  if (option == "-rx") return rotation(arguments.number(option), Vec3::UnitX());
  if (option == "-ry") return rotation(arguments.number(option), Vec3::UnitY());
  if (option == "-rz") return rotation(arguments.number(option), Vec3::UnitZ());
  if (option == "-mx") return scaling(-1, 1, 1);
  if (option == "-my") return scaling(1, -1, 1);
  if (option == "-mz") return scaling(1, 1, -1);
  if (option == "-s") {
    const double factor = arguments.number(option);
    if (factor == 0)
      throw InputError(where, "'-s 0' shrinks everything to a point", "Give a factor other than 0.");
    return scaling(factor, factor, factor);
  }
  throw InputError(where, fmt::format("'{}' is not a transform", option),
                   "Known are -t -rx -ry -rz -s -mx -my -mz -i -a.");
}

}  // namespace

MgfTransform::MgfTransform(std::span<const std::string_view> words, const std::string& where) {
  Arguments arguments(words, where);
  steps_.emplace_back();
  while (!arguments.empty()) {
    const std::string_view option = arguments.word();
    if (option == "-i") {
      steps_.push_back({false, arguments.count(option, 0), Eigen::Affine3d::Identity()});
    } else if (option == "-a") {
      const std::int64_t count = arguments.count(option, 1);
      if (count > kMostInstances / instances_)
        throw InputError(where, "the arrays hold too many instances",
                         fmt::format("At most {}.", kMostInstances));
      instances_ *= count;
      steps_.push_back({true, count, Eigen::Affine3d::Identity()});
    } else {
      steps_.back().transform = parse_one(option, arguments, where) * steps_.back().transform;
    }
  }
}

Eigen::Affine3d MgfTransform::instance(std::int64_t instance) const {
  Eigen::Affine3d total = Eigen::Affine3d::Identity();
  std::int64_t remaining = instances_;
  for (const Step& step : steps_) {
    std::int64_t repeats = step.count;
    if (step.array) {
      remaining /= step.count;
      repeats = instance / remaining % step.count;
    }
    total = power(step.transform, repeats) * total;
  }
  return total;
}

}  // namespace reemit
