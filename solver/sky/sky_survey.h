#pragma once
#include <functional>
#include <vector>

#include "solver/reflect/surface_model.h"
#include "solver/sky/sky_view.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// A ray from a surface of the room that left it.
struct SkySight {
  Vec3f point;          ///< Where it started [normalised].
  Vec3f towards;        ///< Unit.
  std::uint32_t place;  ///< Of the view.
  float area;           ///< Of surface that the ray stands for [normalised]; all rays of a point together
                        ///< stand for that of the point.
};

/// Rays from all sides with zones into their hemispheres, by cosine: from deep inside, where few get out, up
/// to 64 of each point; then from the air all over. Panes, bodies of glass and opal sheets do not stop them.
/// Fills `view` and shows every ray that leaves the room. `brightness` of a direction (unit, room) in the
/// sky; `to_local`: to its frame. The same on any number of threads.
void survey_sky(const ZoneMesh& mesh, const RayTracer& rays, const SurfaceModel& surfaces,
                const Eigen::Matrix3d& to_local, const std::function<float(const Vec3f&)>& brightness,
                SkyView& view, std::vector<SkySight>& sights);

/// Rays from points of the same kind towards a small disk that `sample` draws directions to: those that get
/// out, with the cosine at the surface in their area.
void survey_sun(const ZoneMesh& mesh, const RayTracer& rays, const SurfaceModel& surfaces,
                const std::function<Vec3f(float, float)>& sample, const SkyView& view,
                std::vector<SkySight>& sights);

}  // namespace reemit
