#include "viewer_export/inspection/side_kinds.h"

#include <fmt/format.h>

namespace reemit {
namespace {

constexpr SideKindStyle kStyles[kSideKindCount] = {
    {"flipped", "flipped", {0xd4, 0x14, 0x8c}},
    {"sealed", "sealed, no light", {0x2f, 0x55, 0xd4}},
    {"covered", "overlapping, what is left", {0xf0, 0x7d, 0x12}},
    {"covers", "overlapping, covers another", {0x8c, 0x56, 0x2b}},
    {"repaired", "repaired", {0xd6, 0x20, 0x20}},
    {"cut", "cut along contacts", {0x1f, 0xa0, 0x8a}},
    {"faceted", "flat instead of round", {0xb0, 0x9c, 0xe0}},
    {"luminaire", "luminous, untouched", {0xff, 0xe1, 0x4d}},
    {"untouched", "untouched", {0xc8, 0xc8, 0xc8}},
};

SideKind kind_of(FaceChange change) {
  switch (change) {
    case FaceChange::kFlipped:
      return SideKind::kFlipped;
    case FaceChange::kCovered:
      return SideKind::kCovered;
    case FaceChange::kCovers:
      return SideKind::kCovers;
    case FaceChange::kCut:
      return SideKind::kCut;
    case FaceChange::kFaceted:
      return SideKind::kFaceted;
    case FaceChange::kBackToBack:
      return SideKind::kUntouched;
    case FaceChange::kDuplicate:
    case FaceChange::kDegenerate:
    case FaceChange::kNonPlanar:
    case FaceChange::kCrossed:
    case FaceChange::kWelded:
      break;
  }
  return SideKind::kRepaired;
}

/// What meshing did to a face.
SideKind kind_of(const SurfaceFace& face, std::span<const ChangedFace> changes) {
  SideKind kind = SideKind::kUntouched;
  for (const ChangedFace& change : changes_of(changes, face.surface, face.face))
    kind = std::min(kind, kind_of(change.change));
  return kind;
}

}  // namespace

std::string SideKindStyle::hex() const {
  return fmt::format("#{:02x}{:02x}{:02x}", srgb[0], srgb[1], srgb[2]);
}

const SideKindStyle& style_of(SideKind kind) {
  return kStyles[static_cast<std::size_t>(kind)];
}

bool is_sealed(const ZoneMesh& mesh, SideId side) {
  return mesh.has_zones(side) && mesh.is_sealed(mesh.first_zone(triangle_of(side), is_front(side)));
}

bool emits(const Scene& scene, const ZoneMesh& mesh, SideId side) {
  const Surface& surface = scene.surfaces[mesh.triangle(triangle_of(side)).surface.index()];
  const Material& material = scene.material_of(surface);
  return material.emits() && (is_front(side) || material.emits_both_sides);
}

std::vector<SideKind> kinds_of_sides(const Scene& scene, const MeshResult& meshed) {
  const ZoneMesh& mesh = meshed.mesh;
  std::vector<SideKind> kinds(mesh.side_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    SideKind of_face = SideKind::kUntouched;
    for (const bool front : {true, false}) {
      const SideId side = side_of(TriangleId(t), front);
      // The number of the face of a curved triangle is that of a shape.
      if (!mesh.triangle(TriangleId(t)).is_curved() && (front || mesh.is_back_to_back(TriangleId(t))))
        of_face = kind_of(mesh.face(TriangleId(t), front), meshed.report.changes);
      SideKind& kind = kinds[side.index()] = of_face;
      if (is_sealed(mesh, side)) kind = std::min(kind, SideKind::kSealed);
      if (emits(scene, mesh, side)) kind = std::min(kind, SideKind::kLuminaire);
    }
  }
  return kinds;
}

std::vector<SideKindSum> sum_sides(const ZoneMesh& mesh, std::span<const SideKind> kinds) {
  std::array<SideKindSum, kSideKindCount> sums;
  for (std::size_t s = 0; s < kinds.size(); ++s) {
    if (!mesh.has_zones(SideId(s))) continue;
    SideKindSum& sum = sums[static_cast<std::size_t>(kinds[s])];
    sum.kind = kinds[s];
    ++sum.sides;
    sum.area += mesh.triangle_area(triangle_of(SideId(s)));
  }
  std::vector<SideKindSum> result;
  for (const SideKindSum& sum : sums)
    if (sum.sides > 0) result.push_back(sum);
  return result;
}

}  // namespace reemit
