#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/point_gather.h"

namespace reemit::validation {
namespace {

/// Rays of one solution at full work.
constexpr double kEnclosureRays = 1.6e7;
constexpr int kShadowRaysAtEnclosurePoint = 256;
constexpr int kShadowRaysOverSurface = 1024;
constexpr double kRaysInEnclosure = 16;

/// A walk is reflected a geometric number of times, rho/(1-rho) on average and about as much by chance: below
/// a number of walks the mean over a whole room is not known well enough. Shooting knows it almost exactly.
double packets_for(SolveMethod method, double rho, const Effort& effort) {
  constexpr double kFewestWalks = 3.2e5;
  return effort.work *
         std::max(kEnclosureRays * (1 - rho), method == SolveMethod::kWalk ? kFewestWalks : 0.0);
}

/// Bound of kSolveBound for what comes after a reflection: the power left unshot is a share of the emitted
/// power, of which rho/(1-rho) is reflected.
double indirect_bound(double rho) {
  return kSolveBound / rho;
}

/// Row of every value by the quantity's estimates.
void add_rows(const ReferenceCase& c, const std::string& method, double bound,
              const std::function<Estimates(const std::string&)>& estimates,
              std::vector<ValidationRow>& rows) {
  for (const ReferenceValue& v : c.values)
    rows.push_back(make_row(c, v, method, estimates(v.quantity), bound));
}

/// The L-shaped room, in squares of 1 m times `scale`.
CodeRoom l_shape(double scale, const std::function<MaterialId(CodeRoom&, const std::string&)>& paint,
                 BandSet bands = BandSet::grey()) {
  CodeRoom room(std::move(bands));
  for (auto [name, polygons] : l_room(2, 2, 1, 1)) {
    for (Polygon& p : polygons)
      for (Vec3& corner : p) corner *= scale;
    room.add(name, paint(room, name), polygons);
  }
  return room;
}

/// Everything emits E and reflects rho in an L-shaped room: E/(1-rho) everywhere.
void add_furnace(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const double rho = c.parameters.at("rho");
  const double emission = c.parameters.at("emission");
  const CodeRoom room = l_shape(1, [&](CodeRoom& r, const std::string&) { return r.paint(rho, emission); });
  const MeshResult mesh = room.exact_zones();
  const auto as_quantity = [&](const Estimates& h) {
    return [&](const std::string& quantity) { return quantity == "B" ? scaled(h, rho, emission) : h; };
  };
  for (const SolveMethod method : kMethods) {
    const double packets = packets_for(method, rho, effort);
    const SolvedRoom solved(room.scene(), mesh, method, packets, c.name);
    const Estimates mean = solved.mean(solved.all_surfaces());
    add_rows(c, to_string(method) + ", mean of the room", kSolveBound, as_quantity(mean), rows);
    // A zone in the far corner of each arm, one of the floor at the re-entrant edge.
    for (const std::size_t zone : {std::size_t{0}, mesh.mesh.zone_count() / 2, mesh.mesh.zone_count() - 1}) {
      const Estimates one = solved.zone(ZoneId(zone));
      add_rows(c, to_string(method) + ", zone " + std::to_string(zone), kSolveBound, as_quantity(one), rows);
    }
    if (method != SolveMethod::kShooting) continue;
    const PointGather gather(solved, seed_of(c.name));
    for (const Vec3& point : {Vec3(0.3, 0.4, 0), Vec3(0.999, 0.999, 0), Vec3(0.001, 1.999, 0)}) {
      const Estimates light = gather.at(point, Vec3::UnitZ(),
                                        gather_effort(kShadowRaysAtEnclosurePoint, kRaysInEnclosure, effort));
      add_rows(c, "gathered point, floor at x = " + std::to_string(point.x()).substr(0, 5), kPointBound,
               as_quantity(light), rows);
    }
  }
}

/// Reflectances differ by surface and band, emission (1-rho) B0, with a block in the way: B0 everywhere.
void add_variable_furnace(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const double b0 = c.parameters.at("B0");
  int count = 0;
  const auto paint = [&](CodeRoom& room, const std::string&) {
    Spectrum rho(3);
    for (Eigen::Index b = 0; b < 3; ++b) rho[b] = 0.05 + 0.1 * static_cast<double>((3 * count + 7 * b) % 10);
    ++count;
    return room.paint(rho, (1 - rho) * b0);
  };
  CodeRoom room = l_shape(1, paint, BandSet::rgb());
  const Vec3 low(0.3, 0.5, 0.2);
  const Vec3 size(0.4, 0.3, 0.5);
  std::vector<Polygon> block;
  for (int face = 0; face < 6; ++face) {
    Polygon p = flipped(box_face(face, size));
    for (Vec3& corner : p) corner += low;
    block.push_back(p);
  }
  room.add("block", paint(room, "block"), block);
  const MeshResult mesh = room.exact_zones(4);
  const ReferenceValue& v = c.values.front();
  for (const SolveMethod method : kMethods) {
    const SolvedRoom solved(room.scene(), mesh, method, effort.work * kEnclosureRays * 0.3, c.name);
    const PointGather gather(solved, seed_of(c.name));
    for (const SurfaceId s : solved.all_surfaces()) {
      const Spectrum& rho = room.scene().material_of(room.scene().surfaces[s.index()]).reflectance;
      const bool gathered = method == SolveMethod::kShooting;
      const std::vector<Estimates> light =
          gathered ? gather.means({s}, gather_effort(kShadowRaysOverSurface, kRaysInEnclosure, effort))
                   : std::vector<Estimates>();
      for (std::size_t b = 0; b < 3; ++b) {
        const double r = rho[static_cast<Eigen::Index>(b)];
        const std::string where = room.scene().surfaces[s.index()].name + ", band " + std::to_string(b);
        rows.push_back(make_row(c, v, to_string(method) + ", " + where,
                                scaled(solved.mean(s, b), r, (1 - r) * b0), kSolveBound));
        if (gathered)
          rows.push_back(
              make_row(c, v, "gathered mean, " + where, scaled(light[b], r, (1 - r) * b0), kPointBound));
      }
    }
  }
}

/// A lamp off the middle of a sphere: after one reflection the light is the same everywhere, wherever its
/// first light falls.
void add_integrating_sphere(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const double rho = c.parameters.at("rho");
  const double flux = c.parameters.at("flux");
  const double radius = c.parameters.at("radius");
  CodeRoom room;
  room.add("sphere", room.paint(rho), Sphere{{0, 0, 0}, radius, true});
  room.scene().lights.push_back(PointLight{"lamp", radius * Vec3(0.5, 0.2, -0.3),
                                           Spectrum::Constant(1, flux / (4 * std::numbers::pi))});
  for (const SolveMethod method : kMethods) {
    const double packets = packets_for(method, rho, effort);
    const SolvedRoom solved(room.scene(), room.exact_zones(4), method, packets, c.name);
    const std::vector<SurfaceId> all = solved.all_surfaces();
    const double area = solved.area(all);
    const Estimates total = solved.mean(all);
    const Estimates indirect = solved.indirect_mean(all);
    add_rows(
        c, to_string(method), indirect_bound(rho),
        [&](const std::string& quantity) {
          if (quantity == "multiplier") return scaled(indirect, area / flux);
          if (quantity == "E_indirect") return indirect;
          return quantity == "B_mean" ? scaled(total, rho) : total;
        },
        rows);
  }
}

/// An L-shaped room of the stated area, one wall emits.
void add_energy(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const double rho = c.parameters.at("rho");
  const double flux = c.parameters.at("flux");
  const double scale = std::sqrt(c.parameters.at("area").get<double>() / 14);
  const CodeRoom room = l_shape(scale, [&](CodeRoom& r, const std::string& name) {
    return r.paint(rho, name == "W2" ? flux / (scale * scale) : 0);
  });
  for (const SolveMethod method : kMethods) {
    const SolvedRoom solved(room.scene(), room.exact_zones(2), method,
                            effort.work * kEnclosureRays * (1 - rho), c.name);
    const std::vector<SurfaceId> all = solved.all_surfaces();
    const Estimates total = solved.mean(all);
    const Estimates indirect = solved.indirect_mean(all);
    for (const ReferenceValue& v : c.values) {
      const bool of_all = v.quantity == "E_mean_total";
      rows.push_back(make_row(c, v, to_string(method), of_all ? total : indirect,
                              of_all ? kSolveBound : indirect_bound(rho)));
    }
  }
}

/// Concentric spheres, or cylinders between mirrors: every zone of one sees as much of the other.
void add_concentric(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const auto& p = c.parameters;
  const std::array<double, 2> rho{p.at("rho1"), p.at("rho2")};
  const std::array<double, 2> emission{p.at("E1"), p.at("E2")};
  CodeRoom room;
  const MaterialId inner_paint = room.paint(rho[0], emission[0]);
  const MaterialId outer_paint = room.paint(rho[1], emission[1]);
  if (p.at("shape") == "cylinders") {
    constexpr double kHeight = 1;  // any: the mirrors make it endless
    const double outer_radius = p.at("R2");
    room.add("1", inner_paint, Cylinder{{0, 0, 0}, {0, 0, kHeight}, p.at("R1"), false});
    room.add("2", outer_paint, Cylinder{{0, 0, 0}, {0, 0, kHeight}, outer_radius, true});
    const MaterialId mirror = room.mirror(1);
    room.add("base", mirror, Disk{{0, 0, 0}, {0, 0, 1}, outer_radius, 0});
    room.add("top", mirror, Disk{{0, 0, kHeight}, {0, 0, -1}, outer_radius, 0});
  } else {
    room.add("1", inner_paint, Sphere{{0, 0, 0}, p.at("R1"), false});
    room.add("2", outer_paint, Sphere{{0, 0, 0}, p.at("R2"), true});
  }
  const auto rows_of = [&](const std::string& method, const std::array<Estimates, 2>& h, double bound) {
    add_rows(
        c, method, bound,
        [&](const std::string& quantity) {
          const std::size_t k = quantity[1] == '1' ? 0 : 1;
          return quantity[0] == 'H' ? h[k] : scaled(h[k], rho[k], emission[k]);
        },
        rows);
  };
  for (const SolveMethod method : kMethods) {
    const SolvedRoom solved(room.scene(), room.exact_zones(4), method, effort.work * kEnclosureRays * 0.3,
                            c.name);
    const SurfaceId inner = solved.surface("1");
    const SurfaceId outer = solved.surface("2");
    rows_of(to_string(method), {solved.mean(inner), solved.mean(outer)}, kSolveBound);
    if (method != SolveMethod::kShooting) continue;
    const PointGather gather(solved, seed_of(c.name));
    const GatherEffort over_round = gather_effort(2048, 4, effort);
    rows_of("gathered mean", {gather.mean({inner}, over_round), gather.mean({outer}, over_round)},
            kPointBound);
  }
}

}  // namespace

std::vector<ValidationRow> evaluate_enclosures(const std::vector<ReferenceCase>& cases,
                                               const Effort& effort) {
  std::vector<ValidationRow> rows;
  for (const ReferenceCase& c : cases) {
    if (c.kind == "furnace")
      add_furnace(c, effort, rows);
    else if (c.kind == "furnace_var")
      add_variable_furnace(c, effort, rows);
    else if (c.kind == "integrating_sphere")
      add_integrating_sphere(c, effort, rows);
    else if (c.kind == "energy_closed")
      add_energy(c, effort, rows);
    else
      add_concentric(c, effort, rows);
  }
  return rows;
}

}  // namespace reemit::validation
