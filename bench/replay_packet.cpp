// The way of one packet of a solve through its room, ray by ray: what happened where a zone, a leak or a back
// hit looks wrong. A packet is known by its batch and its number; the random numbers of a solve follow from
// these, so it goes the same way again.

#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "bench/program_options.h"
#include "solver/gather/sampled_direct_light.h"
#include "solver/room/room.h"
#include "solver/shoot/packet_batch.h"
#include "solver/solution/room_of_solution.h"
#include "solver/solution/solution_file.h"
#include "solver/tally/batch_plan.h"

namespace {

using namespace reemit;

struct Options {
  std::filesystem::path solution;
  std::optional<std::uint32_t> batch;
  std::uint32_t packet = 0;
  std::uint32_t sweep = 0;
  bool lost = false;
};

/// Packets of a batch of a run.
std::uint32_t packets_of_batch(const Solution& solution, std::uint32_t batch) {
  if (static_cast<std::int64_t>(batch) >= solution.sums.batches)
    throw std::out_of_range(
        fmt::format("the solution has {} batches, numbered from 0", solution.sums.batches));
  const BatchPlan plan(solution.settings, solution.mesh.zone_count(), solution.record.unit_packets);
  std::int64_t done = 0;
  std::int64_t of_batch = 0;
  for (std::int64_t k = 0; k < solution.sums.batches; ++k) {
    const std::int64_t weight = plan.next_weight(k, done);
    if (k == batch) of_batch = weight;
    done += weight;
  }
  if (done != solution.sums.weight())
    throw std::invalid_argument(
        "a time limit made batches of this solution shorter than planned, by how much it does not say; solve "
        "it with --packets instead of --time to replay it");
  return static_cast<std::uint32_t>(of_batch * plan.unit_packets());
}

std::string place_text(const Vec3& p) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x(), p.y(), p.z());
}

/// One line for a ray: where it starts and what it meets, second look included.
std::string ray_text(const Room& room, const Vec3f& origin, const Vec3f& direction) {
  const RayTracer& rays = room.rays();
  std::string text = fmt::format("from {} along {}: ", place_text(rays.in_room(origin)),
                                 place_text(direction.cast<double>()));
  Hit hit;
  if (!rays.closest(origin, direction, hit)) return text + "leaves the room";
  const ZoneMesh& mesh = room.mesh();
  const ZoneId zone = mesh.zone_at(hit.triangle, hit.u, hit.v, hit.front);
  const Surface& surface = room.scene().surfaces[mesh.triangle(hit.triangle).surface.index()];
  text += fmt::format(
      "meets the {} of '{}' at {} after {:.6g} m", hit.front ? "front" : "back", surface.name,
      place_text(mesh.point(hit.triangle, static_cast<double>(hit.u), static_cast<double>(hit.v))),
      static_cast<double>(hit.distance) * rays.metres_per_unit());
  return text + (zone.valid() ? fmt::format(", zone {}", zone.index()) : ", which absorbs everything");
}

/// A solution with its room, ready to send its packets once more.
struct Run {
  explicit Run(const std::filesystem::path& file)
      : solution(load_solution(file)),
        scene(read_room_of(solution, file)),
        room(scene, solution.mesh),
        transport(room),
        emission(collect_packet_sources(transport)),
        direct(sampled_direct_light(transport, emission, solution.settings,
                                    static_cast<std::uint32_t>(solution.record.unit_packets))) {
    if (solution.settings.method == SolveMethod::kMatrix)
      throw std::invalid_argument("the solution is of the matrix method, which has no packets");
  }

  void send(std::uint32_t batch, std::uint32_t packets, const RayObserver& observer) {
    BatchBooks books = transport.new_books();
    BatchTask task{transport, emission, solution.settings, batch, packets};
    task.ray_observer = &observer;
    const auto unit = static_cast<std::uint32_t>(solution.record.unit_packets);
    const bool may_be_sampled = direct && direct->is_for(packets / std::int64_t{unit});
    if (may_be_sampled && !direct->has_looked_at_all() &&
        !prepare(transport, emission, solution.settings, unit, *direct))
      direct.reset();
    if (may_be_sampled && direct) task.first_together = SampledDirectLight::kFirstTogether;
    if (solution.settings.method == SolveMethod::kShooting)
      shoot_batch(task, books);
    else
      walk_batch(task, books);
  }

  Solution solution;
  Scene scene;
  Room room;
  PacketRoom transport;
  PacketSources emission;
  std::optional<SampledDirectLight> direct;
};

/// Whether a ray ends where light should not get: outside, on a side without zones, or on one that is sealed.
bool is_lost(const Room& room, const Vec3f& origin, const Vec3f& direction) {
  Hit hit;
  if (!room.rays().closest(origin, direction, hit)) return true;
  const ZoneId zone = room.mesh().zone_at(hit.triangle, hit.u, hit.v, hit.front);
  return !zone.valid() || room.mesh().is_sealed(zone);
}

/// Prints every ray that is lost, of one batch or of all.
void list_lost_rays(Run& run, std::optional<std::uint32_t> only) {
  std::mutex printing;
  std::size_t lost = 0;
  const std::uint32_t end = only ? *only + 1 : static_cast<std::uint32_t>(run.solution.sums.batches);
  for (std::uint32_t batch = only.value_or(0); batch < end; ++batch) {
    run.send(batch, packets_of_batch(run.solution, batch), [&](const RayBlock& block) {
      for (int lane = 0; lane < block.count; ++lane) {
        if (!is_lost(run.room, block.rays.origin(lane), block.rays.direction(lane))) continue;
        const std::lock_guard<std::mutex> lock(printing);
        ++lost;
        fmt::print("batch {}, packet {}, {} {}: {}\n", batch, block.id[lane],
                   run.solution.settings.method == SolveMethod::kShooting ? "sweep" : "bounce", block.flight,
                   ray_text(run.room, block.rays.origin(lane), block.rays.direction(lane)));
      }
    });
  }
  fmt::print("{} rays lost\n", lost);
}

void replay(Run& run, const Options& options) {
  const Solution& solution = run.solution;
  const std::uint32_t batch = options.batch.value_or(0);
  const std::uint32_t packets = packets_of_batch(solution, batch);
  int found = 0;
  const RayObserver observer = [&](const RayBlock& block) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.id[lane] != options.packet) continue;
      if (solution.settings.method == SolveMethod::kShooting && block.flight != options.sweep) continue;
      fmt::print("{:4}  {}\n", block.flight,
                 ray_text(run.room, block.rays.origin(lane), block.rays.direction(lane)));
      ++found;
    }
  };
  // One thread, so that lines come in order.
  tbb::task_arena arena(1);
  arena.execute([&] { run.send(batch, packets, observer); });
  if (found == 0)
    throw std::out_of_range(fmt::format("batch {} has no packet {} there; its luminaires send about {}",
                                        batch, options.packet, packets));
}

}  // namespace

int main(int argc, char** argv) {
  bench::ProgramOptions app(
      "Prints the way of one packet of a solve: for each ray the bounce (walks) or sweep (shooting), where "
      "it\n"
      "starts and what it meets. With shooting, zones send on what many packets brought, so a packet has one "
      "ray, and one more for each mirror and pane that it goes on from.");
  Options options;
  app.add_option("solution", options.solution, "Solution file; its room must be where it was")
      .required()
      .existing_file();
  app.add_option("--batch", options.batch, "Number of the batch, from 0 (default: 0; all with --lost)");
  app.add_option("--packet", options.packet, "Number of the packet within its batch or sweep, from 0")
      .show_default();
  app.add_option("--sweep", options.sweep,
                 "Shooting: 0 is the light of luminaires, 1 what zones send on first")
      .show_default();
  app.add_flag(
      "--lost", options.lost,
      "Instead: every ray that ends where light should not get, outside, on a back that absorbs or on a "
      "side that is sealed");
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    Run run(options.solution);
    if (options.lost)
      list_lost_rays(run, options.batch);
    else
      replay(run, options);
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_replay_packet: {}\n", e.what());
    return 2;
  }
  return 0;
}
