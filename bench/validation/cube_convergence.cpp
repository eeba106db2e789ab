#include "bench/validation/cube_convergence.h"

#include <stdexcept>

#include "bench/validation/code_room.h"
#include "bench/validation/point_gather.h"
#include "bench/validation/solved_room.h"

namespace reemit::validation {
namespace {

constexpr double kCubeRays = 1.5e7;
constexpr GatherEffort kOverCubeFace{2048, 16384};
constexpr GatherEffort kAtCubePoint{1024, 8192};

const ReferenceCase& find_case(const std::vector<ReferenceCase>& cases, const std::string& name) {
  for (const ReferenceCase& c : cases)
    if (c.name == name) return c;
  throw std::out_of_range("no reference case " + name);
}

/// Value whose id ends with `ending`.
const ReferenceValue& find_value(const ReferenceCase& c, const std::string& ending) {
  for (const ReferenceValue& v : c.values)
    if (v.id.ends_with(ending)) return v;
  throw std::out_of_range("no " + ending + " in " + c.name);
}

}  // namespace

std::vector<CubeStep> measure_cube_convergence(const std::vector<ReferenceCase>& cases,
                                               const Effort& effort) {
  std::vector<CubeStep> steps;
  for (const std::string rho_name : {"0.5", "0.8"}) {
    const ReferenceCase& continuous = find_case(cases, "cube1.rho" + rho_name);
    const double rho = std::stod(rho_name);
    CodeRoom room;
    for (int face = 0; face < 6; ++face)
      room.add(kBoxFaces[static_cast<std::size_t>(face)], room.paint(rho, face == 4 ? 1 : 0),
               box_face(face, {1, 1, 1}));
    for (const int n : {1, 2, 4, 8, 16}) {
      const std::string name = "cubezones.rho" + rho_name + ".N" + std::to_string(n);
      const SolvedRoom solved(room.scene(), room.exact_zones(static_cast<std::uint32_t>(n)),
                              SolveMethod::kShooting, effort.work * kCubeRays * (1 - rho), name,
                              Reemission::kFromZones);
      const PointGather plain(solved, seed_of(name), 0);
      const PointGather gather(solved, seed_of(name));
      const auto add = [&](const std::string& place, const ReferenceValue& truth, double squares,
                           const Estimates& zones, const Estimates& read_all, const Estimates& gathered) {
        steps.push_back({rho, place, n, truth.value, squares,
                         make_row(continuous, truth, "zones", zones, kSolveBound),
                         make_row(continuous, truth, "plain gather", read_all, kPointBound),
                         make_row(continuous, truth, "gather", gathered, kPointBound)});
      };
      for (const std::string face : {"z0", "z1", "x0"}) {
        const std::string ending = ".Hmean." + face;
        const std::vector<SurfaceId> surface{solved.surface(face)};
        add("mean of " + face, find_value(continuous, ending),
            find_value(find_case(cases, name), ending).value, solved.mean(surface),
            plain.mean(surface, kOverCubeFace), gather.mean(surface, kOverCubeFace));
      }
      for (const std::string place : {"z1(0.5,0.5)", "x0(0.5,0.1)", "x0(0.25,0.75)"}) {
        const ReferenceValue& truth = find_value(continuous, ".H@" + place);
        const SurfacePoint x = point_on(solved.rays(), *truth.point, truth.normal);
        add(place, truth, 0, solved.zone(solved.mesh().zone_at(x.triangle, x.u, x.v, true)),
            plain.at(*truth.point, truth.normal, kAtCubePoint),
            gather.at(*truth.point, truth.normal, kAtCubePoint));
      }
    }
  }
  return steps;
}

}  // namespace reemit::validation
