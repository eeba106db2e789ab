#pragma once
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "solver/trace/ray_tracer.h"
#include "viewer_export/still/lit_space.h"

namespace reemit {

/// The axes of a room; a and b are level, up is up. Unit, right-handed.
struct RoomAxes {
  Vec3f up{0, 1, 0}, a{1, 0, 0}, b{0, 0, 1};
  explicit RoomAxes(const Vec3& up_direction);
  Vec3f direction(float azimuth, float elevation) const;  ///< Angles [rad].
};

/// Number of the piece of surface, `size` wide (normalised), that a point lies in: cuts the surfaces of a
/// room into pieces, so that it can be said how many an eye sees, and which of them another one has seen.
std::uint64_t surface_cell(const Vec3f& point, const Vec3f& normal, float size);

/// Large pieces of surface, of half the width of the lit space, and those among them that light comes to
/// without being luminaires.
class LitCells {
 public:
  /// `space`: what is lit of the room; both are read here only.
  LitCells(const SurfaceModel& surfaces, const LitSpace& space);
  std::uint64_t cell(const Vec3f& point, const Vec3f& normal) const {
    return surface_cell(point, normal, size_);
  }
  /// `surface`: that the point of the cell lies on.
  bool is_lit(std::uint64_t cell, SurfaceId surface) const {
    return !emits_[surface.index()] && lit_.contains(cell);
  }

 private:
  float size_;
  std::vector<bool> emits_;  // by surface
  std::unordered_set<std::uint64_t> lit_;
};

/// What lies in one direction.
struct Sight {
  float distance = 0;      ///< Normalised units; 0 if nothing is there.
  std::uint64_t cell = 0;  ///< Small piece of surface, surface_cell.
  std::uint64_t area = 0;  ///< Large piece of surface, LitCells::cell.
  std::uint64_t part = 0;  ///< Surface and which way it faces: what the eye tells apart.
  bool lit = false;
};

/// What an eye sees all around, from 30 degrees below the horizon to 30 degrees above.
struct Panorama {
  static constexpr int kColumns = 60;  ///< Of 6 degrees each.
  static constexpr int kRows = 10;     ///< Of 6 degrees each.
  Vec3f eye{0, 0, 0};                  ///< Normalised.
  std::vector<Sight> sights;           ///< [column * kRows + row], column 0 begins at azimuth 0.
};
/// `cell`: size of the pieces of surface told apart, normalised.
Panorama look_around(const RayTracer& rays, const RoomAxes& axes, const LitCells& lit, float cell,
                     const Vec3f& eye);

/// How a view of 78 x 60 degrees is filled. All but `variety` are shares [0,1].
struct ViewContent {
  double seen = 0;  ///< Of the view: some surface is there.
  double lit = 0;   ///< Of the view: and light comes to it; luminaires do not count.
  double open = 0;  ///< Mean of min(1, distance/near): 1 if nothing stands before the eye.
  double extent =
      0;  ///< Pieces of surface seen over directions looked in: large where much is seen from afar.
  double novelty = 0;  ///< Of the view: on large pieces that are not among the known ones.
  double variety = 0;  ///< Parts that share the view evenly would look as varied; >= 1, 0 if nothing is seen.
};

/// Of the view with `column` in its middle. `near`: normalised units.
ViewContent content_of(const Panorama& panorama, int column, float near,
                       const std::unordered_set<std::uint64_t>& known);
/// Adds the large pieces of surface in that view.
void add_areas(const Panorama& panorama, int column, std::unordered_set<std::uint64_t>& known);

}  // namespace reemit
