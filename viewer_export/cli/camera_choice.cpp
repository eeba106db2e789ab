#include "viewer_export/cli/camera_choice.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/io/common/up_direction.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"
#include "viewer_export/still/default_cameras.h"

namespace reemit::cli {
namespace {

Camera camera_of_options(const CameraOptions& options, const Scene& scene) {
  Camera camera;
  camera.name = "view";
  camera.eye = *options.eye;
  const Box room = bounds(scene);
  const std::string problem = distance_problem(camera.eye, room.centre(), room.size().maxCoeff());
  if (!problem.empty()) throw InputError("--eye", problem, "Move it nearer and narrow --fov.");
  camera.look_at = options.look_at.value();
  camera.up = options.up.value_or(up_direction(scene));
  const Vec3 forward = camera.look_at - camera.eye;
  if (!options.up && forward.cross(camera.up).norm() < 1e-6 * forward.norm()) {
    camera.up =
        Vec3(camera.up.z(), camera.up.x(), camera.up.y());  // straight up or down: any level way will do
  }
  constexpr double kUsualFov = 45;
  camera.vertical_fov_deg = options.fov_deg.value_or(kUsualFov);
  camera.width = 640;
  camera.height = 480;
  return camera;
}

}  // namespace

std::vector<Camera> cameras_of(const Room& room) {
  const std::vector<Camera>& own = room.scene().cameras;
  return own.empty() ? default_cameras(room) : own;
}

void check_view(const CameraOptions& options) {
  if (options.eye || !(options.up || options.fov_deg)) return;
  throw InputError(
      options.fov_deg ? "--fov" : "--up",
      fmt::format("is for a view by --eye; cameras of the room have their own {}",
                  options.fov_deg ? "field of view" : "up direction"),
      "leave it out, or say where the camera is and what it looks at: --eye X,Y,Z --look-at X,Y,Z");
}

std::vector<Camera> choose_cameras(const CameraOptions& options, const Room& room, bool several) {
  if (options.eye) return {camera_of_options(options, room.scene())};
  std::vector<Camera> cameras = cameras_of(room);
  if (options.name.empty() && !several) return {cameras.front()};
  if (options.name.empty() || options.name == "all") {
    if (!several && cameras.size() > 1) {
      throw InputError("-o", fmt::format("{} cameras do not fit into one file", cameras.size()),
                       "give a folder, as in -o pictures/");
    }
    return cameras;
  }
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const Camera& camera) { return camera.name == options.name; });
  if (found != cameras.end()) return {*found};
  std::vector<std::string> names;
  names.reserve(cameras.size());
  for (const Camera& camera : cameras) names.push_back(camera.name);
  throw InputError("--camera", fmt::format("the room has no camera '{}'", options.name),
                   fmt::format("it has: {}; or use 'all', or --eye and --look-at", fmt::join(names, ", ")));
}

}  // namespace reemit::cli
