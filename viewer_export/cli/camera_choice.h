#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scenes/model/camera.h"
#include "solver/room/room.h"

namespace reemit::cli {

/// Which views the command line asks for.
struct CameraOptions {
  std::string name;               ///< Of a camera, or "all"; empty: not given.
  std::optional<Vec3> eye;        ///< [m] A camera of its own; needs look_at.
  std::optional<Vec3> look_at;    ///< [m]
  std::optional<Vec3> up;         ///< Unset: up_direction.
  std::optional<double> fov_deg;  ///< Full vertical field of view [deg], (0,180); unset: 45.
};

/// The cameras of the room, or sensible ones if it has none.
std::vector<Camera> cameras_of(const Room& room);

/// Throws InputError for an `up` or a field of view without an eye: cameras of the room have their own.
void check_view(const CameraOptions& options);

/// The cameras to render. Without a name or an eye: all when `several` pictures are possible, else the first.
/// Throws InputError for an unknown name (the known ones are listed) and for several cameras but one picture.
std::vector<Camera> choose_cameras(const CameraOptions& options, const Room& room, bool several);

}  // namespace reemit::cli
