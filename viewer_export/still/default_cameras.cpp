#include "viewer_export/still/default_cameras.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <unordered_set>

#include <fmt/format.h>

#include "scenes/io/common/up_direction.h"
#include "solver/sampling/sphere_lattice.h"
#include "viewer_export/still/lit_space.h"
#include "viewer_export/still/panorama.h"

namespace reemit {
namespace {

using std::numbers::pi;

constexpr int kSize = 640;      // [px], width; the height is 3/4 of it
constexpr double kFovDeg = 60;  // vertical
constexpr std::size_t kMostCameras = 3;
constexpr std::size_t kPlaces = 1024;     // on the way of light, looked at for eyes
constexpr std::size_t kMostEyes = 160;    // that look around
constexpr int kFreedomRays = 48;          // rays that tell whether an eye stands in free space
constexpr int kTurn = 2;                  // columns of a panorama between two views tried
constexpr double kMostWrongSides = 0.03;  // share of surrounding rays that may meet backs of faces
constexpr float kClearance = 0.12F;       // of the width of the lit space: nothing is closer to an eye
constexpr float kNear = 0.4F;             // of the width of the lit space: what is closer blocks the view
constexpr float kCell = 1.0F / 3;         // of the width of the lit space: pieces of surfaces told apart
constexpr float kApart = 1.0F / 4;        // of the width of the lit space: between eyes
constexpr float kLeastSpace = 0.1F;       // normalised: lit space that is narrower is the inside of a lamp

/// A place to look from.
struct Eye {
  Vec3f place{0, 0, 0};  ///< Normalised.
  float clearance = 0;   ///< To the nearest surface, normalised.
  double enclosed = 0;   ///< Share of directions that meet the right side of a surface [0,1].
};

struct View {
  const Panorama* panorama;
  int column;
};

/// A room as the choice of eyes sees it.
struct RoomAndAxes {
  const RayTracer& rays;
  RoomAxes axes;
  float low, high;  // of the room along up, normalised

  RoomAndAxes(const RayTracer& rays_of_room, const Vec3& up) : rays(rays_of_room), axes(up) {
    low = high = axes.up.dot(rays.corner(TriangleId(0), 0));
    for (std::size_t t = 0; t < rays.mesh().triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        const float height = axes.up.dot(rays.corner(TriangleId(t), k));
        low = std::min(low, height);
        high = std::max(high, height);
      }
  }

  /// How far it is to the next surface, else the room's end, straight up or down.
  float free_way(const Vec3f& place, bool upwards) const {
    Hit hit;
    if (rays.closest(place, upwards ? axes.up : Vec3f(-axes.up), hit)) return hit.distance;
    const float height = axes.up.dot(place);
    return std::max(0.0F, upwards ? high - height : height - low);
  }

  /// The place moved straight up or down to where a person's eyes would be, as far as there is room.
  Vec3f at_eye_height(const Vec3f& place) const {
    constexpr double kStanding = 1.6;  // [m]
    const float below = free_way(place, false);
    const float height = below + free_way(place, true);
    const auto standing = static_cast<float>(kStanding / rays.metres_per_unit());
    return place + (std::clamp(standing, 0.35F * height, 0.65F * height) - below) * axes.up;
  }

  /// Nothing where backs of one-sided faces surround the place: it lies behind the walls.
  std::optional<Eye> eye_at(const Vec3f& place) const {
    Eye eye{place, 4, 0};
    int right_sides = 0;
    int wrong_sides = 0;
    for (int i = 0; i < kFreedomRays; ++i) {
      const auto [z, azimuth] = sphere_lattice(i, kFreedomRays);
      const Vec3f direction =
          axes.direction(static_cast<float>(azimuth), static_cast<float>(std::asin(z))).normalized();
      Hit hit;
      if (!rays.closest(place, direction, hit)) continue;
      eye.clearance = std::min(eye.clearance, hit.distance);
      ++(hit.front || rays.mesh().triangle(hit.triangle).two_sided ? right_sides : wrong_sides);
    }
    if (wrong_sides > kMostWrongSides * kFreedomRays) return std::nullopt;
    eye.enclosed = static_cast<double>(right_sides) / kFreedomRays;
    return eye;
  }
};

using EyesByPlace = std::map<std::tuple<int, int, int>, Eye>;

/// The eye above or below a place on the way of light, if it is freer than the others near it.
void keep_freest(const RoomAndAxes& room, const Vec3f& place, float width, EyesByPlace& freest) {
  const std::optional<Eye> eye = room.eye_at(room.at_eye_height(place));
  if (!eye || eye->clearance < kClearance * width) return;
  const Vec3f cell = (eye->place / (kApart * width)).array().floor();
  Eye& best = freest[{static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())}];
  if (eye->clearance > best.clearance) best = *eye;
}

/// Eyes evenly along the way of light, the freest of each neighbourhood.
std::vector<Eye> find_eyes(const RoomAndAxes& room, const LitSpace& space) {
  EyesByPlace freest;
  double way = 0;
  for (const LightLeg& leg : space.legs) way += static_cast<double>(leg.length);
  double passed = 0;
  double next = 0.5 * way / kPlaces;
  for (const LightLeg& leg : space.legs) {
    for (; next < passed + leg.length; next += way / kPlaces) {
      // Not at the very ends of a leg, which lie on surfaces.
      const float along =
          std::clamp(static_cast<float>(next - passed), 0.05F * leg.length, 0.95F * leg.length);
      keep_freest(room, leg.origin + along * leg.direction, space.width, freest);
    }
    passed += leg.length;
  }
  std::vector<Eye> eyes;
  for (const auto& [where, eye] : freest) eyes.push_back(eye);
  const std::size_t kept = std::min(kMostEyes, eyes.size());
  for (std::size_t i = 0; i < kept; ++i) eyes[i] = eyes[i * eyes.size() / kept];
  eyes.resize(kept);
  return eyes;
}

/// How good a picture is: full of lit surfaces of many kinds, wide, nothing in the way, the eye in the room.
double score(const ViewContent& content, double enclosed) {
  return content.seen * content.seen * (0.4 + 0.6 * enclosed) * (0.05 + 0.95 * content.lit) * content.open *
         content.open * content.extent * std::sqrt(content.variety);
}

/// Best views in turn; each further one by how much it shows that those before it do not.
std::vector<View> choose_views(const std::vector<Panorama>& panoramas, const std::vector<Eye>& eyes,
                               float width) {
  std::vector<View> chosen;
  std::unordered_set<std::uint64_t> known;
  while (chosen.size() < kMostCameras) {
    std::optional<View> best;
    double highest = 0;
    for (std::size_t i = 0; i < panoramas.size(); ++i)
      for (int column = 0; column < Panorama::kColumns; column += kTurn) {
        const ViewContent content = content_of(panoramas[i], column, kNear * width, known);
        const double value = score(content, eyes[i].enclosed) * content.novelty;
        if (value <= highest) continue;
        highest = value;
        best = View{&panoramas[i], column};
      }
    if (!best) break;
    add_areas(*best->panorama, best->column, known);
    chosen.push_back(*best);
  }
  return chosen;
}

Camera camera_towards(const Vec3& eye, const Vec3& look_at, const Vec3& up, std::size_t number) {
  Camera camera;
  camera.name = fmt::format("auto-{}", number);
  camera.eye = eye;
  camera.look_at = look_at;
  camera.up = up;
  camera.vertical_fov_deg = kFovDeg;
  camera.width = kSize;
  camera.height = kSize * 3 / 4;
  return camera;
}

Camera camera_of(const View& view, const RoomAndAxes& room, double distance, std::size_t number) {
  const double azimuth = 2 * pi * (view.column + 0.5) / Panorama::kColumns;
  const Vec3 eye = room.rays.in_room(view.panorama->eye);
  const Vec3 forward = room.axes.direction(static_cast<float>(azimuth), 0).cast<double>();
  return camera_towards(eye, eye + distance * forward, room.axes.up.cast<double>(), number);
}

/// The whole room from outside, from the side its largest triangle faces.
Camera outside_camera(const RayTracer& rays, const Vec3& up) {
  const ZoneMesh& mesh = rays.mesh();
  TriangleId largest(0);
  for (std::size_t t = 1; t < mesh.triangle_count(); ++t) {
    if (mesh.triangle_area(TriangleId(t)) > mesh.triangle_area(largest)) largest = TriangleId(t);
  }
  const Vec3& normal = mesh.triangle_normal(largest);
  const Vec3 middle = rays.in_room(Vec3f::Zero());
  const double distance = 3 * rays.metres_per_unit();
  const Vec3 level = std::abs(normal.dot(up)) < 0.99 ? up : Vec3(up.z(), up.x(), up.y());
  return camera_towards(middle + distance * normal, middle, level, 1);
}

std::vector<Camera> cameras_in(const Room& room, const RoomAndAxes& around, const LitSpace& space) {
  std::vector<Camera> cameras;
  if (!(space.width > kLeastSpace)) return cameras;
  const std::vector<Eye> eyes = find_eyes(around, space);
  const LitCells lit(room.surfaces(), space);
  std::vector<Panorama> panoramas;
  for (const Eye& eye : eyes)
    panoramas.push_back(look_around(room.rays(), around.axes, lit, kCell * space.width, eye.place));
  const double distance = space.width * room.rays().metres_per_unit();
  for (const View& view : choose_views(panoramas, eyes, space.width))
    cameras.push_back(camera_of(view, around, distance, cameras.size() + 1));
  return cameras;
}

}  // namespace

std::vector<Camera> default_cameras(const Room& room) {
  const Vec3 up = up_direction(room.scene());
  const RoomAndAxes around(room.rays(), up);
  std::vector<Camera> cameras = cameras_in(room, around, trace_light(room));
  if (cameras.empty()) cameras = cameras_in(room, around, trace_from_all_surfaces(room));
  if (cameras.empty()) cameras.push_back(outside_camera(room.rays(), up));
  return cameras;
}

}  // namespace reemit
