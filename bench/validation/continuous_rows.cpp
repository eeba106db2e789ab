#include <algorithm>
#include <map>
#include <numbers>
#include <regex>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/point_gather.h"

namespace reemit::validation {
namespace {

using nlohmann::json;
using std::numbers::pi;
/// Rays of one zone solution at full work; most packets leave the open plates at once, so they need more.
constexpr double kBoxRays = 1.2e7;
constexpr double kPlateRays = 8e7;
/// Zones of one room: with fewer, what their size does to gathered values comes near the standard errors.
/// Less work takes fewer, as larger errors hide more of it.
constexpr double kZones = 60000;
constexpr int kShadowRaysInRoom = 256;
constexpr int kShadowRaysOverWall = 1024;
constexpr double kRaysPerShadowRay = 8;

/// A box room, one set of parameters per band.
using Bands = std::vector<const json*>;

Spectrum per_band(const Bands& bands, const std::function<double(const json&)>& value) {
  Spectrum s(static_cast<Eigen::Index>(bands.size()));
  for (std::size_t b = 0; b < bands.size(); ++b) s[static_cast<Eigen::Index>(b)] = value(*bands[b]);
  return s;
}

/// The face around the rectangle of a luminaire, as eight rectangles: no vertex lies on another's edge.
std::vector<Polygon> around(int axis, double height, bool up, const std::array<double, 4>& u,
                            const std::array<double, 4>& v) {
  std::vector<Polygon> cells;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (i != 1 || j != 1) cells.push_back(axis_rectangle(axis, height, u[i], u[i + 1], v[j], v[j + 1], up));
  return cells;
}

void add_face_with_light(CodeRoom& room, int face, const Vec3& size, MaterialId material, MaterialId lamp,
                         const json& rect) {
  const int axis = face / 2;
  const bool high = face % 2 != 0;
  const double height = high ? size[axis] : 0;
  const std::array<double, 4> u{0, rect[0], rect[1], size[axis == 0 ? 1 : 0]};
  const std::array<double, 4> v{0, rect[2], rect[3], size[axis == 2 ? 1 : 2]};
  room.add(kBoxFaces[static_cast<std::size_t>(face)], material, around(axis, height, !high, u, v));
  room.add("light", lamp, axis_rectangle(axis, height, u[1], u[2], v[1], v[2], !high));
}

CodeRoom box_room(const Bands& bands) {
  CodeRoom room(bands.size() == 3 ? BandSet::rgb() : BandSet::grey());
  const json& shape = *bands.front();
  const Vec3 size = to_vec3(shape.at("dims"));
  for (int face = 0; face < 6; ++face) {
    const std::string name = kBoxFaces[static_cast<std::size_t>(face)];
    const MaterialId material =
        room.paint(per_band(bands, [&](const json& p) { return p.at("rho").at(name).get<double>(); }),
                   per_band(bands, [&](const json& p) { return p.at("E").value(name, 0.0); }));
    if (!shape.contains("light") || shape.at("light").at("face") != name) {
      room.add(name, material, box_face(face, size));
      continue;
    }
    const MaterialId lamp =
        room.paint(per_band(bands, [](const json& p) { return p.at("light").at("rho").get<double>(); }),
                   per_band(bands, [](const json& p) { return p.at("light").at("E").get<double>(); }));
    add_face_with_light(room, face, size, material, lamp, shape.at("light").at("rect_uv"));
  }
  if (shape.contains("point_source"))
    room.scene().lights.push_back(PointLight{
        "lamp", to_vec3(shape.at("point_source").at("position")), per_band(bands, [](const json& p) {
          return p.at("point_source").at("flux_lm").get<double>() / (4 * pi);
        })});
  return room;
}

CodeRoom plates_room(const json& p) {
  CodeRoom room;
  room.add("1", room.paint(p.at("rho1").get<double>(), p.at("E1")), axis_rectangle(2, 0, 0, 1, 0, 1, true));
  room.add("2", room.paint(p.at("rho2").get<double>(), p.at("E2")),
           axis_rectangle(2, p.at("h"), 0, 1, 0, 1, false));
  return room;
}

CodeRoom l_shaped_room(const json& p) {
  CodeRoom room;
  for (const auto& [name, polygons] : l_room(2, 2, 1, 1))
    room.add(name, room.paint(p.at("rho").get<double>(), p.at("E").value(name, 0.0)), polygons);
  return room;
}

/// Packets for a number of rays: a packet is reflected about 1/(1 - rho) times.
double packets_of(const CodeRoom& room, double rays) {
  double most = 0;
  const auto bands = static_cast<Eigen::Index>(room.scene().bands.count());
  for (Eigen::Index b = 0; b < bands; ++b) {
    double area = 0;
    double reflected = 0;
    for (const Surface& s : room.scene().surfaces)
      for (const Face& f : s.faces) {
        Polygon corners;
        for (const std::uint32_t i : f.outer) corners.push_back(s.positions[i]);
        const double a = total_area({corners});
        area += a;
        reflected += a * room.scene().material_of(s).reflectance[b];
      }
    most = std::max(most, reflected / area);
  }
  return rays * (1 - most);
}

double zone_area_of(const CodeRoom& room, const Effort& effort) {
  double area = 0;
  for (const Surface& s : room.scene().surfaces)
    for (const Face& f : s.faces) {
      Polygon corners;
      for (const std::uint32_t i : f.outer) corners.push_back(s.positions[i]);
      area += total_area({corners});
    }
  return area / (kZones * std::min(1.0, effort.work));
}

/// Surfaces that a mean value covers: "H_mean on face x0", "H_mean on W1", "H_mean on the luminaire itself",
/// "H1_mean". A face with a luminaire in it counts with the luminaire.
std::vector<SurfaceId> surfaces_of_mean(const SolvedRoom& room, const ReferenceCase& c,
                                        const std::string& quantity) {
  if (quantity.find("luminaire") != std::string::npos) return {room.surface("light")};
  if (c.kind == "plates_finite") return {room.surface(quantity.substr(1, 1))};
  const std::string name = quantity.substr(quantity.rfind(' ') + 1);
  std::vector<SurfaceId> result{room.surface(name)};
  if (c.parameters.contains("light") && c.parameters.at("light").at("face") == name)
    result.push_back(room.surface("light"));
  return result;
}

/// Points of plates are in the quantity: "H1(0.5,0.5)".
void set_plate_point(const ReferenceCase& c, ReferenceValue& v) {
  static const std::regex kPoint(R"(H([12])\(([-0-9.]+),([-0-9.]+)\))");
  std::smatch match;
  if (!std::regex_match(v.quantity, match, kPoint)) return;
  const bool upper = match[1] == "2";
  v.point = Vec3(std::stod(match[2]), std::stod(match[3]), upper ? c.parameters.at("h").get<double>() : 0.0);
  v.normal = Vec3(0, 0, upper ? -1 : 1);
}

void add_rows(const std::vector<ReferenceCase>& bands, const CodeRoom& room, double rays,
              const Effort& effort, std::vector<ValidationRow>& rows) {
  const std::string& name = bands.front().name;
  const SolvedRoom solved(room.scene(), room.meshed(zone_area_of(room, effort)), SolveMethod::kShooting,
                          packets_of(room, effort.work * rays), name);
  const PointGather gather(solved, seed_of(name));
  const GatherEffort at_point = gather_effort(kShadowRaysInRoom, kRaysPerShadowRay, effort);
  const GatherEffort over_face = gather_effort(kShadowRaysOverWall, kRaysPerShadowRay, effort);
  for (std::size_t b = 0; b < bands.size(); ++b)
    for (ReferenceValue v : bands[b].values) {
      if (bands[b].kind == "plates_finite") set_plate_point(bands[b], v);
      const Estimates light = v.point
                                  ? gather.at(*v.point, v.normal, at_point, b)
                                  : gather.mean(surfaces_of_mean(solved, bands[b], v.quantity), over_face, b);
      rows.push_back(make_row(bands[b], v, v.point ? "gathered point" : "gathered mean", light, kPointBound));
    }
}

/// Rooms named alike but for the ending R, G or B are the bands of one RGB room.
std::string name_of_room(const std::string& case_name) {
  static const std::regex kBand(R"((.*[._])[RGB])");
  std::smatch match;
  return std::regex_match(case_name, match, kBand) ? std::string(match[1]) : case_name;
}

}  // namespace

std::vector<ValidationRow> evaluate_continuous(const std::vector<ReferenceCase>& cases,
                                               const Effort& effort) {
  std::vector<ValidationRow> rows;
  std::map<std::string, std::vector<ReferenceCase>> rooms;
  std::vector<std::string> order;
  for (const ReferenceCase& c : cases) {
    const std::string name = name_of_room(c.name);
    if (rooms[name].empty()) order.push_back(name);
    rooms[name].push_back(c);
  }
  for (const std::string& name : order) {
    std::vector<ReferenceCase>& bands = rooms[name];
    if (bands.size() != 3) bands.resize(1);
    const ReferenceCase& first = bands.front();
    if (first.kind == "plates_finite") {
      add_rows(bands, plates_room(first.parameters), kPlateRays, effort, rows);
    } else if (first.kind == "lroom_continuous") {
      add_rows(bands, l_shaped_room(first.parameters), kBoxRays, effort, rows);
    } else {
      Bands parameters;
      for (const ReferenceCase& c : bands) parameters.push_back(&c.parameters);
      add_rows(bands, box_room(parameters), kBoxRays, effort, rows);
    }
  }
  return rows;
}

}  // namespace reemit::validation
