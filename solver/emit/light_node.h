#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "scenes/model/vec.h"

namespace reemit {

/// The point that luminaires are chosen for.
struct Receiver {
  Vec3f x;      ///< Normalised.
  Vec3f n;      ///< Unit, or 0 for a point without a horizon.
  Vec3f abs_n;  ///< Absolute values of n.
  Receiver(const Vec3f& point, const Vec3f& normal) : x(point), n(normal), abs_n(normal.cwiseAbs()) {}
};

/// Up to four children of a node of a light tree with their bounds side by side: 64 bytes each, fetched at
/// once, and looked at with one instruction for all four.
struct alignas(32) LightNode {
  static constexpr int kWidth = 4;
  static constexpr std::uint32_t kLeaf = 0x80000000U;

  float centre[3][kWidth];  ///< Of the box, normalised space.
  float half[3][kWidth];    ///< Half its size.
  float axis[3][kWidth];    ///< Of the cone of normals.
  float cos_normals[kWidth];
  float sin_normals[kWidth];
  float cos_emission[kWidth];
  float intensity[kWidth];      ///< Share of all luminaires; 0 where there is no child.
  std::uint32_t child[kWidth];  ///< Index of a node, or kLeaf + index of a luminaire.
  /// First and behind the last of its luminaires in LightTree::order_, where it is a ball of lamps that shine
  /// to all sides; else both 0.
  std::uint32_t begin[kWidth], end[kWidth];
};
static_assert(sizeof(LightNode) == 256);

using Importance = std::array<float, LightNode::kWidth>;

/// Estimates of the irradiance from each child without occlusion, up to a common factor: intensity times both
/// cosines at their largest over the bounding sphere of the box, over the squared distance to its middle
/// [CON18, eq. 3]. That counts as no less than a third of the squared radius of the sphere: in the middle of
/// a ball evenly full of luminaires this gives what all of them together give. 0 only if the whole box is
/// below the horizon or every side in it faces away, by more than rounding could pretend.
inline Importance importance(const LightNode& node, const Receiver& at) {
  // How far float rounding may move the height of a box over the horizon, as a share of the terms summed, and
  // the cosine to the limit of emission, whose angles lose half their digits near 0 and pi.
  constexpr float kHeightSlack = 1e-6F;
  constexpr float kCosineSlack = 2e-3F;
  constexpr float kLeastCosine = 1e-3F;      // A child that may contribute is never worth nothing,
  constexpr float kLeastDistance2 = 1e-20F;  // nor infinitely much,
  constexpr float kLeast = 1e-30F;           // nor does its worth underflow.
  Importance result;
  for (int i = 0; i < LightNode::kWidth; ++i) {
    const float dx = node.centre[0][i] - at.x[0];
    const float dy = node.centre[1][i] - at.x[1];
    const float dz = node.centre[2][i] - at.x[2];
    const float hx = node.half[0][i];
    const float hy = node.half[1][i];
    const float hz = node.half[2][i];
    const float distance2 = dx * dx + dy * dy + dz * dz;
    const float radius2 = hx * hx + hy * hy + hz * hz;
    const float inverse2 = 1 / (distance2 > kLeastDistance2 ? distance2 : kLeastDistance2);

    const float height = at.n[0] * dx + at.n[1] * dy + at.n[2] * dz;
    const float reach = at.abs_n[0] * hx + at.abs_n[1] * hy + at.abs_n[2] * hz;
    const float terms =
        at.abs_n[0] * std::fabs(dx) + at.abs_n[1] * std::fabs(dy) + at.abs_n[2] * std::fabs(dz) + reach;
    const float facing = -(node.axis[0][i] * dx + node.axis[1][i] * dy + node.axis[2][i] * dz);

    // The bounding sphere reaches from its middle over an angle with sine radius/distance. Angles are
    // subtracted by the addition theorem, where a difference below 0 counts as 0. All sines and cosines are
    // kept times the distance, and their products times its square: so the square roots do not wait for each
    // other.
    const bool inside = radius2 >= distance2;
    const float radius = std::sqrt(radius2);
    const float tangent2 = distance2 - radius2;
    const float tangent = std::sqrt(tangent2 > 0 ? tangent2 : 0.0F);
    const auto beside = [distance2](float cosine) {
      const float sine2 = distance2 - cosine * cosine;
      return std::sqrt(sine2 > 0 ? sine2 : 0.0F);
    };
    const float to_middle = height * tangent + beside(height) * radius;
    const float at_receiver = (inside | (height >= tangent)) ? 1.0F : to_middle * inverse2;

    const float sine = beside(facing);
    const bool faced = inside | (facing >= tangent);
    const float from_axis = (facing * tangent + sine * radius) * inverse2;
    const float from_axis_sine = (sine * tangent - facing * radius) * inverse2;
    const float from_cone = from_axis * node.cos_normals[i] + from_axis_sine * node.sin_normals[i];
    const float at_luminaire = (faced | (from_axis >= node.cos_normals[i])) ? 1.0F : from_cone;

    const float full2 = radius2 * (1.0F / 3);
    const float nearest2 = full2 > distance2 ? full2 : distance2;
    const float strength = node.intensity[i] / (nearest2 > kLeastDistance2 ? nearest2 : kLeastDistance2);
    const float cosines = (at_receiver > kLeastCosine ? at_receiver : kLeastCosine) *
                          (at_luminaire > kLeastCosine ? at_luminaire : kLeastCosine);
    const float worth = strength * cosines;
    const bool possible = (height + reach >= -kHeightSlack * terms) &
                          (at_luminaire >= node.cos_emission[i] - kCosineSlack) & (node.intensity[i] > 0);
    const float at_least = worth > kLeast ? worth : kLeast;
    result[static_cast<std::size_t>(i)] = possible ? at_least : 0.0F;
  }
  return result;
}

}  // namespace reemit
