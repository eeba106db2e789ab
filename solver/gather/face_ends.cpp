#include "solver/gather/face_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "solver/gather/caustic_photons.h"
#include "solver/trace/surface_point.h"

namespace reemit {
namespace {

/// Places on a spiral around the one that is asked about, in radii of the kernel, and how the kernel couples
/// them. Beyond one radius lies what decides the gain of those within.
class KernelPatch {
 public:
  static constexpr int kPlaces = 64;
  static constexpr float kReach = std::numbers::sqrt2_v<float>;
  /// As many lie within one radius.
  static constexpr int kWithin = kPlaces / 2;

  KernelPatch() {
    constexpr float kArea = std::numbers::pi_v<float> * kReach * kReach / kPlaces;  // of a place
    for (int k = 0; k < kPlaces; ++k) {
      const float phi =
          2 * std::numbers::pi_v<float> * static_cast<float>(k) * (std::numbers::phi_v<float> - 1);
      const float r = kReach * std::sqrt((static_cast<float>(k) + 0.5F) / kPlaces);
      places_.col(k) = r * Eigen::Vector2f(std::cos(phi), std::sin(phi));
    }
    for (int k = 0; k < kPlaces; ++k) {
      to_middle_[k] = kArea * kernel(places_.col(k).squaredNorm());
      for (int j = 0; j < kPlaces; ++j)
        coupling_(j, k) = kArea * kernel((places_.col(j) - places_.col(k)).squaredNorm());
    }
    whole_ = coupling_.rowwise().sum();
  }

  Eigen::Vector2f place(int k) const { return places_.col(k); }

  /// In the middle of a face that holds the places where `on_face` is 1, and not those where it is 0.
  FaceEnds::Kernel kernel_on(const Eigen::Vector<float, kPlaces>& on_face) const {
    constexpr int kRounds = 4;
    constexpr float kLeast = 1e-3F;  // of what a whole face brings
    constexpr float kMost = 6;
    Eigen::Vector<float, kPlaces> gains = on_face;
    for (int round = 0; round < kRounds; ++round) {
      // What a whole face would bring within the patch stands for what it does beyond its rim, too.
      const Eigen::Array<float, kPlaces, 1> brought =
          (coupling_ * gains).array().max(kLeast * whole_.array());
      gains = on_face.array() * (gains.array() * whole_.array() / brought).sqrt().min(kMost);
    }
    const float whole = to_middle_.sum();
    return {to_middle_.dot(on_face) / whole,
            std::min(kMost, whole / std::max(kLeast, to_middle_.dot(gains)))};
  }

 private:
  static float kernel(float squared_distance) {
    return std::max(0.0F, 2 / std::numbers::pi_v<float> * (1 - squared_distance));
  }

  Eigen::Matrix<float, 2, kPlaces> places_;
  Eigen::Vector<float, kPlaces> to_middle_;
  Eigen::Matrix<float, kPlaces, kPlaces> coupling_;
  Eigen::Vector<float, kPlaces> whole_;
};

}  // namespace

bool FaceEnds::is_beside_wall(const Vec3f& normal, const Vec3f& place, float radius) const {
  constexpr int kDirections = 8;
  const Frame frame(normal);
  const Vec3f from = place + kLiftOverFace * radius * normal;
  Ray16 along;
  for (int k = 0; k < kDirections; ++k) {
    const float phi = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / kDirections;
    along.set(k, from, frame.to_world({std::cos(phi), std::sin(phi), 0}));
  }
  Hit16 hits;
  rays_->closest16(along, kDirections, hits);
  return std::any_of(hits.distance, hits.distance + kDirections, [&](float d) { return d < radius; });
}

bool FaceEnds::is_inside_triangle(TriangleId triangle, const Vec3f& place, float radius) const {
  if (triangle.index() >= flat_count_) return false;
  const Vec3f& normal = rays_->normal(triangle);
  for (int k = 0; k < 3; ++k) {
    const Vec3f from = rays_->corner(triangle, k);
    const Vec3f edge = rays_->corner(triangle, (k + 1) % 3) - from;
    if (normal.cross(edge).dot(place - from) < radius * edge.norm()) return false;
  }
  return true;
}

FaceEnds::Kernel FaceEnds::kernel(const Vec3f& normal, const Vec3f& place, float radius, float turn,
                                  bool beside_wall) const {
  static const KernelPatch patch;
  const Frame frame(normal);
  const float lift = kLiftOverFace * radius;
  const Vec3f from = place + lift * normal;
  const float phi = 2 * std::numbers::pi_v<float> * turn;
  const Eigen::Rotation2Df rotation(phi);
  Eigen::Vector<float, KernelPatch::kPlaces> on_face;
  const auto goes_on = [&](const Ray16& down, const Hit16& below, int lane) {
    const Vec3f there = side_normal(*rays_, TriangleId(below.triangle[lane]), below.u[lane], below.v[lane],
                                    below.front[lane]);
    const Vec3f met = down.origin(lane) - below.distance[lane] * normal;
    return there.dot(normal) > kSameFace && is_level(normal, there, met - place);
  };
  // Finds out about 16 places, from the first on by steps; true if all lie on the face.
  const auto look = [&](int first, int step) {
    Ray16 along;
    Ray16 down;
    std::array<float, 16> way;
    for (int lane = 0; lane < 16; ++lane) {
      const Eigen::Vector2f in_face = radius * (rotation * patch.place(first + lane * step));
      const Vec3f to = frame.to_world({in_face.x(), in_face.y(), 0});
      way[static_cast<std::size_t>(lane)] = to.norm();
      along.set(lane, from, to.normalized());
      down.set(lane, from + to, -normal);
    }
    Hit16 below;
    rays_->closest16(down, 16, below);
    rays_->look_again16(down, 16, below);
    Hit16 between;
    if (beside_wall) rays_->closest16(along, 16, between);
    bool all = true;
    for (int lane = 0; lane < 16; ++lane) {
      const bool met = below.distance[lane] < 2.5F * lift && goes_on(down, below, lane);
      const bool hidden = beside_wall && between.distance[lane] < way[static_cast<std::size_t>(lane)];
      on_face[first + lane * step] = met && !hidden ? 1 : 0;
      all = all && met && !hidden;
    }
    return all;
  };
  // Most kernels lie on one face, which every other place tells.
  if (look(0, 2)) return {};
  look(1, 2);
  for (int k = KernelPatch::kWithin; k < KernelPatch::kPlaces; k += 16) look(k, 1);
  return patch.kernel_on(on_face);
}

}  // namespace reemit
