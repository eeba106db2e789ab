#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/solved_room.h"

namespace reemit::validation {
namespace {

using nlohmann::json;
using std::numbers::pi;
/// Standard error aimed at, per value.
constexpr double kFactorTarget = 1.5e-3;
/// Bound of what single precision does to factors, relative.
constexpr double kBound = 1e-6;

/// Surfaces by name; the one called `emitter` shines, all are black.
using Shapes = std::vector<std::pair<std::string, Body>>;

/// Packets for the standard error aimed at: hits are binomial at worst.
double packets_for(double factor, const Effort& effort) {
  return effort.work * (1 - factor) / factor / (kFactorTarget * kFactorTarget);
}

/// Power that arrives at surfaces from an emitter of exitance 1, over what it emits.
class Count {
 public:
  Count(const Shapes& shapes, const std::string& emitter, double packets, SolveMethod method,
        const std::string& seed)
      : room_(make(shapes, emitter)),
        solved_(room_.scene(), room_.exact_zones(), method, packets, seed + emitter),
        emitter_(emitter) {}

  Estimates factor_to(const std::string& receiver) const {
    const SurfaceId s = solved_.surface(receiver);
    return scaled(solved_.mean(s), solved_.area(s) / solved_.area(solved_.surface(emitter_)));
  }
  Estimates mean_on(const std::string& receiver) const { return solved_.mean(solved_.surface(receiver)); }

 private:
  static CodeRoom make(const Shapes& shapes, const std::string& emitter) {
    CodeRoom room;
    const MaterialId black = room.paint(0);
    const MaterialId lamp = room.paint(0, 1);
    for (const auto& [name, body] : shapes) room.add(name, name == emitter ? lamp : black, body);
    return room;
  }

  CodeRoom room_;
  SolvedRoom solved_;
  std::string emitter_;
};

/// One value that is the factor from surface `from` to surface `to` of some shapes.
struct FactorValue {
  const ReferenceValue* value;
  std::string from, to;
};

/// Rows of values of one geometry, by both methods; each emitter is run once per method.
void add_factor_rows(const ReferenceCase& c, const Shapes& shapes, const std::vector<FactorValue>& values,
                     const Effort& effort, std::vector<ValidationRow>& rows) {
  for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
    std::map<std::string, double> smallest;  // factor by emitter
    for (const FactorValue& v : values) {
      const auto [at, is_new] = smallest.emplace(v.from, v.value->value);
      if (!is_new) at->second = std::min(at->second, v.value->value);
    }
    for (const auto& [from, factor] : smallest) {
      const Count count(shapes, from, packets_for(factor, effort), method, c.name);
      for (const FactorValue& v : values)
        if (v.from == from)
          rows.push_back(make_row(c, *v.value, to_string(method), count.factor_to(v.to), kBound));
    }
  }
}

Body one(const Polygon& polygon) {
  return std::vector<Polygon>{polygon};
}

Polygon level_rectangle(const json& rect, double z, bool up) {
  return axis_rectangle(2, z, rect[0], rect[1], rect[2], rect[3], up);
}

Shapes shapes_of(const ReferenceCase& c) {
  const json& p = c.parameters;
  if (c.kind == "vf_parallel_rects")
    return {{"1", one(level_rectangle(p.at("rect1"), 0, true))},
            {"2", one(level_rectangle(p.at("rect2"), p.at("z"), false))}};
  if (c.kind == "vf_perp_rects") {
    // Rectangle 1 lies in z = 0 with [distance from the edge, place along it], rectangle 2 in x = 0.
    const json& r = p.at("rect2");
    return {{"1", one(level_rectangle(p.at("rect1"), 0, true))},
            {"2", one(axis_rectangle(0, 0, r[2], r[3], r[0], r[1], true))}};
  }
  if (c.kind == "vf_coaxial_disks")
    return {{"1", Disk{{0, 0, 0}, {0, 0, 1}, p.at("r1"), 0}},
            {"2", Disk{{0, 0, p.at("h")}, {0, 0, -1}, p.at("r2"), 0}}};
  if (c.kind == "vf_sphere_disk")
    return {{"sphere", Sphere{{0, 0, 0}, p.at("r_sphere"), false}},
            {"disk", Disk{{0, 0, p.at("h")}, {0, 0, -1}, p.at("r_disk"), 0}}};
  return closed_cylinder(p.at("r"), p.at("h"));
}

/// Quantities are "F12", "F_base_top" or "F_sphere_to_disk".
FactorValue named_factor(const ReferenceValue& v) {
  if (v.quantity == "F12") return {&v, "1", "2"};
  const std::string names = v.quantity.substr(2);
  const std::size_t cut = names.find('_');
  return {&v, names.substr(0, cut), names.substr(names.rfind('_') + 1)};
}

Shapes l_shaped_walls(double x_arm, double y_arm, double height) {
  Shapes shapes;
  for (auto& [name, polygons] : l_room(x_arm, y_arm, height, 1))
    shapes.emplace_back(name, std::move(polygons));
  return shapes;
}

void add_l_room_factors(const std::vector<ReferenceCase>& cases, const Effort& effort,
                        std::vector<ValidationRow>& rows) {
  const ReferenceCase* whole = nullptr;
  std::vector<FactorValue> values;
  for (const ReferenceCase& c : cases) {
    if (c.kind != "vf_obstructed") continue;
    const json& p = c.parameters;
    if (p.contains("L1")) {
      add_factor_rows(c, l_shaped_walls(p.at("L1"), p.at("L6"), p.at("H")), {{&c.values.front(), "W1", "W6"}},
                      effort, rows);
      continue;
    }
    whole = &c;
    values.push_back({&c.values.front(), p.at("from"), p.at("to")});
  }
  if (whole != nullptr) add_factor_rows(*whole, l_shaped_walls(2, 2, 1), values, effort, rows);
}

void add_flux_split(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const Vec3 size = to_vec3(c.parameters.at("dims"));
  Shapes shapes{{"opening", one(level_rectangle(c.parameters.at("opening"), size.z(), false))}};
  for (const int face : {0, 1, 2, 3, 4}) shapes.push_back({kBoxFaces[face], one(box_face(face, size))});
  for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
    const Count count(shapes, "opening", packets_for(0.16, effort), method, c.name);
    Estimates sum(SolvedRoom::kReplicates, 0.0);
    for (const ReferenceValue& v : c.values) {
      if (v.quantity == "sum_check") {
        rows.push_back(make_row(c, v, to_string(method), sum, 1e-9));
        continue;
      }
      const std::string face = v.quantity == "F_floor" ? "z0" : v.quantity.substr(v.quantity.rfind('_') + 1);
      const Estimates share = count.factor_to(face);
      for (std::size_t r = 0; r < sum.size(); ++r) sum[r] += share[r];
      rows.push_back(make_row(c, v, to_string(method), share, kBound));
    }
  }
}

void add_mean_irradiance(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  const Shapes shapes{{"light", one(level_rectangle(p.at("light_rect"), p.at("z"), false))},
                      {"floor", one(level_rectangle(p.at("receiver_rect"), 0, true))}};
  const double exitance = pi * p.at("radiance").get<double>();
  for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
    const Count count(shapes, "light", packets_for(0.3, effort), method, c.name);
    rows.push_back(
        make_row(c, c.values.front(), to_string(method), scaled(count.mean_on("floor"), exitance), kBound));
  }
}

}  // namespace

std::vector<ValidationRow> evaluate_form_factors(const std::vector<ReferenceCase>& cases,
                                                 const Effort& effort) {
  std::vector<ValidationRow> rows;
  for (const ReferenceCase& c : cases) {
    if (c.kind == "vf_obstructed") continue;
    if (c.kind == "flux_split") {
      add_flux_split(c, effort, rows);
    } else if (c.kind == "irr_mean_rect") {
      add_mean_irradiance(c, effort, rows);
    } else {
      std::vector<FactorValue> values;
      for (const ReferenceValue& v : c.values) values.push_back(named_factor(v));
      add_factor_rows(c, shapes_of(c), values, effort, rows);
    }
  }
  add_l_room_factors(cases, effort, rows);
  return rows;
}

}  // namespace reemit::validation
