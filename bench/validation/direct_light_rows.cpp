#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/point_gather.h"
#include "scenes/io/scene_reader.h"

namespace reemit::validation {
namespace {

using nlohmann::json;
using std::numbers::pi;
/// Standard error aimed at. Far smaller ones would meet the resolution of single precision.
constexpr double kDirectTarget = 2e-3;
constexpr int kFewestSamples = 16;
constexpr int kMostSamples = 1 << 18;

/// Rows need the standard error aimed at: a pilot run with numbers of its own says how many samples that
/// takes, so that the choice does not depend on the numbers that are then averaged.
Estimates estimate(const Room& room, const SurfacePoint& x, const std::string& id, const Effort& effort) {
  const std::uint64_t seed = seed_of(id);
  constexpr int kPilot = 64;
  const Estimates pilot = direct_irradiance(room, x, kPilot, ~seed);
  const ValidationRow about = make_row({}, {}, {}, pilot, 0);
  double samples = kPilot;
  if (about.measured > 0) {
    const double ratio = about.standard_error / about.measured / kDirectTarget;
    samples = kPilot * ratio * ratio * effort.work;
  }
  int count = kFewestSamples;
  while (count < samples && count < kMostSamples) count *= 2;
  return direct_irradiance(room, x, count, seed);
}

Vec3 middle_of(const Surface& luminaire) {
  if (!luminaire.shapes.empty()) {
    const auto [low, high] = shape_bounds(luminaire.shapes.front());
    return 0.5 * (low + high);
  }
  Vec3 sum = Vec3::Zero();
  for (const Vec3& corner : luminaire.positions) sum += corner;
  return sum / static_cast<double>(luminaire.positions.size());
}

Body luminaire(const json& l, const Vec3& receiver) {
  const std::string type = l.at("type");
  if (type == "rect")
    return std::vector<Polygon>{turned_towards(
        parallelogram(to_vec3(l.at("corner")), to_vec3(l.at("edge_u")), to_vec3(l.at("edge_v"))), receiver)};
  if (type == "triangle")
    return std::vector<Polygon>{turned_towards(
        {to_vec3(l.at("vertices")[0]), to_vec3(l.at("vertices")[1]), to_vec3(l.at("vertices")[2])},
        receiver)};
  if (type == "disk")
    return Disk{to_vec3(l.at("center")), to_vec3(l.at("normal")).normalized(), l.at("radius"), 0};
  if (type == "sphere") return Sphere{to_vec3(l.at("center")), l.at("radius"), false};
  if (type == "cylinder") {
    const Vec3 base = to_vec3(l.at("base_center"));
    return Cylinder{base, base + to_vec3(l.at("axis")), l.at("radius"), false};
  }
  throw std::invalid_argument("unknown luminaire " + type);
}

ValidationRow lit_point(const ReferenceCase& c, const ReferenceValue& v, CodeRoom& room, const Vec3& point,
                        const Vec3& normal, const Effort& effort) {
  const double distance = (middle_of(room.scene().surfaces.front()) - point).norm();
  room.add("receiver", room.paint(0), triangle_around(point, normal, 1e-3 * distance));
  const MeshResult mesh = room.exact_zones();
  const Room walls(room.scene(), mesh.mesh);
  constexpr float kThird = 1.0F / 3;
  // The receiver is the last flat triangle: patches of round shapes come after all flat ones.
  const SurfacePoint x =
      surface_point(walls.rays(), TriangleId(mesh.mesh.flat_count() - 1), kThird, kThird, true);
  return make_row(c, v, "direct light", estimate(walls, x, v.id, effort), kPointBound);
}

ValidationRow from_luminaire(const ReferenceCase& c, const Effort& effort) {
  const json& p = c.parameters;
  const Vec3 point = to_vec3(p.at("receiver").at("point"));
  CodeRoom room;
  room.add("light", room.paint(0, pi * p.at("radiance").get<double>()), luminaire(p.at("luminaire"), point));
  return lit_point(c, c.values.front(), room, point, to_vec3(p.at("receiver").at("normal")), effort);
}

Polygon level(const json& rect, double z) {
  return axis_rectangle(2, z, rect[0], rect[1], rect[2], rect[3], true);
}

ValidationRow occluded(const ReferenceCase& c, const Effort& effort) {
  const json& p = c.parameters;
  const Vec3 point = to_vec3(p.at("receiver").at("point"));
  CodeRoom room;
  room.add("light", room.paint(0, pi * p.at("radiance").get<double>()),
           turned_towards(level(p.at("light_rect"), p.at("light_z")), point));
  const MaterialId black = room.paint(0);
  for (const json& b : p.at("blockers")) room.add("blocker", black, level(b.at("rect"), b.at("z")));
  return lit_point(c, c.values.front(), room, point, to_vec3(p.at("receiver").at("normal")), effort);
}

ValidationRow sky(const ReferenceCase& c, const ReferenceValue& v, const Effort& effort) {
  const json& p = c.parameters;
  const Vec3 point(p.at("point")[0], p.at("point")[1], 0);
  CodeRoom room;
  room.add("opening", room.paint(0, 1), turned_towards(level(p.at("opening"), p.at("h")), point));
  return lit_point(c, v, room, point, Vec3::UnitZ(), effort);
}

/// The opening as a hole in the roof of a black room of 4 x 4 m under an overcast sky that sends 1 W/m2 onto
/// a horizontal plane.
ValidationRow overcast(const ReferenceCase& c, const ReferenceValue& v, const Effort& effort) {
  const json& p = c.parameters;
  const double h = p.at("h");
  const json& hole = p.at("opening");
  CodeRoom room;
  const MaterialId black = room.paint(0);
  for (const auto& [x0, x1, y0, y1] : {std::array<double, 4>{0, 4, 0, hole[2]},
                                       {0, 4, hole[3], 4},
                                       {0, hole[0], hole[2], hole[3]},
                                       {hole[1], 4, hole[2], hole[3]}})
    room.add("roof", black, axis_rectangle(2, h, x0, x1, y0, y1, false));
  for (const int face : {0, 1, 2, 3, 4}) room.add(kBoxFaces[face], black, box_face(face, {4, 4, h}));
  Sky sky;
  sky.kind = SkyKind::kOvercast;
  sky.irradiance = Spectrum::Ones(1);
  sky.ground_reflectance = Spectrum::Zero(1);
  place_sky(sky, Vec3::UnitZ());
  room.scene().sky = sky;
  const MeshResult mesh = room.exact_zones();
  const Room walls(room.scene(), mesh.mesh);
  const SurfacePoint x = point_on(walls.rays(), Vec3(p.at("point")[0], p.at("point")[1], 0), Vec3::UnitZ());
  return make_row(c, v, "direct light", estimate(walls, x, v.id, effort), kPointBound);
}

void add_point_source(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  CodeRoom room;
  // Without a ceiling: the lamp would lie in it.
  for (const int face : {0, 1, 2, 3, 4})
    room.add(kBoxFaces[face], room.paint(0.5), box_face(face, {4, 4, 3}));
  room.scene().lights.push_back(PointLight{"lamp", to_vec3(p.at("source")),
                                           Spectrum::Constant(1, p.at("flux").get<double>() / (4 * pi))});
  const MeshResult mesh = room.exact_zones();
  const Room walls(room.scene(), mesh.mesh);
  for (std::size_t i = 0; i < c.values.size(); ++i) {
    const json& r = p.at("receivers")[i];
    const SurfacePoint x = point_on(walls.rays(), to_vec3(r.at("point")), to_vec3(r.at("normal")));
    rows.push_back(
        make_row(c, c.values[i], "direct light", estimate(walls, x, c.values[i].id, effort), kPointBound));
  }
}

/// Direct light in the Cornell box of the library, with its blocks.
void add_cornell_blocks(const std::vector<ReferenceCase>& cases, const Effort& effort,
                        std::vector<ValidationRow>& rows) {
  Scene scene = read_scene(REEMIT_SOURCE_DIR "/scenes/library/cornell_box.json");
  for (Material& m : scene.materials)
    if (m.emits()) m.emitted_radiance.setConstant(1);
  const MeshResult mesh = build_mesh(scene);
  const Room walls(scene, mesh.mesh);
  for (const ReferenceCase& c : cases) {
    if (c.kind != "irr_cornell_blocks") continue;
    constexpr double kMetresPerMillimetre = 1e-3;
    const json& r = c.parameters.at("receiver");
    const SurfacePoint x =
        point_on(walls.rays(), kMetresPerMillimetre * to_vec3(r.at("point")), to_vec3(r.at("normal")));
    const ReferenceValue& v = c.values.front();
    rows.push_back(make_row(c, v, "direct light", estimate(walls, x, v.id, effort), kPointBound));
  }
}

}  // namespace

std::vector<ValidationRow> evaluate_direct_light(const std::vector<ReferenceCase>& cases,
                                                 const Effort& effort) {
  std::vector<ValidationRow> rows;
  for (const ReferenceCase& c : cases) {
    if (c.kind == "irr_cornell_blocks") continue;
    if (c.kind == "irr_rect_occluded")
      rows.push_back(occluded(c, effort));
    else if (c.kind == "sky_opening")
      for (const ReferenceValue& v : c.values)
        rows.push_back(v.id.ends_with("overcast") ? overcast(c, v, effort) : sky(c, v, effort));
    else if (c.kind == "point_source")
      add_point_source(c, effort, rows);
    else
      rows.push_back(from_luminaire(c, effort));
  }
  add_cornell_blocks(cases, effort, rows);
  return rows;
}

}  // namespace reemit::validation
