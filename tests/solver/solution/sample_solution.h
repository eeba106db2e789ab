#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "scenes/model/scene.h"
#include "solver/solution/solution.h"

namespace reemit::test {

/// A solution with a different number in every field: a two-sided and a one-sided triangle, two surfaces.
inline Solution sample_solution(const BandSet& bands) {
  const auto count = static_cast<Eigen::Index>(bands.count());
  Solution s;
  s.program_version = "1.2.3";
  s.room_path = "/rooms/kitchen – north.json";
  s.more_room_paths = {"/rooms/lamps.mgf", "/rooms/chairs\n2.mgf"};
  s.room_hash = "0123456789abcdef";
  s.read_options = {EmissiveUnits::kWatt, true,          683.5, "overcast:10000lx",
                    "altitude=40,lx=5",   {400, 700, 10}};
  s.mesh_settings.zone_area = 0.125;
  s.mesh_settings.default_zone_count = 77;
  s.mesh_settings.smallest_angle_deg = 21;
  s.mesh_settings.crease_angle_deg = 31;
  s.settings.method = SolveMethod::kWalk;
  s.settings.sampling = SamplingKind::kRandom;
  s.settings.direct = DirectSource::kPackets;
  s.settings.error_target = 0.01;
  s.settings.time_limit_s = 61;
  s.settings.packets = 5'000'000'000;
  s.settings.batch_packets = 1001;
  s.settings.smallest_batch_count = 9;
  s.settings.stop_share = 2e-5;
  s.settings.gather_small_zones = false;
  s.settings.seed = 18'000'000'000'000'000'001U;
  s.settings.threads = 3;
  s.mesh_settings.exact_shapes = false;
  s.record = {StopReason::kInterrupted, 12, 34, 5.5, 0.07, 0.08, 0.21, 6, 5, 13, true, 0.125,
              ZoneBias{0.03, 0.04}};
  s.bands = bands;

  Scene scene;
  scene.bands = bands;
  for (const char* name : {"plaster", "lamp"}) {
    Material m;
    m.name = name;
    m.reflectance = Spectrum::LinSpaced(count, 0.25, 0.75);
    m.emitted_radiance = Spectrum::Zero(count);
    scene.materials.push_back(m);
  }
  scene.materials[1].emitted_radiance = Spectrum::LinSpaced(count, 3, 5);
  scene.materials[1].two_sided = false;
  for (std::size_t i = 0; i < 2; ++i) {
    Surface surface;
    surface.name = i == 0 ? "wall" : "";
    surface.material = MaterialId(i);
    scene.surfaces.push_back(surface);
  }
  keep_surfaces(scene, s);

  BaseMesh base;
  base.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0.1, 0.2, 1e4}};
  base.normals = {{0, 0, 1}};
  BaseTriangle wall{{0, 1, 2}, {}, SurfaceId(0), 4, 3, true};
  wall.normal = {0, BaseTriangle::kFlat, 0};
  base.triangles = {wall,
                    {{1, 2, 3},
                     {BaseTriangle::kFlat, BaseTriangle::kFlat, BaseTriangle::kFlat},
                     SurfaceId(1),
                     5,
                     2,
                     false}};
  s.mesh = ZoneMesh(std::move(base));
  s.mesh_report.surfaces = {{1, 0.75, 0.25}, {2, 2, 0}};
  s.mesh_report.degenerate_faces = 1;
  s.mesh_report.duplicate_faces = 2;
  s.mesh_report.overlapping_faces = 3;
  s.mesh_report.flipped_faces = 4;
  s.mesh_report.nonplanar_faces = 5;
  s.mesh_report.cut_faces = 6;
  s.mesh_report.warnings = {"wall: two faces overlap", "", "lamp: flipped"};

  s.sums.channels = Channels(bands.count());
  for (const std::int64_t weight : {1, 2, 1, 3}) s.sums.count_batch(weight);
  double next = 0.1;
  const auto fill = [&](std::vector<double>& values, double scale) {
    for (std::size_t i = 0; i < s.mesh.zone_count() * bands.count(); ++i)
      values.push_back(scale * (next += 1.0 / 3));
  };
  fill(s.sums.direct, 1);
  fill(s.sums.direct_cross, 2);
  fill(s.sums.direct_squared, 30);
  fill(s.sums.indirect, 1);
  fill(s.sums.indirect_cross, 2);
  fill(s.sums.indirect_squared, 40);
  fill(s.sums.total_squared, 100);
  if (bands.kind() == BandKind::kRgb) {  // the others are of rooms that bend no light
    fill(s.sums.caustic, 1);
    fill(s.sums.caustic_cross, 2);
    fill(s.sums.caustic_squared, 50);
  }
  for (std::size_t i = 0; i < ZoneSums::kGroups * s.sums.direct.size(); ++i)
    s.sums.group_total.push_back(0.1F * static_cast<float>(i));
  s.gathered.keep(s.sums, {ZoneId(3), ZoneId(1)});
  s.gathered.rays = 9;

  s.gather_plan.seed = 11;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z)
    s.gather_plan.uneven.push_back(static_cast<std::uint8_t>(z % 3 == 0));
  if (bands.kind() == BandKind::kRgb)
    s.gather_plan.caustics = CausticPackets{20, {{1, 128}, {}}, {0, 255, 3}};

  s.light_warnings = {"light 'spot': 40 % of its light is lost", "", "5 % leaves the room"};
  s.audit.batches = 4;
  s.audit.weight = 7;
  s.audit.events = {101, 102, 103, 104, 105};
  for (std::size_t b = 0; b < bands.count(); ++b) {
    const auto n = static_cast<std::int64_t>(b);
    BandAudit audit;
    audit.band = bands.name(b);
    audit.watts_per_quantum = 1e-12 * static_cast<double>(b + 1);
    audit.emitted = std::int64_t{1} << 60;
    audit.absorbed = {(std::int64_t{1} << 59) + n, 1};
    audit.absorbed_on_backs = {7 + n, 2};
    audit.escaped = {1, 2, 3, 4, 5, 6 + n};
    audit.unshot = -3;
    audit.roulette_net = -1 - n;
    audit.roulette_gain = 11e20;
    s.audit.bands.push_back(std::move(audit));
  }
  return s;
}

}  // namespace reemit::test
