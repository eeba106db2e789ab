#pragma once
#include "scenes/model/camera.h"
#include "scenes/model/vec.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// Pinhole camera over the pixels of one picture. Pixels are square: the horizontal field of view follows
/// from the vertical one and the size of the picture. An eye that lies on a surface stands just before it, on
/// the side to which it looks.
class PinholeCamera {
 public:
  struct Ray {
    Vec3f origin;        ///< Normalised; the eye, or where the ray comes near the room if the eye is far off.
    Vec3f direction;     ///< Unit.
    double skipped = 0;  ///< Way from the eye to the origin [normalised units].
  };

  /// Size of the picture in pixels. Throws InputError when a value is not finite or out of range, the eye is
  /// where it looks at, or `up` lies along the viewing direction.
  PinholeCamera(const Camera& camera, int width, int height, const RayTracer& rays);

  /// Ray through a point of the picture [px]: (0,0) is its upper left corner, y runs down.
  Ray ray(double x, double y) const;
  /// Width of a pixel over its distance from the eye, in the middle of the picture.
  double pixel_width() const { return per_pixel_; }

 private:
  Vec3 eye_;  // normalised
  Vec3 forward_, right_, down_;
  double half_width_, half_height_;  // [px]
  double per_pixel_;                 // of the image plane at distance 1
};

}  // namespace reemit
