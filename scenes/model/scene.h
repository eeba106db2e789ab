#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/model/bands.h"
#include "scenes/model/camera.h"
#include "scenes/model/luminaire.h"
#include "scenes/model/material.h"
#include "scenes/model/sky.h"
#include "scenes/model/surface.h"

namespace reemit {

/// How often each kind of thing occurs; the kinds are listed in docs/command_line.md.
using KindCounts = std::map<std::string, std::size_t>;

/// A room as read from file: plain data in metres, watts and steradians.
/// Readers fill it in any order, then call finish_scene, after which it is not changed any more.
struct Scene {
  std::string name;
  std::string source;  ///< Path of the room file.
  /// All that were read for it, absolute: the room, what it refers to, images. Empty if it is of no file.
  std::vector<std::string> files;
  BandSet bands = BandSet::grey();
  std::vector<Material> materials;  ///< Every Spectrum has bands.count() entries.
  std::vector<Surface> surfaces;
  std::vector<PunctualLight> lights;
  std::optional<Sky> sky;             ///< What stands around the room; none: nothing, black.
  std::vector<Camera> cameras;        ///< Names are unique.
  std::vector<std::string> warnings;  ///< What the user should know: ignored parts, assumptions, repairs.
  std::vector<std::string> notes;     ///< Conversions and assumptions that were applied (units, efficacy).
  KindCounts refused;       ///< Parts of the file that were left out: damaged, missing, or of no known kind.
  KindCounts not_modelled;  ///< Parts that were understood, but whose effect on light is not simulated.

  const Material& material_of(const Surface& s) const { return materials[s.material.index()]; }
  /// Whether what a surface does with light differs from point to point.
  bool is_textured(const Surface& s) const { return s.has_vertex_colours || material_of(s).textures.any(); }
  /// Whether a surface bends light (NonDiffusePart::bends_light).
  bool bends_light() const;
};

/// Checks every value (finite, in range, indices in bounds, names unique) and throws InputError at the first
/// that fails; drops to one band when no colour is anywhere; warns once per material whose non-diffuse part
/// is ignored, when there is no luminaire, and when the size is unlikely for a room in metres.
void finish_scene(Scene& scene);

struct Box {
  Vec3 min{0, 0, 0};
  Vec3 max{0, 0, 0};
  Vec3 size() const { return max - min; }
  Vec3 centre() const { return 0.5 * (min + max); }
};

/// Bounding box of all faces and shapes [m]; a box of zero size if there are none.
Box bounds(const Scene& scene);

/// Content hash of everything that light transport depends on, or will once it is simulated (geometry, all of
/// the materials, lights, bands; not cameras, names or paths), as 16 hex digits.
std::string content_hash(const Scene& scene);

}  // namespace reemit
