#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/zones/zone_topology.h"
#include "scenes/io/scene_reader.h"
#include "tests/mesh/test_room.h"

namespace reemit {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = REEMIT_SOURCE_DIR;

std::vector<fs::path> rooms_below(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    const bool part_of_a_room =  // included by others
        entry.path().filename() == "vent.mgf" || entry.path().filename() == "chair.mgf" ||
        entry.path().filename() == "table.mgf" || entry.path().parent_path().filename() == "data" ||
        (entry.path().parent_path().filename() == "nrc_office" &&
         entry.path().filename() != "office_design3.mgf");
    if (!part_of_a_room &&
        (extension == ".mgf" || extension == ".obj" || extension == ".gltf" || extension == ".json"))
      out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Of polygons, and of the up to 32 sides that stand for a round shape if a face passes through it [m].
double length_of_outlines(const Surface& surface) {
  double length = 0;
  for (const CurvedShape& shape : surface.shapes) {
    const auto [low, high] = shape_bounds(shape);
    length += 32 * 2 * (high - low).norm();
  }
  for (const Face& face : surface.faces)
    for (std::size_t i = 0; i < face.outer.size(); ++i)
      length +=
          (surface.positions[face.outer[i]] - surface.positions[face.outer[(i + 1) % face.outer.size()]])
              .norm();
  return length;
}

void check_room(const fs::path& file) {
  SCOPED_TRACE(file.string());
  const Scene scene = read_scene(file);
  const MeshResult r = build_mesh(scene);
  EXPECT_LT(test::worst_book_gap(r), 1e-9);
  std::size_t faces = 0;
  double input = 0;
  double removed = 0;
  std::size_t shapes = 0;
  const double weld = MeshTolerances::of(bounds(scene)).weld;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const Surface& s = scene.surfaces[i];
    faces += s.faces.size();
    shapes += s.shapes.size();
    const SurfaceAreas& a = r.report.surfaces[i];
    input += a.input;
    removed += a.removed;
    // Welding moves corners by up to the weld distance, and a face grows or shrinks by at most that along its
    // outline.
    EXPECT_LE(std::abs(a.welded), 1e-6 * a.input + weld * length_of_outlines(s)) << s.name;
    EXPECT_GE(a.removed, 0) << s.name;
  }
  EXPECT_LT(removed, 0.1 * input);
  // A shape brings the sides of its feet, or its own if a face passes through it.
  EXPECT_LT(r.mesh.flat_count(), 300 + 12 * faces + 250 * shapes) << "the traced mesh must stay coarse";
  EXPECT_LT(r.report.warnings.size(), 8U);
  for (const std::string& w : r.report.warnings) EXPECT_LT(w.size(), 1000U);
  for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    ASSERT_TRUE(std::isfinite(r.mesh.triangle_area(t)));
    ASSERT_GT(r.mesh.triangle_area(t), 0);
  }
  const ZoneTopology topology = make_zone_topology(r.mesh, 30);
  EXPECT_EQ(topology.n_faces(), r.mesh.zone_count());
}

TEST(RealRooms, SharedRoomsAreMeshed) {
  const fs::path folder = kSource.parent_path() / "shared" / "scenes";
  if (!fs::exists(folder)) GTEST_SKIP() << "no rooms at " << folder;
  for (const fs::path& file : rooms_below(folder)) check_room(file);
}

TEST(RealRooms, LibraryRoomsAreMeshed) {
  const fs::path folder = kSource / "scenes" / "library";
  if (!fs::exists(folder)) GTEST_SKIP() << "no rooms at " << folder;
  for (const fs::path& file : rooms_below(folder)) check_room(file);
}

}  // namespace
}  // namespace reemit
