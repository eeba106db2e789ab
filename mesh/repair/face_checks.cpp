#include "mesh/repair/face_checks.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "mesh/pieces/face_notes.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

void check_loop(const Scene& scene, SurfaceId surface, std::uint32_t face,
                const std::vector<std::uint32_t>& loop) {
  const Surface& s = scene.surfaces[surface.index()];
  const auto fail = [&](const std::string& problem, const std::string& advice) {
    throw InputError("face " + face_name(scene, surface, face), problem, advice);
  };
  if (loop.size() < 3) fail("fewer than three corners", "remove the face or add corners");
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (loop[i] >= s.positions.size())
      fail(fmt::format("corner {} refers to vertex {} of {}", i, loop[i], s.positions.size()),
           "check the vertex indices of this face");
    if (!s.positions[loop[i]].allFinite())
      fail(fmt::format("corner {} has a coordinate that is not a finite number", i),
           "correct the vertex in the file");
  }
}

}  // namespace

void check_faces(const Scene& scene) {
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    if (surface.material.index() >= scene.materials.size())
      throw InputError("surface '" + surface.name + "'", "it refers to a material that does not exist",
                       "check the material of this surface");
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
      check_loop(scene, SurfaceId(s), f, surface.faces[f].outer);
      for (const auto& hole : surface.faces[f].holes) check_loop(scene, SurfaceId(s), f, hole);
    }
  }
}

}  // namespace reemit
