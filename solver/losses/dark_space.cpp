#include "solver/losses/dark_space.h"

#include <algorithm>
#include <cmath>

#include "mesh/zones/surface_side.h"
#include "solver/losses/probe_flight.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "solver/trace/surface_point.h"

namespace reemit {
namespace {

constexpr std::uint32_t kSideRays = 1U << 14;
constexpr std::uint32_t kSideRayStream = 3;  // of random numbers of probes

/// By surface_side, whether a packet came to any of its zones.
std::vector<bool> lit_faces(const Solution& solution) {
  const ZoneMesh& mesh = solution.mesh;
  std::vector<bool> lit(2 * solution.surface_names.size(), false);
  for (std::size_t z = 0; z < mesh.zone_count(); ++z)
    for (std::size_t b = 0; b < solution.bands.count(); ++b)
      if (solution.irradiance(ZoneId(z), b).mean > 0)
        lit[surface_side(mesh, mesh.zone_side(ZoneId(z)))] = true;
  return lit;
}

struct Side {
  SideId id;
  bool is_dark;
};

/// All that have zones.
std::vector<Side> sides_with_zones(const Solution& solution, const SurfaceModel& surfaces) {
  const ZoneMesh& mesh = solution.mesh;
  const std::vector<bool> lit = lit_faces(solution);
  std::vector<Side> sides;
  for (std::size_t s = 0; s < mesh.side_count(); ++s) {
    const SideId side(s);
    if (!mesh.has_zones(side)) continue;
    const TriangleId t = triangle_of(side);
    const bool sealed = mesh.is_sealed(mesh.first_zone(t, is_front(side)));
    sides.push_back({side, (sealed || !lit[surface_side(mesh, side)]) && !surfaces.emits(t, is_front(side))});
  }
  return sides;
}

/// What rays say of the dark sides of a face.
struct Outlook {
  double area = 0;    // [m2]
  double chords = 0;  // sum over rays that met something; all stand for the same area
  std::uint32_t rays = 0;
  std::uint32_t misses = 0;

  bool encloses_space() const { return rays > 0 && 2 * misses <= rays; }
};

struct Outlooks {
  std::vector<Outlook> dark;  // by face
  double lit_chords = 0;
};

/// Rays from all sides, as many from each square metre.
Outlooks look_out(const RayTracer& rays, const ZoneMesh& mesh, const std::vector<Side>& sides,
                  std::size_t faces, const StopToken* stop) {
  constexpr std::uint32_t kNowAndThen = 1024;
  double all_area = 0;
  for (const Side& side : sides) all_area += mesh.triangle_area(triangle_of(side.id));
  Outlooks found{std::vector<Outlook>(faces)};
  const CounterRng rng(0, RngPurpose::kDarkSpace);
  double running = 0;
  std::uint32_t sent = 0;
  for (const auto& [side, is_dark] : sides) {
    const double area = mesh.triangle_area(triangle_of(side));
    Outlook outlook;
    running += area;
    const auto upto = static_cast<std::uint32_t>(std::floor(running / all_area * kSideRays + 0.5));
    while (sent < upto) {
      if (sent % kNowAndThen < 16) end_if_requested(stop);
      const int count = static_cast<int>(std::min<std::uint32_t>(16, upto - sent));
      Ray16 some;
      for (int lane = 0; lane < count; ++lane) {
        const std::array<float, 4> u = rng.uniform4(sent++, kSideRayStream, 0);
        const auto [a, b] = sample_triangle(u[0], u[1]);
        const SurfacePoint x = surface_point(rays, triangle_of(side), a, b, is_front(side));
        some.set(lane, ray_origin(rays, x), Frame(x.normal).to_world(sample_cosine_hemisphere(u[2], u[3])));
      }
      trace_probes(rays, some, count, [&](int, const ProbeRay& probe) {
        ++outlook.rays;
        if (probe.met)
          outlook.chords += static_cast<double>(probe.hit.distance);
        else
          ++outlook.misses;
      });
    }
    if (!is_dark) {
      found.lit_chords += outlook.chords;
      continue;
    }
    Outlook& of_face = found.dark[surface_side(mesh, side)];
    of_face.area += area;
    of_face.chords += outlook.chords;
    of_face.rays += outlook.rays;
    of_face.misses += outlook.misses;
  }
  return found;
}

/// The side in the middle of a picture, if there is one.
SideId side_looked_at(const RayTracer& rays, const Camera& camera) {
  const Vec3 eye = rays.normalised_double(camera.eye);
  const Vec3 view = camera.look_at - camera.eye;
  const double length = view.stableNorm();
  SideId side;
  if (!(length > 0) || !std::isfinite(length) || !eye.allFinite()) return side;
  Ray16 ray;
  ray.set(0, eye.cast<float>(), (view / length).cast<float>());
  trace_probes(rays, ray, 1, [&](int, const ProbeRay& probe) {
    if (probe.met) side = side_of(probe.hit.triangle, probe.hit.front);
  });
  return side;
}

bool is_among_dark(const std::vector<Side>& sides, SideId side) {
  return std::any_of(sides.begin(), sides.end(), [&](const Side& s) { return s.id == side && s.is_dark; });
}

}  // namespace

DarkSpace find_dark_space(const PacketRoom& transport, const Solution& solution, const StopToken* stop) {
  end_if_requested(stop);
  const std::vector<Side> sides = sides_with_zones(solution, transport.surface_model());
  const auto [dark, lit_chords] =
      look_out(transport.rays(), solution.mesh, sides, 2 * solution.surface_names.size(), stop);
  DarkSpace found;
  double dark_chords = 0;
  for (std::size_t f = 0; f < dark.size(); ++f) {
    if (!dark[f].encloses_space()) continue;
    dark_chords += dark[f].chords;
    found.faces.push_back({SurfaceId(f / 2), f % 2 == 0, dark[f].area});
  }
  for (const Camera& camera : transport.scene().cameras)
    if (is_among_dark(sides, side_looked_at(transport.rays(), camera))) found.is_looked_at = true;
  if (dark_chords > 0) found.share = dark_chords / (dark_chords + lit_chords);
  std::stable_sort(found.faces.begin(), found.faces.end(),
                   [](const DarkSpace::Face& a, const DarkSpace::Face& b) { return a.area > b.area; });
  return found;
}

}  // namespace reemit
