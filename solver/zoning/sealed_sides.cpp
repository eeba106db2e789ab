#include "solver/zoning/sealed_sides.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mesh/geometry/disjoint_sets.h"
#include "solver/emit/light_places.h"
#include "solver/emit/punctual_emitter.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "solver/trace/surface_point.h"

namespace reemit {
namespace {

constexpr std::uint64_t kRaySeed = 1;  // nothing of a solution should depend on it
/// Rays from every side at least, and in all in rooms of few sides.
constexpr std::uint32_t kLeastRounds = 4;
constexpr std::size_t kManyRays = 400'000;
/// Rays sent at once: enough for all cores.
constexpr std::size_t kRaysAtOnce = 65'536;
/// Rounds of further rays from sides that seem sealed.
constexpr std::uint32_t kSecondThoughts = 28;
/// Of sides that have met each other so many send one in a round of these, in turn: a ray that gets out from
/// any of them opens all.
constexpr std::size_t kSpeakers = 32;
constexpr std::uint32_t kMostRaysPerLight = 4096;
constexpr std::uint32_t kLeastRaysPerLight = 64;
constexpr std::uint32_t kRaysOfLights = 1U << 22;  // of all, but for the least
/// Points keep this share of a triangle's size away from its edges, where rounding decides what a ray meets.
constexpr float kSealMargin = 0.02F;

constexpr std::uint32_t kNothing = 0xffffffff;
constexpr std::uint32_t kOutside = 0xfffffffe;

class Reach {
 public:
  explicit Reach(const Room& room)
      : mesh_(room.mesh()),
        rays_(room.rays()),
        rng_(kRaySeed, RngPurpose::kSealedSides),
        sides_(mesh_.side_count()),
        light_(sides_),
        sets_(sides_ + 1) {
    for (std::uint32_t s = 0; s < sides_; ++s) {
      const TriangleId t = triangle_of(SideId(s));
      if (room.surfaces().emits(t, is_front(SideId(s)))) sets_.join(s, light_);
      // Light comes through glass and opal sheets to what lies behind.
      if (is_front(SideId(s)) && has_zones(s) && room.surfaces().any_specular() &&
          room.surfaces().specular(t).lets_light_through())
        sets_.join(s, side_of(t, false).index());
    }
    join_lights(room.scene());
    if (room.sky() != nullptr) is_outside_lit_ = true;
  }

  void join_neighbours(const WorkWatch& watch) {
    const std::uint32_t rounds = static_cast<std::uint32_t>(
        std::max<std::size_t>(kManyRays / std::max<std::size_t>(1, sides_), kLeastRounds));
    std::vector<std::uint32_t> asked;
    for (std::uint32_t s = 0; s < sides_; ++s)
      if (has_zones(s)) asked.push_back(s);
    const auto at_once = static_cast<std::uint32_t>(
        std::clamp<std::size_t>(kRaysAtOnce / std::max<std::size_t>(1, asked.size()), 1, rounds));
    for (std::uint32_t round = 0; round < rounds; round += at_once) {
      watch.at(0.8 * round / rounds);
      join_seen(asked, round, std::min(at_once, rounds - round));
    }
    for (std::uint32_t more = 0; more < kSecondThoughts; ++more) {
      watch.at(0.8 + 0.2 * more / kSecondThoughts);
      std::erase_if(asked, [&](std::uint32_t s) { return is_lit(s); });
      if (asked.empty()) break;
      join_seen(speakers(asked, more), rounds + more, 1);
    }
  }

  std::vector<std::uint8_t> sealed() {
    std::vector<std::uint8_t> result(sides_, 0);
    for (std::uint32_t s = 0; s < sides_; ++s) result[s] = has_zones(s) && !is_lit(s) ? 1 : 0;
    return result;
  }

 private:
  bool has_zones(std::uint32_t s) const { return mesh_.has_zones(SideId(s)); }
  bool is_lit(std::uint32_t s) { return sets_.find(s) == sets_.find(light_); }

  void join_lights(const Scene& scene) {
    const std::vector<PunctualLight> lights = lights_before_faces(scene, rays_);
    const auto rays_per_light = static_cast<std::uint32_t>(std::clamp<std::size_t>(
        kRaysOfLights / std::max<std::size_t>(1, lights.size()), kLeastRaysPerLight, kMostRaysPerLight));
    for (const PunctualLight& light : lights) {
      const PunctualEmitter emitter = make_punctual_emitter(light, rays_);
      if (is_at_infinity(emitter)) is_outside_lit_ = true;
      std::uint32_t met[16];
      for (std::uint32_t first = 0; first < rays_per_light; first += 16) {
        alignas(64) float u[4][16];
        for (std::uint32_t k = 0; k < 16; ++k) {
          const std::array<float, 4> numbers = rng_.uniform4(first + k, kNothing, 0);
          for (std::size_t d = 0; d < 4; ++d) u[d][k] = numbers[d];
        }
        std::array<LightRay, 16> starts;
        start_light_rays(emitter, {u[0], u[1], u[2], u[3]}, starts);
        Ray16 rays;
        for (int k = 0; k < 16; ++k) {
          const LightRay& start = starts[static_cast<std::size_t>(k)];
          rays.set(k, start.origin, start.direction);
        }
        look(rays, 16, met);
        for (const std::uint32_t side : met) join(static_cast<std::uint32_t>(light_), side);
      }
    }
  }

  /// The sides that the first `count` of 16 rays meet.
  void look(const Ray16& rays, int count, std::uint32_t* met) const {
    Hit16 hits;
    rays_.closest16(rays, count, hits);
    rays_.look_again16(rays, count, hits);
    for (int lane = 0; lane < count; ++lane) {
      const TriangleId t(hits.triangle[lane]);
      if (hits.triangle[lane] == RayTracer::kMiss)
        met[lane] = kOutside;
      else if (!mesh_.has_zones(t, hits.front[lane]) || rays_.is_at_edge(hits, lane))
        met[lane] = kNothing;
      else
        met[lane] = static_cast<std::uint32_t>(side_of(t, hits.front[lane]).index());
    }
  }

  void join(std::uint32_t from, std::uint32_t to) {
    // What leaves an open room does not come back, so the outside joins nothing unless light comes from
    // there.
    if (to == kOutside) {
      if (is_outside_lit_) sets_.join(from, light_);
    } else if (to != kNothing) {
      sets_.join(from, to);
    }
  }

  /// Of `sides`, which seem sealed, those whose turn it is among sides that have met each other.
  std::vector<std::uint32_t> speakers(const std::vector<std::uint32_t>& sides, std::uint32_t turn) {
    std::vector<std::uint32_t> size(sides_, 0);
    for (const std::uint32_t s : sides) ++size[sets_.find(s)];
    std::vector<std::uint32_t> seen(sides_, 0);
    std::vector<std::uint32_t> chosen;
    for (const std::uint32_t s : sides) {
      const std::size_t set = sets_.find(s);
      const std::size_t turns = (size[set] + kSpeakers - 1) / kSpeakers;
      if (seen[set]++ % turns == turn % turns) chosen.push_back(s);
    }
    return chosen;
  }

  /// Rays number `first` to `first` + `count` - 1 of each of these sides.
  void join_seen(const std::vector<std::uint32_t>& sides, std::uint32_t first, std::uint32_t count) {
    std::vector<std::uint32_t> met(sides.size() * count);
    const std::size_t blocks = (met.size() + 15) / 16;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, 64), [&](const auto& range) {
      Ray16 rays;
      for (std::size_t block = range.begin(); block != range.end(); ++block) {
        const std::size_t begin = 16 * block;
        const int lanes = static_cast<int>(std::min<std::size_t>(16, met.size() - begin));
        for (int lane = 0; lane < lanes; ++lane) {
          const std::size_t i = begin + static_cast<std::size_t>(lane);
          start(sides[i / count], first + static_cast<std::uint32_t>(i % count), rays, lane);
        }
        look(rays, lanes, &met[begin]);
      }
    });
    for (std::size_t i = 0; i < met.size(); ++i) join(sides[i / count], met[i]);
  }

  /// Ray number `round` of a side.
  void start(std::uint32_t side, std::uint32_t round, Ray16& rays, int lane) const {
    const std::array<float, 4> u = rng_.uniform4(side, round, 0);
    auto [a, b] = sample_triangle(u[0], u[1]);
    a = kSealMargin + (1 - 3 * kSealMargin) * a;
    b = kSealMargin + (1 - 3 * kSealMargin) * b;
    const SurfacePoint x = surface_point(rays_, triangle_of(SideId(side)), a, b, is_front(SideId(side)));
    rays.set(lane, ray_origin(rays_, x), Frame(x.normal).to_world(sample_cosine_hemisphere(u[2], u[3])));
  }

  const ZoneMesh& mesh_;
  const RayTracer& rays_;
  CounterRng rng_;
  std::size_t sides_;
  std::size_t light_;  // stands for all that emits
  bool is_outside_lit_ = false;
  DisjointSets sets_;
};

}  // namespace

std::vector<std::uint8_t> sealed_sides(const Room& room, const WorkWatch& watch) {
  Reach reach(room);
  reach.join_neighbours(watch);
  return reach.sealed();
}

}  // namespace reemit
