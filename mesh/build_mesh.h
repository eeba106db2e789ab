#pragma once
#include "mesh/model/mesh_report.h"
#include "mesh/model/mesh_settings.h"
#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"
#include "scenes/model/work_watch.h"

namespace reemit {

struct MeshResult {
  ZoneMesh mesh;
  MeshReport report;
};

/// Repairs, cuts and triangulates the room and sizes its zones. Deterministic.
/// Throws InputError when nothing is left to trace, a face cannot be repaired (it is named), or all
/// luminaires are too small or thin to be meshed; Interrupted when `watch` ends it. The first call silences
/// CGAL's error handler in the whole process: what CGAL finds wrong is handled here.
MeshResult build_mesh(const Scene& scene, const MeshSettings& settings = {}, const WorkWatch& watch = {});

}  // namespace reemit
