#include "solver/matrix/blocker_sieve.h"

#include <bit>
#include <limits>

#include <tbb/parallel_for.h>

#include "solver/matrix/zone_points.h"

namespace reemit {
namespace {

struct Bounds {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max());
  Vec3 high = -low;
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

}  // namespace

BlockerSieve::BlockerSieve(const ZoneMesh& mesh, double tolerance)
    : mesh_(&mesh),
      tolerance_(tolerance),
      words_((mesh.triangle_count() + 63) / 64),
      front_(mesh.zone_count() * words_),
      behind_(mesh.zone_count() * words_) {
  tbb::parallel_for(std::size_t{0}, mesh.zone_count(), [&](std::size_t z) {
    const ConvexPolygon zone = zone_polygon(mesh, ZoneId(z));
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const TriangleId id(t);
      const std::uint64_t bit = std::uint64_t{1} << (t % 64);
      for (std::size_t k = 0; k < zone.count; ++k) {
        const double height = mesh.triangle_normal(id).dot(zone.corner[k] - mesh.corner(id, 0));
        if (height > tolerance_) front_[z * words_ + t / 64] |= bit;
        if (height < -tolerance_) behind_[z * words_ + t / 64] |= bit;
      }
    }
  });
}

PairSight BlockerSieve::look(std::size_t i, std::size_t j, const FacingPair& pair) const {
  PairSight sight = PairSight::kOpen;
  for (std::size_t w = 0; w < words_; ++w) {
    const std::size_t a = i * words_ + w;
    const std::size_t b = j * words_ + w;
    std::uint64_t straddled = (front_[a] | front_[b]) & (behind_[a] | behind_[b]);
    for (; straddled != 0; straddled &= straddled - 1) {
      const TriangleId t(64 * w + static_cast<std::size_t>(std::countr_zero(straddled)));
      if (!may_block(t, pair)) continue;
      if (blocks_all(t, pair)) return PairSight::kHidden;
      sight = PairSight::kUnknown;
    }
  }
  return sight;
}

bool BlockerSieve::blocks_all(TriangleId t, const FacingPair& pair) const {
  const Vec3& normal = mesh_->triangle_normal(t);
  const double side = normal.dot(pair.a.corner[0] - mesh_->corner(t, 0)) > 0 ? 1 : -1;
  const auto height = [&](const Vec3& p) { return side * normal.dot(p - mesh_->corner(t, 0)); };
  for (std::size_t p = 0; p < pair.a.count; ++p) {
    const double height_a = height(pair.a.corner[p]);
    if (!(height_a > tolerance_)) return false;
    for (std::size_t q = 0; q < pair.b.count; ++q) {
      const double height_b = height(pair.b.corner[q]);
      if (!(height_b < -tolerance_)) return false;
      const Vec3 crossing =
          pair.a.corner[p] + height_a / (height_a - height_b) * (pair.b.corner[q] - pair.a.corner[p]);
      for (int k = 0; k < 3; ++k) {
        const Vec3 edge = mesh_->corner(t, (k + 1) % 3) - mesh_->corner(t, k);
        if (!(normal.cross(edge).dot(crossing - mesh_->corner(t, k)) >= 0)) return false;
      }
    }
  }
  return true;
}

bool BlockerSieve::may_block(TriangleId t, const FacingPair& pair) const {
  bool before_a = false;
  bool before_b = false;
  Bounds blocker;
  for (int k = 0; k < 3; ++k) {
    const Vec3& p = mesh_->corner(t, k);
    before_a = before_a || pair.a.normal.dot(p - pair.a.corner[0]) > tolerance_;
    before_b = before_b || pair.b.normal.dot(p - pair.b.corner[0]) > tolerance_;
    blocker.add(p);
  }
  if (!before_a || !before_b) return false;
  // The zones were asked for as wholes; what counts is the part that clipping has left.
  bool front = false;
  bool behind = false;
  Bounds box;
  for (const ConvexPolygon* part : {&pair.a, &pair.b})
    for (std::size_t k = 0; k < part->count; ++k) {
      const double height = mesh_->triangle_normal(t).dot(part->corner[k] - mesh_->corner(t, 0));
      front = front || height > tolerance_;
      behind = behind || height < -tolerance_;
      box.add(part->corner[k]);
    }
  if (!front || !behind) return false;
  return (blocker.low.array() <= box.high.array() + tolerance_).all() &&
         (blocker.high.array() >= box.low.array() - tolerance_).all();
}

}  // namespace reemit
