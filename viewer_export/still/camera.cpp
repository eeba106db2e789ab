#include "viewer_export/still/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

/// Rays start no farther than about this from the middle of the normalised room, where a float still resolves
/// a millionth of it.
constexpr double kNearRoom = 4;
/// Eyes on a surface, as a wall drawn where the view begins, stand this far before it [normalised].
constexpr double kOffSurface = 1e-5;

std::string where(const Camera& camera) {
  return camera.name.empty() ? "camera" : "camera '" + camera.name + "'";
}

}  // namespace

PinholeCamera::PinholeCamera(const Camera& camera, int width, int height, const RayTracer& rays)
    : half_width_(0.5 * width), half_height_(0.5 * height) {
  if (width < 1 || height < 1 || width > limits::kMostPixels || height > limits::kMostPixels)
    throw InputError(where(camera),
                     "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
                     "Choose 1 to " + std::to_string(limits::kMostPixels) + " pixels each way.");
  if (!camera.eye.allFinite() || !camera.look_at.allFinite() || !camera.up.allFinite())
    throw InputError(where(camera), "eye, look-at and up must be finite numbers", "");
  if (!(camera.vertical_fov_deg > 0 && camera.vertical_fov_deg < 180))
    throw InputError(where(camera),
                     "a vertical field of view of " + std::to_string(camera.vertical_fov_deg) + " degrees",
                     "Choose one between 0 and 180 degrees, such as 45.");
  const Vec3 view = camera.look_at - camera.eye;
  if (!(view.stableNorm() > 0))
    throw InputError(where(camera), "the eye is at the point it looks at", "Move one of them.");
  forward_ = view.stableNormalized();
  const Vec3 across = forward_.cross(camera.up.stableNormalized());
  if (!(across.norm() > 1e-9))
    throw InputError(where(camera), "'up' is zero or lies along the viewing direction",
                     "Choose another 'up' vector.");
  right_ = across.normalized();
  down_ = forward_.cross(right_);
  per_pixel_ = std::tan(camera.vertical_fov_deg * std::numbers::pi / 360) / half_height_;
  const Vec3 middle = rays.in_room(Vec3f::Zero());
  eye_ = (camera.eye - middle) / rays.metres_per_unit();
  Hit hit;
  if (eye_.norm() < kNearRoom &&
      rays.first_on_way((eye_ - kOffSurface * forward_).cast<float>(), forward_.cast<float>(),
                        static_cast<float>(2 * kOffSurface), hit))
    eye_ += kOffSurface * forward_;
}

PinholeCamera::Ray PinholeCamera::ray(double x, double y) const {
  const Vec3 direction =
      (forward_ + per_pixel_ * ((x - half_width_) * right_ + (y - half_height_) * down_)).normalized();
  Ray ray;
  ray.skipped = std::max(0.0, -eye_.dot(direction) - kNearRoom);
  ray.origin = (eye_ + ray.skipped * direction).cast<float>();
  ray.direction = direction.cast<float>();
  return ray;
}

}  // namespace reemit
