#include <array>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/point_gather.h"

namespace reemit::validation {
namespace {

using nlohmann::json;
constexpr double kLayerPackets = 1e6;
constexpr double kPanelPackets = 2e6;
constexpr int kShadowRays = 1024;
constexpr double kRaysEach = 8;

/// An opal sheet between two plates that end at mirrors, which make all three endless. Means are those of
/// fronts, so the sheet is turned over for the second of its sides.
void add_layers(const ReferenceCase& c, bool sheet_looks_down, const Effort& effort,
                std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  const Vec3 size(1, 1, 1);
  CodeRoom room;
  for (const int face : {0, 1, 2, 3}) room.add(kBoxFaces[face], room.mirror(1), box_face(face, size));
  room.add("H2", room.paint(p.at("rho2").get<double>(), p.at("E2")), box_face(4, size));
  room.add("H1", room.paint(p.at("rho1").get<double>(), p.at("E1")), box_face(5, size));
  // Its edges are outside of the shaft, by so little that its zones are as bright as the part inside.
  constexpr double kBeyond = 2e-6;
  room.add(sheet_looks_down ? "H_sheet_bottom" : "H_sheet_top", room.opal(p.at("rho_p"), p.at("tau_p")),
           axis_rectangle(2, 0.4, -kBeyond, 1 + kBeyond, -kBeyond, 1 + kBeyond, !sheet_looks_down));
  for (const SolveMethod method : kMethods) {
    const SolvedRoom solved(room.scene(), room.exact_zones(4), method, effort.work * kLayerPackets, c.name);
    for (const ReferenceValue& v : c.values) {
      if (sheet_looks_down != (v.quantity == "H_sheet_bottom")) continue;
      rows.push_back(make_row(c, v, to_string(method), solved.mean(solved.surface(v.quantity)), kSolveBound));
      if (method == SolveMethod::kShooting)
        rows.push_back(
            make_row(c, v, "gathered mean",
                     PointGather(solved, seed_of(c.name))
                         .mean({solved.surface(v.quantity)}, gather_effort(kShadowRays, kRaysEach, effort)),
                     kPointBound));
    }
  }
}

/// A point light over an opal panel; light that came through it at a point below, and on the panel.
void add_panel(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  const double half = 0.5 * p.at("a").get<double>();
  const Vec3 point(p.at("x"), p.at("y"), -p.at("d").get<double>());
  constexpr std::uint32_t kDivisions = 64;  // gathered light reads zones of the panel
  CodeRoom room;
  room.add("panel", room.opal(0, p.at("tau")), axis_rectangle(2, 0, -half, half, -half, half, true));
  room.add("receiver", room.paint(0), triangle_around(point, Vec3::UnitZ(), 1e-3));
  room.scene().lights.push_back(
      PointLight{"lamp", {0, 0, p.at("h")}, Spectrum::Constant(1, p.at("I").get<double>())});
  const SolvedRoom solved(room.scene(), room.exact_zones(kDivisions), SolveMethod::kShooting,
                          effort.work * kPanelPackets, c.name);
  for (const ReferenceValue& v : c.values) {
    if (v.quantity == "E_mean_on_panel") {
      rows.push_back(make_row(c, v, "shooting", solved.mean(solved.surface("panel")), kSolveBound));
      continue;
    }
    const PointGather gather(solved, seed_of(c.name));
    rows.push_back(make_row(c, v, "gathered point",
                            gather.at(point, Vec3::UnitZ(), gather_effort(kShadowRays, kRaysEach, effort)),
                            kPointBound));
    const SurfacePoint x = point_on(solved.rays(), point, Vec3::UnitZ());
    rows.push_back(make_row(
        c, v, "path tracing",
        traced_irradiance(solved.room(), x, gather_effort(kShadowRays, kRaysEach, effort), seed_of(v.id)),
        kPointBound));
  }
}

}  // namespace

std::vector<ValidationRow> evaluate_opal(const std::vector<ReferenceCase>& cases, const Effort& effort) {
  std::vector<ValidationRow> rows;
  for (const ReferenceCase& c : cases) {
    if (c.kind == "opal_panel_point") {
      add_panel(c, effort, rows);
      continue;
    }
    for (const bool sheet_looks_down : {false, true}) add_layers(c, sheet_looks_down, effort, rows);
  }
  return rows;
}

}  // namespace reemit::validation
