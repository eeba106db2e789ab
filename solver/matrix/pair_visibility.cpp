#include "solver/matrix/pair_visibility.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "solver/matrix/zone_points.h"
#include "solver/sampling/shapes/polygon_sampler.h"
#include "solver/sampling/sobol.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

constexpr std::uint32_t kScrambles = 8;
constexpr std::uint32_t kMostCheckRays = 512;
constexpr double kFirstRaysPerFactor = 1024;
constexpr double kCheckRaysPerFactor = 16384;
constexpr double kScrambleRaysPerFactor = 8192;
/// How far of the way from a corner to the middle of a part the rays between corners stay: on the corner
/// itself they would graze the surfaces that meet there.
constexpr float kCornerInset = 0.003F;

/// Power of two nearest above `wanted`, within limits that are powers of two.
std::uint32_t ray_count(double wanted, std::uint32_t least, std::uint32_t most) {
  return std::bit_ceil(static_cast<std::uint32_t>(std::clamp(wanted, double{1} * least, double{1} * most)));
}

/// From this many times its longest edge on, points of a triangle are drawn by area: its solid angle gains
/// nothing there.
constexpr float kFarEdges = 2;

struct FanTriangle {
  Vec3f a, b, c;
  float area = 0;
  float longest_edge2 = 0;

  Vec3f middle() const { return (a + b + c) / 3.0F; }
};

/// A facing part as a fan of triangles in the space of rays.
class Fan {
 public:
  Fan(const ConvexPolygon& part, const RayTracer& rays, const ZonePoints& zone) : zone_(&zone) {
    std::array<Vec3f, ConvexPolygon::kMostCorners> p;
    middle_ = rays.normalised(part.middle());
    corners_ = part.count;
    for (std::size_t k = 0; k < part.count; ++k) {
      p[k] = rays.normalised(part.corner[k]);
      near_corner_[k] = p[k] + kCornerInset * (middle_ - p[k]);
    }
    for (std::size_t k = 2; k < part.count; ++k) {
      FanTriangle& t = triangle_[count_++];
      t.a = p[0];
      t.b = p[k - 1];
      t.c = p[k];
      t.area = 0.5F * (t.b - t.a).cross(t.c - t.a).norm();
      t.longest_edge2 =
          std::max({(t.b - t.a).squaredNorm(), (t.c - t.b).squaredNorm(), (t.a - t.c).squaredNorm()});
      area_ += t.area;
    }
  }

  bool empty() const { return !(area_ > 0); }
  std::size_t corners() const { return corners_; }
  const Vec3f& near_corner(std::size_t k) const { return near_corner_[k]; }
  const ZonePoints& zone() const { return *zone_; }
  Vec3f lifted(const Vec3f& point) const { return RayTracer::lifted(point, zone_->normal(), middle_); }
  /// Triangle chosen in proportion to its area; `u` is then uniform again.
  const FanTriangle& pick(float& u) const {
    float left = u * area_;
    for (std::size_t k = 0; k + 1 < count_; ++k) {
      if (left < triangle_[k].area) {
        u = std::min(left / triangle_[k].area, kLargestBelowOne);
        return triangle_[k];
      }
      left -= triangle_[k].area;
    }
    const FanTriangle& last = triangle_[count_ - 1];
    u = std::clamp(left / last.area, 0.0F, kLargestBelowOne);
    return last;
  }
  float probability(const FanTriangle& t) const { return t.area / area_; }
  /// Uniform point.
  Vec3f point(float u0, float u1) const {
    const FanTriangle& t = pick(u0);
    const auto [u, v] = sample_triangle(u0, u1);
    return (1 - u - v) * t.a + u * t.b + v * t.c;
  }

 private:
  const ZonePoints* zone_;
  std::array<FanTriangle, ConvexPolygon::kMostCorners - 2> triangle_;
  std::array<Vec3f, ConvexPolygon::kMostCorners> near_corner_;
  Vec3f middle_{0, 0, 0};  // rays are drawn towards it, which keeps them on this side of what parts the room
  std::size_t corners_ = 0;
  std::size_t count_ = 0;
  float area_ = 0;
};

/// Weighted number of rays of one scramble, and of those that arrived.
struct Tally {
  double sent = 0;
  double arrived = 0;
};

/// One ray of a share: its weight, and whether it arrived.
struct WeightedRay {
  double weight = 0;
  bool arrived = false;
};

WeightedRay look_in_solid_angle(const RayTracer& rays, const Fan& from, const Fan& to,
                                const SobolSequence& numbers, std::uint32_t index) {
  const Vec3f x = from.point(numbers.sample(index, 0), numbers.sample(index, 1));
  float u = numbers.sample(index, 2);
  const FanTriangle& target = to.pick(u);
  const bool near = (target.middle() - x).squaredNorm() < kFarEdges * kFarEdges * target.longest_edge2;
  const TriangleSampler sampler({target.a.cast<double>(), target.b.cast<double>(), target.c.cast<double>()},
                                to.zone().normal().cast<double>(), x.cast<double>(),
                                from.zone().normal().cast<double>(),
                                near ? Density::kSolidAngle : Density::kArea);
  if (!sampler.lights()) return {};
  const ShapePoint y = sampler.sample(static_cast<double>(u), static_cast<double>(numbers.sample(index, 3)));
  if (!(y.irradiance > 0)) return {};
  return {y.irradiance / static_cast<double>(to.probability(target)),
          rays.visible(from.lifted(x), to.lifted(y.point.cast<float>()))};
}

/// A ratio of weighted sums and the variance that follows from how independent parts of it differ.
VisibleShare share_of_parts(std::span<const Tally> parts) {
  Tally sum;
  for (const Tally& t : parts) {
    sum.sent += t.sent;
    sum.arrived += t.arrived;
  }
  VisibleShare result;
  result.share = sum.sent > 0 ? sum.arrived / sum.sent : 0;
  double squares = 0;
  for (const Tally& t : parts) {
    const double residual = t.arrived - result.share * t.sent;
    squares += residual * residual;
  }
  const auto n = static_cast<double>(parts.size());
  if (sum.sent > 0) result.variance = squares * n / ((n - 1) * sum.sent * sum.sent);
  return result;
}

/// Of a share of which `rays` rays met no blocker. One that takes 1 / rays of the view may stand there, but
/// in most pairs none does.
double unseen_variance(std::uint32_t rays) {
  constexpr double kChance = 1.0 / 8;
  return kChance / (static_cast<double>(rays) * static_cast<double>(rays));
}

/// Share of a pair that first looks found uniform. Its rays count one by one, as if they were independent.
VisibleShare checked_share(const RayTracer& rays, const Fan& a, const Fan& b, std::uint64_t seed,
                           std::uint32_t count) {
  const SobolSequence numbers(seed);
  std::array<Tally, kMostCheckRays> tallies;
  bool any_arrived = false;
  bool any_blocked = false;
  for (std::uint32_t k = 0; k < count; ++k) {
    const WeightedRay ray = look_in_solid_angle(rays, a, b, numbers, k);
    tallies[k] = {ray.weight, ray.arrived ? ray.weight : 0};
    any_arrived = any_arrived || (ray.weight > 0 && ray.arrived);
    any_blocked = any_blocked || (ray.weight > 0 && !ray.arrived);
  }
  if (!any_arrived) return {0, 0, false, count};
  if (!any_blocked) return {1, unseen_variance(count), false, count};
  VisibleShare result = share_of_parts(std::span(tallies).first(count));
  result.sampled = true;
  result.rays = count;
  return result;
}

/// Share of a pair that first looks found mixed.
VisibleShare mixed_share(const RayTracer& rays, const Fan& a, const Fan& b,
                         const std::array<std::uint64_t, kScrambles>& seeds, std::uint32_t per_scramble) {
  std::array<Tally, kScrambles> tallies;
  for (std::size_t s = 0; s < kScrambles; ++s) {
    const SobolSequence numbers(seeds[s]);
    for (std::uint32_t k = 0; k < per_scramble; ++k) {
      const WeightedRay ray = look_in_solid_angle(rays, a, b, numbers, k);
      tallies[s].sent += ray.weight;
      if (ray.arrived) tallies[s].arrived += ray.weight;
    }
  }
  VisibleShare result = share_of_parts(tallies);
  result.rays = kScrambles * per_scramble;
  // Scrambles that happen to agree do not make a share exact.
  const double least = 1 / (static_cast<double>(result.rays) * static_cast<double>(result.rays));
  result.variance = std::max(result.variance, least);
  result.sampled = true;
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

  std::uint32_t clear = 0;
  const auto agree = [&] { return clear == 0 || clear == result.rays; };
  const auto look_along = [&](const Vec3f& x, const Vec3f& y) {
    ++result.rays;
    clear += rays_->visible(a.lifted(x), b.lifted(y)) ? 1 : 0;
  };
  for (std::size_t p = 0; p < a.corners() && agree(); ++p)
    for (std::size_t q = 0; q < b.corners() && agree(); ++q) look_along(a.near_corner(p), b.near_corner(q));
  const SobolSequence numbers(matrix_seed(seed_, MatrixNumbers::kFirstRays, index, 0));
  const std::uint32_t first = ray_count(kFirstRaysPerFactor * factor, 8, 64);
  for (std::uint32_t k = 0; k < first && agree(); ++k)
    look_along(a.point(numbers.sample(k, 0), numbers.sample(k, 1)),
               b.point(numbers.sample(k, 2), numbers.sample(k, 3)));

  const std::uint32_t first_rays = result.rays;
  if (agree()) {
    result = checked_share(*rays_, a, b, matrix_seed(seed_, MatrixNumbers::kShare, index, 0),
                           ray_count(kCheckRaysPerFactor * factor, 64, kMostCheckRays));
  } else {
    std::array<std::uint64_t, kScrambles> seeds;
    for (std::uint32_t s = 0; s < kScrambles; ++s)
      seeds[s] = matrix_seed(seed_, MatrixNumbers::kShare, index, s);
    result = mixed_share(*rays_, a, b, seeds, ray_count(kScrambleRaysPerFactor * factor, 32, 128));
  }
  result.rays += first_rays;
  return result;
}

}  // namespace reemit
