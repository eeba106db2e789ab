#pragma once
#include <string>

#include "scenes/model/bands.h"
#include "scenes/model/vec.h"

namespace reemit {

/// The numbers that a room may hold: readers, the checks of a room and the command line share them, and
/// docs/room_format.md states them. Inside them single precision neither overflows nor vanishes where rays
/// and luminaires use it; beyond them lies no real room.
namespace limits {
/// Coordinates and lengths, as they stand in a file and in metres [m].
inline constexpr double kFarthest = 1e10;
/// Longest side of the box around the surfaces of a room [m].
inline constexpr double kSmallestRoom = 1e-6;
/// Distance of lights and cameras from the middle of that box, in its longest sides.
inline constexpr double kFarthestInRooms = 1e5;
/// Radiance [W/(m2 sr)], intensity [W/sr] and irradiance [W/m2] in any band.
inline constexpr double kStrongest = 1e15;
/// The same in the strongest band of what emits.
inline constexpr double kWeakest = 1e-15;
/// Sides of a picture [px].
inline constexpr int kMostPixels = 16384;
}  // namespace limits

/// What is wrong with a place [m], or nothing: "the place (1e+20, 0, 0) m is ...".
std::string place_problem(const Vec3& place);
/// What is wrong with the place of a light or a camera in a room with this box [m], or nothing.
std::string distance_problem(const Vec3& place, const Vec3& middle, double longest_side);
/// What is wrong with an emission (see limits), or nothing; none at all is fine. `what`: "radiance".
std::string strength_problem(const Spectrum& strength, const char* what);

inline constexpr const char* kLengthAdvice = "Check the number, the unit of length and the transforms.";
inline constexpr const char* kStrengthAdvice = "Check the number and its unit.";

}  // namespace reemit
