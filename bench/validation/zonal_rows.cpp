#include <algorithm>
#include <array>

#include <Eigen/LU>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/matrix_rows.h"
#include "bench/validation/merged_zones.h"
#include "bench/validation/solved_room.h"

namespace reemit::validation {
namespace {

using nlohmann::json;
/// Rays of one solution.
constexpr double kZonalRays = 3e7;
/// Packets from each surface whose factors are counted.
constexpr double kFactorPackets = 2e6;

/// H of surfaces that are zones of their own, given by counted factors: F(i,j) per replicate. Rows of F come
/// from packets of one emitter each, so replicates are independent.
class CountedFactors {
 public:
  CountedFactors(const std::vector<std::pair<std::string, Body>>& zones, double packets,
                 const std::string& seed)
      : count_(zones.size()), factors_(SolvedRoom::kReplicates) {
    const auto n = static_cast<Eigen::Index>(count_);
    for (Eigen::MatrixXd& f : factors_) f.setZero(n, n);
    for (std::size_t from = 0; from < count_; ++from) {
      CodeRoom room;
      const MaterialId black = room.paint(0);
      const MaterialId lamp = room.paint(0, 1);
      for (std::size_t s = 0; s < count_; ++s)
        room.add(zones[s].first, s == from ? lamp : black, zones[s].second);
      const SolvedRoom solved(room.scene(), room.exact_zones(), SolveMethod::kShooting, packets,
                              seed + zones[from].first);
      const double emitted = solved.area(SurfaceId(from));
      for (std::size_t to = 0; to < count_; ++to) {
        const Estimates f = scaled(solved.mean(SurfaceId(to)), solved.area(SurfaceId(to)) / emitted);
        for (std::size_t r = 0; r < f.size(); ++r)
          factors_[r](static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(to)) = f[r];
      }
    }
  }

  /// Irradiances by zone of H = F (E + rho H), in every replicate.
  std::vector<Estimates> irradiances(const Eigen::VectorXd& rho, const Eigen::VectorXd& exitance) const {
    std::vector<Estimates> h(count_);
    for (const Eigen::MatrixXd& f : factors_) {
      const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(f.rows(), f.cols()) - f * rho.asDiagonal();
      const Eigen::VectorXd solution = system.partialPivLu().solve(f * exitance);
      for (std::size_t i = 0; i < count_; ++i) h[i].push_back(solution[static_cast<Eigen::Index>(i)]);
    }
    return h;
  }

 private:
  std::size_t count_;
  std::vector<Eigen::MatrixXd> factors_;  // by replicate
};

/// Six zones of a box. Quantities "H_x0", "B_x0".
void add_boxes(const std::vector<ReferenceCase>& cases, const Effort& effort,
               std::vector<ValidationRow>& rows) {
  if (cases.empty()) return;
  std::vector<std::pair<std::string, Body>> faces;
  for (int face = 0; face < 6; ++face)
    faces.emplace_back(kBoxFaces[static_cast<std::size_t>(face)],
                       std::vector<Polygon>{box_face(face, to_vec3(cases.front().parameters.at("dims")))});
  for (const ReferenceCase& c : cases) {
    const CountedFactors factors(faces, effort.work * kFactorPackets, c.name);
    Eigen::VectorXd rho(6);
    Eigen::VectorXd exitance(6);
    for (Eigen::Index i = 0; i < 6; ++i) {
      const std::string& name = faces[static_cast<std::size_t>(i)].first;
      rho[i] = c.parameters.at("rho").at(name);
      exitance[i] = c.parameters.at("E").value(name, 0.0);
    }
    const std::vector<Estimates> h = factors.irradiances(rho, exitance);
    for (const ReferenceValue& v : c.values) {
      const auto i = static_cast<std::size_t>(
          std::find(kBoxFaces.begin(), kBoxFaces.end(), v.quantity.substr(2)) - kBoxFaces.begin());
      const auto k = static_cast<Eigen::Index>(i);
      rows.push_back(make_row(c, v, "counted factors",
                              v.quantity[0] == 'H' ? h[i] : scaled(h[i], rho[k], exitance[k]), kSolveBound));
    }
  }
}

/// Base, top and side of a cylinder as three zones. Quantities "H_base" ...
void add_cylinder(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const auto zones = closed_cylinder(c.parameters.at("r"), c.parameters.at("h"));
  const CountedFactors factors(zones, effort.work * kFactorPackets, c.name);
  Eigen::VectorXd rho(3);
  Eigen::VectorXd exitance(3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    rho[i] = c.parameters.at("rho")[static_cast<std::size_t>(i)];
    exitance[i] = c.parameters.at("E")[static_cast<std::size_t>(i)];
  }
  const std::vector<Estimates> irradiances = factors.irradiances(rho, exitance);
  for (const ReferenceValue& v : c.values)
    for (std::size_t i = 0; i < 3; ++i)
      if (v.quantity.substr(2) == zones[i].first)
        rows.push_back(make_row(c, v, "counted factors", irradiances[i], kSolveBound));
}

/// Twelve triangles of a cube: every value names the corners of its zone.
void add_cube_triangles(const std::vector<ReferenceCase>& cases, const Effort& effort,
                        std::vector<ValidationRow>& rows) {
  for (std::size_t first = 0; first < cases.size();) {
    std::size_t last = first;
    while (last < cases.size() && cases[last].name == cases[first].name) ++last;
    const double rho = cases[first].parameters.at("rho");
    CodeRoom room;
    for (int face = 0; face < 6; ++face)
      room.add(kBoxFaces[static_cast<std::size_t>(face)], room.paint(rho, face == 4 ? 1 : 0),
               box_face(face, {1, 1, 1}));
    for (const SolveMethod method : kMethods) {
      const SolvedRoom solved(room.scene(), room.exact_zones(), method, effort.work * kZonalRays * (1 - rho),
                              cases[first].name, Reemission::kFromZones);
      for (std::size_t k = first; k < last; ++k) {
        const json& corners = cases[k].parameters.at("vertices");
        const Vec3 middle = (to_vec3(corners[0]) + to_vec3(corners[1]) + to_vec3(corners[2])) / 3;
        for (std::size_t z = 0; z < solved.mesh().zone_count(); ++z)
          if ((solved.mesh().zone_centroid(ZoneId(z)) - middle).norm() < 1e-9)
            rows.push_back(make_row(cases[k], cases[k].values.front(), to_string(method),
                                    solved.zone(ZoneId(z)), kSolveBound));
      }
    }
    first = last;
  }
}

/// Icospheres whose first triangle emits.
void add_icosphere(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const double rho = c.parameters.at("rho");
  std::vector<Polygon> triangles = unit_icosphere(c.parameters.at("subdivision"));
  for (Polygon& t : triangles) t = flipped(t);
  CodeRoom room;
  room.add("lamp", room.paint(rho, 1), triangles.front());
  room.add("rest", room.paint(rho), std::vector<Polygon>(triangles.begin() + 1, triangles.end()));
  // Which zone is the brightest is asked of the exact factors, so that the choice favours no noise.
  MergedZones exact(room, MergedZones::Merge::kTriangles, 1);
  exact.solve(Eigen::Vector2d(rho, rho), Eigen::Vector2d(1, 0));
  const std::size_t brightest = exact.brightest_zone();
  for (const SolveMethod method : kMethods) {
    // Thousands of sweeps of a few packets are slow; furnaces and integrating spheres take them already.
    if (method == SolveMethod::kShooting && rho > 0.99) continue;
    const SolvedRoom solved(room.scene(), room.exact_zones(), method, effort.work * kZonalRays * (1 - rho),
                            c.name, Reemission::kFromZones);
    for (const ReferenceValue& v : c.values) {
      const Estimates h = v.quantity == "H_mean"         ? solved.mean(solved.all_surfaces())
                          : v.quantity == "H_on_emitter" ? solved.zone(ZoneId(0))
                                                         : solved.zone(ZoneId(brightest));
      rows.push_back(make_row(c, v, to_string(method), h, kSolveBound));
    }
  }
}

}  // namespace

std::vector<ValidationRow> evaluate_zonal(const std::vector<ReferenceCase>& cases, const Effort& effort) {
  std::vector<ValidationRow> rows = evaluate_matrix(cases);
  add_boxes(cases_of(cases, {"zone_box"}), effort, rows);
  add_cube_triangles(cases_of(cases, {"zone_cube_triangles"}), effort, rows);
  for (const ReferenceCase& c : cases_of(cases, {"zone_icosphere"})) add_icosphere(c, effort, rows);
  for (const ReferenceCase& c : cases_of(cases, {"zone_cylinder"})) add_cylinder(c, effort, rows);
  return rows;
}

}  // namespace reemit::validation
