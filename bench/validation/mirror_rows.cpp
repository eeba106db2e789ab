#include <algorithm>
#include <array>
#include <functional>
#include <numbers>
#include <regex>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/point_gather.h"

namespace reemit::validation {
namespace {

using nlohmann::json;
using std::numbers::pi;
/// Packets of one zone solution. Most of them leave the open crease at once, and near its edge few zones make
/// up the light.
constexpr double kRoomPackets = 4e6;
constexpr double kCreasePackets = 1.2e7;
constexpr double kPlatePackets = 1e6;
/// Standard error aimed at for the share that a pipe lets through.
constexpr double kPipeTarget = 1.5e-3;
/// As for the continuous rooms. Less work takes fewer, as larger errors hide more of what their size does.
constexpr double kMirrorZones = 60000;
/// Rays per shadow ray at a point, and over a face. Few of the rays that look for a luminaire in a mirror
/// find it.
constexpr double kRaysForImages = 256;
constexpr double kRaysForLight = 8;
constexpr int kShadowRaysAtPoint = 256;
constexpr int kShadowRaysOverFace = 1024;

double zones_for(const Effort& effort) {
  return kMirrorZones * std::min(1.0, effort.work);
}

/// Mirrors and whatever else a point sees are black but for the luminaire, so that the solution of the room
/// is zero and all light over mirrors is what rays from the point meet.
void add_lit_point(const ReferenceCase& c, CodeRoom& room, const Vec3& point, const Effort& effort,
                   std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  const json& l = p.at("luminaire");
  const Vec3 normal = to_vec3(p.at("receiver").at("normal"));
  const Polygon light = turned_towards(
      parallelogram(to_vec3(l.at("corner")), to_vec3(l.at("edge_u")), to_vec3(l.at("edge_v"))), point);
  room.add("light", room.paint(0, pi * p.at("radiance").get<double>()), light);
  room.add("receiver", room.paint(0), triangle_around(point, normal, 1e-3));
  const ReferenceValue& v = c.values.front();
  constexpr double kAnyPackets = 4096;
  const SolvedRoom solved(room.scene(), room.exact_zones(), SolveMethod::kShooting, kAnyPackets, c.name);
  const PointGather gather(solved, seed_of(c.name));
  const GatherEffort rays = gather_effort(kShadowRaysAtPoint, kRaysForImages, effort);
  rows.push_back(make_row(c, v, "gathered point", gather.at(point, normal, rays), kPointBound));
  const SurfacePoint x = point_on(solved.rays(), point, normal);
  rows.push_back(make_row(c, v, "path tracing",
                          traced_irradiance(solved.room(), x, rays, seed_of(c.name + "path")), kPointBound));
}

/// Mirrors of planes "x=0", "y=0", "x=3". Light that reaches the point from an image crosses a plane within
/// the span of point and luminaire along it, and below the luminaire: this mirror is as good as an endless
/// one.
void add_endless_mirror(CodeRoom& room, const json& mirror) {
  constexpr double kBeyond = 4;
  const std::string plane = mirror.at("plane");
  const int axis = plane.front() - 'x';
  const double at = std::stod(plane.substr(2));
  room.add("mirror " + plane, room.mirror(mirror.at("rho_s")),
           axis_rectangle(axis, at, -kBeyond, kBeyond, -kBeyond, kBeyond, at == 0));
}

void add_images(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  CodeRoom room;
  Vec3 point = to_vec3(c.parameters.at("receiver").at("point"));
  for (const json& mirror : c.parameters.at("mirrors")) add_endless_mirror(room, mirror);
  // A point in the plane of the mirror would see half of it. Off it, what the image gives less is what the
  // luminaire gives more, but for a part in a million.
  constexpr double kOff = 2e-3;
  if (point.x() == 0) point.x() = kOff;
  add_lit_point(c, room, point, effort, rows);
}

void add_finite_mirror(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const json& m = c.parameters.at("mirror");
  CodeRoom room;
  room.add("mirror", room.mirror(m.at("rho_s")),
           axis_rectangle(0, m.at("x"), m.at("y")[0], m.at("y")[1], m.at("z")[0], m.at("z")[1], true));
  add_lit_point(c, room, to_vec3(c.parameters.at("receiver").at("point")), effort, rows);
}

/// Side walls of a box, all mirrors.
void add_mirror_walls(CodeRoom& room, const Vec3& size, double reflectance) {
  const MaterialId mirror = room.mirror(reflectance);
  for (const int face : {0, 1, 2, 3}) room.add(kBoxFaces[face], mirror, box_face(face, size));
}

void add_pipe(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  const Vec3 size(p.at("a"), p.at("a"), p.at("L"));
  const ReferenceValue& v = c.values.front();
  CodeRoom room;
  add_mirror_walls(room, size, p.at("rho_s"));
  room.add("entrance", room.paint(0, 1), box_face(4, size));
  room.add("exit", room.paint(0), box_face(5, size));
  const double packets = effort.work * (1 - v.value) / v.value / (kPipeTarget * kPipeTarget);
  for (const SolveMethod method : kMethods) {
    const SolvedRoom solved(room.scene(), room.exact_zones(), method, packets, c.name);
    rows.push_back(make_row(c, v, to_string(method), solved.mean(solved.surface("exit")), kSolveBound));
  }
}

/// Two plates that end at mirrors: endless ones.
void add_plates(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  const Vec3 size(1, 1, 1);
  CodeRoom room;
  add_mirror_walls(room, size, 1);
  room.add("1", room.paint(p.at("rho1").get<double>(), p.at("E1")), box_face(4, size));
  room.add("2", room.paint(p.at("rho2").get<double>(), p.at("E2")), box_face(5, size));
  const auto add_rows = [&](const std::string& method, const std::array<Estimates, 2>& h, double bound) {
    for (const ReferenceValue& v : c.values) {
      // "H1", "B2", "q_net_1": what plate 1 loses
      const std::size_t plate = v.quantity.back() == '1' ? 0 : 1;
      const double rho = p.at(plate == 0 ? "rho1" : "rho2");
      const double emission = p.at(plate == 0 ? "E1" : "E2");
      Estimates value = h[plate];
      if (v.quantity.front() == 'B') value = scaled(value, rho, emission);
      if (v.quantity.front() == 'q') value = scaled(value, rho - 1, emission);
      rows.push_back(make_row(c, v, method, value, bound));
    }
  };
  for (const SolveMethod method : kMethods) {
    const SolvedRoom solved(room.scene(), room.exact_zones(4), method, effort.work * kPlatePackets, c.name);
    const std::array<SurfaceId, 2> plates{solved.surface("1"), solved.surface("2")};
    add_rows(to_string(method), {solved.mean(plates[0]), solved.mean(plates[1])}, kSolveBound);
    if (method != SolveMethod::kShooting) continue;
    const PointGather gather(solved, seed_of(c.name));
    const GatherEffort over_face = gather_effort(kShadowRaysOverFace, kRaysForLight, effort);
    add_rows("gathered mean", {gather.mean({plates[0]}, over_face), gather.mean({plates[1]}, over_face)},
             kPointBound);
  }
}

/// A room of diffuse surfaces and mirrors.
struct MirrorRoom {
  CodeRoom room;
  double area = 0;  ///< Of all surfaces [m2].
  /// Surface whose mean a quantity is.
  std::function<std::string(const std::string&)> surface_of;
  /// Relative numerical bound of a value at a point.
  std::function<double(const Vec3&)> bound_at;
};

/// Means by zones and by the final gather, points by the final gather and by paths.
void add_room_rows(const ReferenceCase& c, const MirrorRoom& r, double packets, const Effort& effort,
                   std::vector<ValidationRow>& rows) {
  const Scene& scene = r.room.scene();
  const SolvedRoom shot(scene, r.room.meshed(r.area / zones_for(effort)), SolveMethod::kShooting,
                        effort.work * packets, c.name);
  const SolvedRoom walked(scene, r.room.exact_zones(4), SolveMethod::kWalk, effort.work * packets, c.name);
  const PointGather gather(shot, seed_of(c.name));
  const GatherEffort at_point = gather_effort(kShadowRaysAtPoint, kRaysForLight, effort);
  const GatherEffort over_face = gather_effort(kShadowRaysOverFace, kRaysForLight, effort);
  for (const ReferenceValue& v : c.values) {
    if (v.point) {
      const double bound = r.bound_at(*v.point);
      rows.push_back(make_row(c, v, "gathered point", gather.at(*v.point, v.normal, at_point), bound));
      const SurfacePoint x = point_on(shot.rays(), *v.point, v.normal);
      rows.push_back(
          make_row(c, v, "path tracing", traced_irradiance(shot.room(), x, at_point, seed_of(v.id)), bound));
      continue;
    }
    const std::string surface = r.surface_of(v.quantity);
    for (const SolvedRoom* solved : {&shot, &walked})
      rows.push_back(make_row(c, v, to_string(solved == &shot ? SolveMethod::kShooting : SolveMethod::kWalk),
                              solved->mean(solved->surface(surface)), kSolveBound));
    rows.push_back(
        make_row(c, v, "gathered mean", gather.mean({shot.surface(surface)}, over_face), kPointBound));
  }
}

/// Two strips along an edge, between mirrors that make them endless. All light between the strips crosses the
/// mirrors' planes within the square that they span.
void add_crease(ReferenceCase c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  CodeRoom room;
  room.add("1", room.paint(p.at("rho1").get<double>(), p.at("E1")), axis_rectangle(2, 0, 0, 1, 0, 1, true));
  room.add("2", room.paint(p.at("rho2").get<double>(), p.at("E2")), axis_rectangle(0, 0, 0, 1, 0, 1, true));
  const MaterialId mirror = room.mirror(1);
  for (const bool far : {false, true})
    room.add("mirror", mirror, axis_rectangle(1, far ? 1 : 0, 0, 1, 0, 1, !far));
  // "H1(0.01)", "H(0+)". Closer to the edge than rays start off a surface there is nothing to measure: the
  // limit is compared at a millionth, where it has been reached to a ten-thousandth.
  constexpr double kAtEdge = 1e-6;
  constexpr double kEdgeBound = 1e-4;
  static const std::regex kPoint(R"(H([12]?)\(([-+0-9.e]+)\).*)");
  for (ReferenceValue& v : c.values) {
    std::smatch match;
    if (!std::regex_match(v.quantity, match, kPoint)) continue;
    const double from_edge = match[2] == "0+" ? kAtEdge : std::stod(match[2]);
    const bool upright = match[1] == "2";
    v.point = upright ? Vec3(0, 0.5, from_edge) : Vec3(from_edge, 0.5, 0);
    v.normal = upright ? Vec3::UnitX() : Vec3::UnitZ();
  }
  constexpr double kArea = 4;
  const auto surface_of = [](const std::string& quantity) { return quantity.substr(1, 1); };
  const auto bound_at = [](const Vec3& point) {
    return std::max(point.x(), point.z()) < 2 * kAtEdge ? kEdgeBound : kPointBound;
  };
  add_room_rows(c, {room, kArea, surface_of, bound_at}, kCreasePackets, effort, rows);
}

/// A box with one face a mirror.
void add_mirror_room(const ReferenceCase& c, const Effort& effort, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  const Vec3 size = to_vec3(p.at("dims"));
  CodeRoom room;
  double area = 0;
  for (int face = 0; face < 6; ++face) {
    const std::string name = kBoxFaces[static_cast<std::size_t>(face)];
    const MaterialId material = name == p.at("mirror_face") ? room.mirror(p.at("mirror_rho_s"))
                                                            : room.paint(p.at("rho").at(name).get<double>(),
                                                                         p.at("E").value(name, 0.0));
    room.add(name, material, box_face(face, size));
    area += total_area({box_face(face, size)});
  }
  const auto surface_of = [](const std::string& quantity) {
    return quantity.substr(quantity.rfind(' ') + 1);
  };
  const auto bound_at = [](const Vec3& /*point*/) { return kPointBound; };
  add_room_rows(c, {room, area, surface_of, bound_at}, kRoomPackets, effort, rows);
}

}  // namespace

std::vector<ValidationRow> evaluate_mirrors(const std::vector<ReferenceCase>& cases, const Effort& effort) {
  std::vector<ValidationRow> rows;
  for (const ReferenceCase& c : cases) {
    if (c.kind == "mirror_images")
      add_images(c, effort, rows);
    else if (c.kind == "mirror_finite")
      add_finite_mirror(c, effort, rows);
    else if (c.kind == "light_pipe")
      add_pipe(c, effort, rows);
    else if (c.kind == "plates_infinite")
      add_plates(c, effort, rows);
    else if (c.kind == "crease_infinite")
      add_crease(c, effort, rows);
    else
      add_mirror_room(c, effort, rows);
  }
  return rows;
}

}  // namespace reemit::validation
