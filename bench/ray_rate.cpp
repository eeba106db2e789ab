// Rays per second of the solver over those of bare Embree on the very same rays: what the solver's own work
// costs. One process, in turns A B A B, so that a drift of the machine's speed hits both alike.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "bench/program_options.h"
#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/stopwatch.h"
#include "solver/losses/open_room.h"
#include "solver/room/room.h"
#include "solver/shoot/packet_batch.h"
#include "solver/tally/batch_plan.h"
#include "solver/zoning/build_zones.h"

namespace {

using namespace reemit;

/// Embree alone over the base triangles, with the scene settings that the solver uses.
class BareEmbree {
 public:
  BareEmbree(const ZoneMesh& mesh, const RayTracer& rays)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t count = mesh.triangle_count();
    auto* vertex =
        static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                    3 * sizeof(float), mesh.base().vertices.size()));
    auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
    for (const Vec3& p : mesh.base().vertices)
      for (const float x : rays.normalised(p)) *vertex++ = x;
    for (const BaseTriangle& t : mesh.base().triangles)
      index = std::copy(t.vertex.begin(), t.vertex.end(), index);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  /// Traces the rays in blocks of 16 and returns how many hit.
  std::size_t trace(const std::vector<Ray16>& blocks) const {
    tbb::enumerable_thread_specific<std::size_t> hits(std::size_t{0});
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), 256), [&](const auto& range) {
      alignas(64) const std::array<int, 16> valid{-1, -1, -1, -1, -1, -1, -1, -1,
                                                  -1, -1, -1, -1, -1, -1, -1, -1};
      std::size_t& mine = hits.local();
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        const Ray16& r = blocks[i];
        alignas(64) RTCRayHit16 query{};
        for (int k = 0; k < 16; ++k) {
          query.ray.org_x[k] = r.ox[k];
          query.ray.org_y[k] = r.oy[k];
          query.ray.org_z[k] = r.oz[k];
          query.ray.dir_x[k] = r.dx[k];
          query.ray.dir_y[k] = r.dy[k];
          query.ray.dir_z[k] = r.dz[k];
          query.ray.tfar[k] = std::numeric_limits<float>::infinity();
          query.ray.mask[k] = 0xffffffffU;
          query.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        }
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect16(valid.data(), scene_, &query);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect16(valid.data(), scene_, &context, &query);
#endif
        for (const unsigned g : query.hit.geomID) mine += g != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
      }
    });
    return hits.combine(std::plus<>());
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

struct Case {
  std::string room;
  double zones;
  SolveMethod method;
};

/// Rays per second in one round.
struct Rates {
  std::vector<double> solver;
  std::vector<double> embree;
};

/// `run` traces `rays` rays, as `bare` does those in whole blocks.
template <class Run>
Rates rates_of(const Run& run, std::uint64_t rays, const BareEmbree& bare, const std::vector<Ray16>& blocks,
               int rounds) {
  Rates rates;
  for (int round = 0; round <= rounds; ++round) {
    auto start = std::chrono::steady_clock::now();
    run(nullptr);
    const double solver = static_cast<double>(rays) / seconds_since(start);
    start = std::chrono::steady_clock::now();
    if (bare.trace(blocks) == 0) throw std::logic_error("bare Embree hit nothing");
    const double embree = 16.0 * static_cast<double>(blocks.size()) / seconds_since(start);
    if (round == 0) continue;  // warm-up
    rates.solver.push_back(solver);
    rates.embree.push_back(embree);
  }
  return rates;
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

void print(const Case& c, const ZoneMesh& mesh, std::uint64_t rays, std::uint64_t left_out,
           const Rates& rates) {
  std::vector<double> ratio;
  for (std::size_t i = 0; i < rates.solver.size(); ++i) ratio.push_back(rates.solver[i] / rates.embree[i]);
  fmt::print("{:<9} {:>8} {:>10} {:>10.2f} {:>8.2f} {:>8.2f} {:>8.2f} .. {:<8.2f} {:>8.2f}%\n",
             to_string(c.method), mesh.zone_count(), mesh.triangle_count(), static_cast<double>(rays) / 1e6,
             median(rates.solver) / 1e6, median(rates.embree) / 1e6, median(ratio),
             *std::min_element(ratio.begin(), ratio.end()),
             100.0 * static_cast<double>(left_out) / static_cast<double>(rays));
  std::fflush(stdout);
}

void measure(const Case& c, int threads, int rounds) {
  const Scene scene = read_scene(c.room);
  MeshSettings mesh_settings;
  mesh_settings.default_zone_count = static_cast<int>(c.zones);
  const MeshResult built = build_zones(scene, mesh_settings);
  Room walls(scene, built.mesh);
  const PacketRoom transport(walls);
  const PacketSources emission = collect_packet_sources(transport);
  if (is_open(transport, emission)) walls.believe_misses();
  SolverSettings settings;
  settings.method = c.method;
  const auto packets = static_cast<std::uint32_t>(
      std::max<std::size_t>(1'000'000, BatchPlan(settings, built.mesh.zone_count()).largest_batch_packets()));
  BatchBooks books = transport.new_books();
  const auto run = [&](const RayObserver* observer) {
    books.clear();
    const BatchTask task{transport, emission, settings, 0, packets, nullptr, observer};
    c.method == SolveMethod::kShooting ? shoot_batch(task, books) : walk_batch(task, books);
  };

  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::enumerable_thread_specific<std::vector<Ray16>> recorded;
    const RayObserver record = [&](const RayBlock& block) {
      if (block.count == 16) recorded.local().push_back(block.rays);
    };
    run(&record);
    std::vector<Ray16> blocks;
    for (auto& part : recorded) {
      blocks.insert(blocks.end(), part.begin(), part.end());
      part = {};
    }
    const std::uint64_t rays = books.rays;
    const BareEmbree bare(built.mesh, walls.rays());
    print(c, built.mesh, rays, rays - 16 * blocks.size(), rates_of(run, rays, bare, blocks, rounds));
  });
}

}  // namespace

int main(int argc, char** argv) {
  bench::ProgramOptions app("Rays per second of the solver and of bare Embree on the same rays");
  std::string room;
  std::vector<double> zones{3e3, 3e5};
  int threads = 2;
  int rounds = 7;
  app.add_option("room", room, "Room file").required();
  app.add_option("--zones", zones, "Zones aimed at, one case each").show_default();
  app.add_option("--threads", threads, "Threads").show_default();
  app.add_option("--rounds", rounds, "Counted rounds").show_default();
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    fmt::print("# {} with {} threads, median of {} rounds; left out: rays of incomplete blocks of 16\n", room,
               threads, rounds);
    fmt::print("{:<9} {:>8} {:>10} {:>10} {:>8} {:>8} {:>8} .. {:<8} {:>9}\n", "method", "zones", "triangles",
               "Mrays", "Mray/s", "bare", "ratio", "least", "left out");
    for (const double z : zones)
      for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk})
        measure({room, z, method}, threads, rounds);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}
