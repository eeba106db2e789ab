#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/point_gather.h"
#include "solver/reflect/specular.h"

namespace reemit::validation {
namespace {

using nlohmann::json;
using std::numbers::pi;
constexpr double kShaftPackets = 2e6;
/// Bound of what single precision does to shares, relative.
constexpr double kGlassBound = 1e-6;

/// Left of light by one pass across the glass at normal incidence.
double once(const ReferenceCase& c) {
  return std::exp(-c.parameters.value("kd", 0.0));
}

/// What a pane and the surface of a body of the glass of a case do, by the cosine of the angle.
class Glass {
 public:
  explicit Glass(const ReferenceCase& c) {
    CodeRoom room;
    const double n = c.parameters.at("n");
    pane_ = SpecularSurface(room.scene().materials[room.pane(n, once(c)).index()], 1);
    body_ = SpecularSurface(room.scene().materials[room.glass_body(n).index()], 1);
  }

  /// "T...", "R...": of the pane; "R_interface", "rho_ext_...", "rho_int_...": reflected by the surface, from
  /// outside or inside the glass.
  double share(const std::string& quantity, double cosine) const {
    SpecularStep step(1);
    const bool of_surface = quantity.find("interface") != std::string::npos;
    const bool outside = quantity.find("int_") == std::string::npos;
    (of_surface ? body_ : pane_).shares(static_cast<float>(cosine), outside, step);
    return static_cast<double>(quantity.front() == 'T' ? step.transmitted[0] : step.reflected[0]);
  }

 private:
  SpecularSurface pane_, body_;
};

void add_angle(const ReferenceCase& c, std::vector<ValidationRow>& rows) {
  const Glass glass(c);
  const double cosine = std::cos(c.parameters.at("theta_deg").get<double>() * pi / 180);
  for (const ReferenceValue& v : c.values)
    rows.push_back(make_row(c, v, "share at an angle", {glass.share(v.quantity, cosine)}, kGlassBound));
}

/// Mean over directions from which a cosine-weighted hemisphere of light comes.
double hemispherical(const std::function<double(double)>& share) {
  constexpr int kSteps = 1 << 18;  // in the square of the sine, where the weight is even
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += share(std::sqrt(1 - (i + 0.5) / kSteps));
  return sum / kSteps;
}

/// Glass across a shaft of mirrors, which keep the angles of light to the glass: a black luminaire on one
/// side gets back what is reflected, a black receiver on the other what goes through.
void add_shaft(const ReferenceCase& c, const std::vector<ReferenceValue>& values,
               const std::function<MaterialId(CodeRoom&)>& glass, bool lit_from_front, const Effort& effort,
               std::vector<ValidationRow>& rows) {
  const Vec3 size(1, 1, 1);
  CodeRoom room;
  const MaterialId mirror = room.mirror(1);
  for (const int face : {0, 1, 2, 3}) room.add(kBoxFaces[face], mirror, box_face(face, size));
  room.add("light", room.paint(0, 1), box_face(5, size));
  room.add("receiver", room.paint(0), box_face(4, size));
  // Its edges are outside of the shaft.
  room.add("glass", glass(room), axis_rectangle(2, 0.5, -0.1, 1.1, -0.1, 1.1, lit_from_front));
  for (const SolveMethod method : kMethods) {
    const SolvedRoom solved(room.scene(), room.exact_zones(), method, effort.work * kShaftPackets,
                            values.front().id);
    for (const ReferenceValue& v : values) {
      const std::string where = v.quantity.front() == 'T' ? "receiver" : "light";
      rows.push_back(make_row(c, v, to_string(method), solved.mean(solved.surface(where)), kSolveBound));
    }
  }
}

void add_hemisphere(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const Glass glass(c);
  const double n = c.parameters.at("n");
  std::vector<ReferenceValue> of_pane;
  for (const ReferenceValue& v : c.values) {
    const double mean = hemispherical([&](double cosine) { return glass.share(v.quantity, cosine); });
    rows.push_back(make_row(c, v, "mean of shares over angles", {mean}, kGlassBound));
    if (v.quantity.find("interface") == std::string::npos) {
      of_pane.push_back(v);
      continue;
    }
    // The front of the surface looks out of the glass.
    add_shaft(
        c, {v}, [&](CodeRoom& room) { return room.glass_body(n); },
        v.quantity.find("int_") == std::string::npos, effort, rows);
  }
  add_shaft(
      c, of_pane, [&](CodeRoom& room) { return room.pane(n, once(c)); }, true, effort, rows);
}

/// Direct light through a pane. Panes have no thickness, and the reference neglects the same shift of rays.
void add_direct(const ReferenceCase& c, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  const double a = p.at("a").get<double>() / 2;
  const double b = p.at("b").get<double>() / 2;
  const double h = p.at("h");
  const Vec3 point(p.at("x"), p.at("y"), 0);
  CodeRoom room;
  room.add("light", room.paint(0, pi * p.at("radiance").get<double>()),
           axis_rectangle(2, h, -a, a, -b, b, false));
  room.add("pane", room.pane(p.at("n"), once(c)), axis_rectangle(2, h / 2, -2, 2, -2, 2, true));
  room.add("receiver", room.paint(0), triangle_around(point, Vec3::UnitZ(), 1e-3));
  constexpr double kAnyPackets = 4096;
  const SolvedRoom solved(room.scene(), room.exact_zones(), SolveMethod::kShooting, kAnyPackets, c.name);
  const SurfacePoint x = point_on(solved.rays(), point, Vec3::UnitZ());
  const ReferenceValue& v = c.values.front();
  const auto add_row = [&](const std::string& method, const Estimates& light) {
    rows.push_back(make_row(c, v, method, light, kPointBound));
  };
  // Rays that meet the luminaire through the pane must not count it again.
  constexpr GatherEffort kAtPoint{16, 256};
  add_row("direct light", direct_irradiance(solved.room(), x, kAtPoint.light_samples, seed_of(c.name)));
  const PointGather gather(solved, seed_of(c.name + "gather"));
  add_row("gathered point", gather.at(point, Vec3::UnitZ(), kAtPoint));
  add_row("path tracing", traced_irradiance(solved.room(), x, kAtPoint, seed_of(c.name + "path")));
}

}  // namespace

std::vector<ValidationRow> evaluate_glass(const std::vector<ReferenceCase>& cases, const Effort& effort) {
  std::vector<ValidationRow> rows;
  for (const ReferenceCase& c : cases) {
    if (c.kind == "slab_direct")
      add_direct(c, rows);
    else if (c.kind == "fresnel_slab")
      add_angle(c, rows);
    else
      add_hemisphere(c, effort, rows);
  }
  return rows;
}

}  // namespace reemit::validation
