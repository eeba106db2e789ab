#include "solver/matrix/pair_visibility.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "solver/emit/triangle_light.h"
#include "solver/matrix/zone_points.h"
#include "solver/sampling/sobol.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

constexpr std::uint32_t kScrambles = 8;

/// Power of two nearest above `wanted`, within limits that are powers of two.
std::uint32_t ray_count(double wanted, std::uint32_t least, std::uint32_t most) {
  return std::bit_ceil(static_cast<std::uint32_t>(std::clamp(wanted, double{1} * least, double{1} * most)));
}

/// A facing part as a fan of triangles in the space of rays.
class Fan {
 public:
  Fan(const ConvexPolygon& part, const RayScene& rays, const ZonePoints& zone) : zone_(&zone) {
    std::array<Vec3f, ConvexPolygon::kMostCorners> p;
    for (std::size_t k = 0; k < part.count; ++k) p[k] = rays.normalised(part.corner[k]);
    for (std::size_t k = 2; k < part.count; ++k) {
      TriangleLight& t = triangle_[count_++];
      t.a = p[0];
      t.b = p[k - 1];
      t.c = p[k];
      t.normal = zone.normal();
      t.area = 0.5F * (t.b - t.a).cross(t.c - t.a).norm();
      t.longest_edge2 =
          std::max({(t.b - t.a).squaredNorm(), (t.c - t.b).squaredNorm(), (t.a - t.c).squaredNorm()});
      area_ += t.area;
    }
  }

  bool empty() const { return !(area_ > 0); }
  const ZonePoints& zone() const { return *zone_; }
  Vec3f lifted(const Vec3f& point) const {
    return RayScene::lifted(point, zone_->normal(), zone_->triangle_middle());
  }
  /// Triangle chosen in proportion to its area; `u` is then uniform again.
  const TriangleLight& pick(float& u) const {
    float left = u * area_;
    for (std::size_t k = 0; k + 1 < count_; ++k) {
      if (left < triangle_[k].area) {
        u = std::min(left / triangle_[k].area, 0x1.fffffep-1F);
        return triangle_[k];
      }
      left -= triangle_[k].area;
    }
    const TriangleLight& last = triangle_[count_ - 1];
    u = std::clamp(left / last.area, 0.0F, 0x1.fffffep-1F);
    return last;
  }
  float probability(const TriangleLight& t) const { return t.area / area_; }
  /// Uniform point.
  Vec3f point(float u0, float u1) const {
    const TriangleLight& t = pick(u0);
    const auto [u, v] = sample_triangle(u0, u1);
    return (1 - u - v) * t.a + u * t.b + v * t.c;
  }

 private:
  const ZonePoints* zone_;
  std::array<TriangleLight, ConvexPolygon::kMostCorners - 2> triangle_;
  std::size_t count_ = 0;
  float area_ = 0;
};

/// Weighted number of rays of one scramble, and of those that arrived.
struct Tally {
  double sent = 0;
  double arrived = 0;
};

Tally look_in_solid_angle(const RayScene& rays, const Fan& from, const Fan& to, std::uint64_t seed,
                          std::uint32_t count) {
  const SobolSequence numbers(seed);
  Tally tally;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vec3f x = from.point(numbers.sample(k, 0), numbers.sample(k, 1));
    float u = numbers.sample(k, 2);
    const TriangleLight& target = to.pick(u);
    TriangleLightSample sample;
    if (!sample_triangle_light(target, x, from.zone().normal(), u, numbers.sample(k, 3), sample)) continue;
    const double weight = static_cast<double>(sample.factor / to.probability(target));
    const Vec3f y = (1 - sample.u - sample.v) * target.a + sample.u * target.b + sample.v * target.c;
    tally.sent += weight;
    if (rays.visible(from.lifted(x), to.lifted(y))) tally.arrived += weight;
  }
  return tally;
}

VisibleShare sampled_share(const std::array<Tally, kScrambles>& tallies, std::uint32_t rays) {
  Tally sum;
  for (const Tally& t : tallies) {
    sum.sent += t.sent;
    sum.arrived += t.arrived;
  }
  VisibleShare result;
  result.sampled = true;
  result.share = sum.sent > 0 ? sum.arrived / sum.sent : 0;
  double squares = 0;
  for (const Tally& t : tallies) {
    const double residual = t.arrived - result.share * t.sent;
    squares += residual * residual;
  }
  constexpr double kDegrees = double{kScrambles} * (kScrambles - 1);
  const double mean_sent = sum.sent / kScrambles;
  const double variance = mean_sent > 0 ? squares / (kDegrees * mean_sent * mean_sent) : 0;
  // Scrambles that happen to agree do not make a share exact.
  const double least = 1 / (static_cast<double>(rays) * static_cast<double>(rays));
  result.variance = std::max(variance, least);
  return result;
}

}  // namespace

VisibleShare PairVisibility::look(ZoneId i, ZoneId j, const FacingPair& pair, double factor) const {
  const ZoneMesh& mesh = rays_->mesh();
  const ZonePoints zone_a(mesh, *rays_, i);
  const ZonePoints zone_b(mesh, *rays_, j);
  const Fan a(pair.a, *rays_, zone_a);
  const Fan b(pair.b, *rays_, zone_b);
  VisibleShare result;
  if (a.empty() || b.empty()) return result;
  const std::uint64_t index = i.index() * mesh.zone_count() + j.index();

  const SobolSequence numbers(matrix_seed(seed_, MatrixNumbers::kFirstRays, index, 0));
  const std::uint32_t first = ray_count(1024 * factor, 16, 256);
  std::uint32_t clear = 0;
  while (result.rays < first && (clear == 0 || clear == result.rays)) {
    const std::uint32_t k = result.rays++;
    const Vec3f x = a.point(numbers.sample(k, 0), numbers.sample(k, 1));
    const Vec3f y = b.point(numbers.sample(k, 2), numbers.sample(k, 3));
    clear += rays_->visible(a.lifted(x), b.lifted(y)) ? 1 : 0;
  }
  if (clear == 0 || clear == result.rays) {
    result.share = clear > 0 ? 1 : 0;
    return result;
  }

  const std::uint32_t per_scramble = ray_count(8192 * factor, 8, 128);
  std::array<Tally, kScrambles> tallies;
  for (std::uint32_t s = 0; s < kScrambles; ++s)
    tallies[s] =
        look_in_solid_angle(*rays_, a, b, matrix_seed(seed_, MatrixNumbers::kShare, index, s), per_scramble);
  const std::uint32_t first_rays = result.rays;
  result = sampled_share(tallies, kScrambles * per_scramble);
  result.rays = first_rays + kScrambles * per_scramble;
  return result;
}

}  // namespace reemit
