#include "scenes/io/native/native_transform.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace reemit {

namespace {

constexpr int kMostPlacements = 100'000;

/// Cosine and sine of an angle in degrees, exact for quarter turns: what is turned by them stays in its
/// plane.
std::pair<double, double> cosine_and_sine(double degrees) {
  const double turn = std::remainder(degrees, 360.0);
  if (turn == 0) return {1, 0};
  if (turn == 90) return {0, 1};
  if (turn == -90) return {0, -1};
  if (std::abs(turn) == 180) return {-1, 0};
  const double angle = turn * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle)};
}

Eigen::Affine3d read_rotation(const JsonCursor& at) {
  at.expect_object({"axis", "angle_deg", "about"});
  const Vec3 given = at.at("axis").vec3();
  if (!(given.norm() > 0)) at.at("axis").fail("the axis has no length", "Give a direction, as in [0, 1, 0].");
  const Vec3 axis = given.normalized();
  const auto [c, s] = cosine_and_sine(at.at("angle_deg").number_in(-1e6, 1e6));
  Eigen::Matrix3d across;  // Cross product with the axis, for the formula of Rodrigues.
  across << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  Eigen::Affine3d rotation = Eigen::Affine3d::Identity();
  rotation.linear() = c * Eigen::Matrix3d::Identity() + s * across + (1 - c) * axis * axis.transpose();
  const auto about = at.find("about");
  const Vec3 centre = about ? about->place() : Vec3(0, 0, 0);
  return Eigen::Translation3d(centre) * rotation * Eigen::Translation3d(-centre);
}

Eigen::Affine3d read_matrix(const JsonCursor& at) {
  const std::vector<double> m = at.numbers();
  if (m.size() != 12 && m.size() != 16) {
    at.fail(fmt::format("a matrix of {} numbers", m.size()), "Give 12 or 16 numbers, row by row.");
  }
  if (m.size() == 16 && (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)) {
    at.fail("the last row is not 0 0 0 1",
            "Only affine matrices are possible; rows stand one after another.");
  }
  Eigen::Affine3d transform;
  transform.matrix().row(3) << 0, 0, 0, 1;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      transform(row, column) = m[4 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)];
    }
  }
  return transform;
}

Eigen::Affine3d read_step(const JsonCursor& at) {
  at.expect_object({"translate", "rotate", "scale", "matrix"});
  if (at.members().size() != 1) {
    at.fail("a step must be exactly one of translate, rotate, scale, matrix",
            "Write several steps as an array: [{\"rotate\": ...}, {\"translate\": ...}].");
  }
  if (const auto by = at.find("translate")) return Eigen::Affine3d(Eigen::Translation3d(by->place()));
  if (const auto by = at.find("rotate")) return read_rotation(*by);
  if (const auto by = at.find("matrix")) return read_matrix(*by);
  const JsonCursor by = at.at("scale");
  const Vec3 factors = by.is_number() ? Vec3::Constant(by.number()) : by.vec3();
  return Eigen::Affine3d(Eigen::Scaling(factors));
}

/// True if the transform is invertible for every practical purpose: compared with a cube of its longest image
/// edge.
bool keeps_volume(const Eigen::Affine3d& transform) {
  const Eigen::Matrix3d linear = transform.linear();
  if (!transform.matrix().allFinite()) return false;
  const double longest = linear.colwise().norm().maxCoeff();
  return longest > 0 && std::abs((linear / longest).determinant()) > 1e-12;
}

}  // namespace

Eigen::Affine3d read_transform(const JsonCursor& at) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (at.is_array()) {
    for (std::size_t i = 0; i < at.size(); ++i) transform = read_step(at[i]) * transform;
  } else {
    transform = read_step(at);
  }
  if (!keeps_volume(transform)) {
    at.fail("the transform flattens what it is applied to, or overflows", "Use scales other than 0.");
  }
  return transform;
}

std::vector<ArrayPlacement> read_array(const JsonCursor& at) {
  std::vector<ArrayPlacement> placements{{Eigen::Affine3d::Identity(), {}}};
  const std::size_t counters = at.is_array() ? at.size() : 1;
  for (std::size_t k = 0; k < counters; ++k) {
    const JsonCursor counter = at.is_array() ? at[k] : at;
    counter.expect_object({"count", "step", "rotate"});
    const int count = counter.at("count").integer_in(1, kMostPlacements);
    const auto step = counter.find("step");
    const auto rotate = counter.find("rotate");
    if (static_cast<bool>(step) == static_cast<bool>(rotate)) {
      counter.fail("an array needs either \"step\" or \"rotate\"", "Give one of the two.");
    }
    if (placements.size() * static_cast<std::size_t>(count) > kMostPlacements) {
      counter.fail(fmt::format("the array has more than {} placements", kMostPlacements), "Use fewer.");
    }
    const Eigen::Affine3d once =
        step ? Eigen::Affine3d(Eigen::Translation3d(step->place())) : read_rotation(*rotate);
    std::vector<ArrayPlacement> product;
    for (const ArrayPlacement& placement : placements) {
      Eigen::Affine3d power = Eigen::Affine3d::Identity();
      for (int i = 0; i < count; ++i) {
        product.push_back({placement.transform * power, placement.index});
        product.back().index.push_back(i);
        power = once * power;
      }
    }
    placements = std::move(product);
  }
  return placements;
}

}  // namespace reemit
