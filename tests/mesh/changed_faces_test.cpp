// What meshing did to which face: one known face of each kind.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "tests/mesh/test_room.h"

namespace reemit::test {
namespace {

using Names = std::vector<std::string>;

// "surface face" of every face that was changed in this way.
Names changed(const Scene& scene, const MeshReport& report, FaceChange change) {
  Names names;
  for (const ChangedFace& c : report.changes)
    if (c.change == change)
      names.push_back(scene.surfaces[c.surface.index()].name + " " + std::to_string(c.face));
  return names;
}

std::vector<Vec3> triangle(double x) {
  return {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}};
}

TEST(ChangedFaces, CleanFacesAreNotListed) {
  TestRoom room;
  const MaterialId m = room.material(false);
  room.box("room", m, {0, 0, 0}, {4, 3, 2}, true);
  room.polygon("sheet", room.material(), floor_rectangle(1, 1, 2, 2, 1));
  EXPECT_TRUE(build_mesh(room.scene()).report.changes.empty());
}

TEST(ChangedFaces, FlippedOnesAreThoseThatDisagree) {
  TestRoom room;
  const SurfaceId box = room.box("box", room.material(false), {0, 0, 0}, {1, 1, 1});
  std::vector<std::uint32_t>& outline = room.scene().surfaces[box.index()].faces[3].outer;
  std::reverse(outline.begin(), outline.end());
  const MeshReport report = build_mesh(room.scene()).report;
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kFlipped), Names{"box 3"});
  EXPECT_EQ(report.changes.size(), 1U);
}

// Its sides are made to agree inwards first, and the lamp is then turned as a whole: those that looked
// inwards as read are those that were turned.
TEST(ChangedFaces, LampTurnedTwiceIsCountedByWhatCameOfIt) {
  TestRoom room;
  const SurfaceId lamp = room.box("lamp", room.material(false, 10), {0, 0, 0}, {1, 1, 1}, true);
  std::vector<std::uint32_t>& outline = room.scene().surfaces[lamp.index()].faces[2].outer;
  std::reverse(outline.begin(), outline.end());
  room.polygon("floor", room.material(), floor_rectangle(-5, -5, 5, 5, -3));
  const MeshReport report = build_mesh(room.scene()).report;
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kFlipped),
            (Names{"lamp 0", "lamp 1", "lamp 3", "lamp 4", "lamp 5"}));
  EXPECT_EQ(report.flipped_faces, 5U);
}

TEST(ChangedFaces, OverlapNamesWhatIsLeftAndWhatCovers) {
  TestRoom room;
  const MaterialId m = room.material();
  room.polygon("first", m, floor_rectangle(0, 0, 2, 2));
  room.polygon("second", m, floor_rectangle(1, 1, 3, 3));
  room.polygon("beside", m, floor_rectangle(5, 5, 6, 6));
  const MeshReport report = build_mesh(room.scene()).report;
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kCovers), Names{"first 0"});
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kCovered), Names{"second 0"});
}

TEST(ChangedFaces, OfTwoAlikeTheLuminaireIsKept) {
  TestRoom room;
  room.polygon("sheet", room.material(), triangle(0));
  room.polygon("lamp", room.material(true, 10), triangle(0));
  const MeshReport report = build_mesh(room.scene()).report;
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kDuplicate), Names{"sheet 0"});
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kCovers), Names{"lamp 0"});
}

TEST(ChangedFaces, CutOnesAreStoodOn) {
  TestRoom room;
  room.polygon("floor", room.material(), floor_rectangle(0, 0, 4, 4));
  room.polygon("screen", room.material(), {{1, 1, 0}, {3, 1, 0}, {3, 1, 2}, {1, 1, 2}});
  const MeshReport report = build_mesh(room.scene()).report;
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kCut), Names{"floor 0"});
  EXPECT_EQ(report.changes.size(), 1U);
}

TEST(ChangedFaces, RepairsAreToldApart) {
  TestRoom room;
  const MaterialId m = room.material();
  const SurfaceId s = room.surface("scrap", m);
  room.add(s, triangle(0));
  room.add(s, {{2, 0, 0}, {3, 0, 0}, {3, 1, 0.2}, {2, 1, 0}});     // bent
  room.add(s, {{4, 0, 0}, {5, 0, 0}, {6, 0, 0}});                  // no area
  room.add(s, {{7, 0, 0}, {8, 0, 0}, {8, 1, 0}, {7.2, -0.1, 0}});  // crosses itself
  room.add(s, {{9, 0, 0}, {10, 0, 0}, {10, 0, 3e-7}, {9, 1, 0}});  // two corners are one
  room.add(s, {{11, 0, 0}, {12, 0, 0}, {12, 1, 1e-13}, {11, 1, 0}});
  room.add(s, {{12, 0, 0}, {13, 0, 0}, {12, 1, 0}});  // shares a corner with the one before, but for rounding
  const MeshReport report = build_mesh(room.scene()).report;
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kNonPlanar), Names{"scrap 1"});
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kDegenerate), Names{"scrap 2"});
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kCrossed), Names{"scrap 3"});
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kWelded), Names{"scrap 4"});
  EXPECT_EQ(report.changes.size(), 4U);
}

TEST(ChangedFaces, FlatFacesOfARoundShapeComeAfterThoseAsRead) {
  TestRoom room;
  const SurfaceId ball = room.polygon("ball", room.material(), floor_rectangle(5, 5, 6, 6));
  room.scene().surfaces[ball.index()].shapes.push_back(Sphere{{0, 0, 0}, 1});
  room.polygon("sheet", room.material(), floor_rectangle(-2, -2, 2, 2, 0.1));
  const MeshReport report = build_mesh(room.scene()).report;
  const Names faceted = changed(room.scene(), report, FaceChange::kFaceted);
  ASSERT_GT(faceted.size(), 100U);
  EXPECT_EQ(faceted.front(), "ball 1");
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kCut).back(), "sheet 0");
}

TEST(ChangedFaces, AFaceOfSeveralPiecesIsThereOnce) {
  TestRoom room;
  room.polygon("bent", room.material(), {{0, 0, 0}, {4, 0, 0}, {4, 4, 0.1}, {0, 4, 0}});
  room.polygon("screen", room.material(), {{-1, 2, -1}, {5, 2, -1}, {5, 2, 1}, {-1, 2, 1}});
  const MeshReport report = build_mesh(room.scene()).report;
  EXPECT_EQ(report.cut_faces, 3U) << "two pieces and the screen";
  EXPECT_EQ(changed(room.scene(), report, FaceChange::kCut), (Names{"bent 0", "screen 0"}));
}

}  // namespace
}  // namespace reemit::test
