#include "scenes/model/limits.h"

#include <fmt/format.h>

namespace reemit {
namespace {

std::string text(const Vec3& place) {
  return fmt::format("the place ({:.6g}, {:.6g}, {:.6g}) m", place.x(), place.y(), place.z());
}

}  // namespace

std::string place_problem(const Vec3& place) {
  // First, for the largest of coordinates need not be the one that is not a number.
  if (!place.allFinite())
    return fmt::format("{} has a coordinate that is infinite or not a number", text(place));
  if (place.cwiseAbs().maxCoeff() <= limits::kFarthest) return "";
  return fmt::format("{} is farther out than {:g} m", text(place), limits::kFarthest);
}

std::string distance_problem(const Vec3& place, const Vec3& middle, double longest_side) {
  if ((place - middle).cwiseAbs().maxCoeff() <= limits::kFarthestInRooms * longest_side) return "";
  return fmt::format("{} is farther from the room than {:g} times its size of {:.4g} m", text(place),
                     limits::kFarthestInRooms, longest_side);
}

std::string strength_problem(const Spectrum& strength, const char* what) {
  const double most = strength.maxCoeff();
  if (most == 0 || (most >= limits::kWeakest && most <= limits::kStrongest)) return "";
  return fmt::format("{} {:.4g} is not between {:g} and {:g}", what, most, limits::kWeakest,
                     limits::kStrongest);
}

}  // namespace reemit
