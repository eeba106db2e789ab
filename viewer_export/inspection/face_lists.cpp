#include "viewer_export/inspection/face_lists.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "mesh/pieces/face_notes.h"
#include "viewer_export/inspection/side_kinds.h"

namespace reemit {
namespace {

struct Kind {
  const char* key;
  const char* description;
};

// In the order of FaceChange.
constexpr std::array kKinds = {
    Kind{"flipped", "turned round: their closed shell shows that their winding is wrong"},
    Kind{"covered", "overlapping: lost a part, or all, to a face of their plane"},
    Kind{"covers", "overlapping: kept what another face of their plane lost"},
    Kind{"duplicate", "left out: there twice"},
    Kind{"degenerate", "left out, or a part of them: no area, or thinner than what is welded"},
    Kind{"nonplanar", "repaired: not planar, split into triangles"},
    Kind{"crossed", "repaired: an outline or holes that cross, filled"},
    Kind{"welded", "repaired: a corner moved onto another, or twice in the outline"},
    Kind{"faceted", "flat instead of round: made of round shapes that other faces pass through"},
    Kind{"cut", "cut along the contact with others"},
    Kind{"back_to_back", "back to back with another face, which has the other side"},
};
constexpr Kind kSealed = {"sealed", "sealed: no light reaches one of their sides"};

void add(FaceList& list, const FaceRef& face) {
  ++list.count;
  if (list.first.size() < FaceList::kMostNamed) list.first.push_back(face);
}

/// Of those that round shapes became, which are hundreds for each, one of a surface is enough to be named.
void add_faceted(FaceList& list, const FaceRef& face) {
  if (!list.first.empty() && list.first.back().surface == face.surface)
    ++list.count;
  else
    add(list, face);
}

FaceList list_sealed(const ZoneMesh& mesh) {
  std::vector<FaceRef> faces;
  for (std::size_t s = 0; s < mesh.side_count(); ++s) {
    if (!is_sealed(mesh, SideId(s))) continue;
    const TriangleId t = triangle_of(SideId(s));
    const SurfaceFace face = mesh.face(t, is_front(SideId(s)));
    faces.push_back({face.surface, face.face, mesh.triangle(t).is_curved()});
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  FaceList list{kSealed.key, kSealed.description, 0, {}};
  for (const FaceRef& face : faces) add(list, face);
  return list;
}

std::string name_of(const Scene& scene, const FaceRef& face) {
  const Surface& surface = scene.surfaces[face.surface.index()];
  if (!face.is_shape && face.number < surface.faces.size())
    return face_name(scene, face.surface, face.number);
  const std::string& source = source_of(scene, face);
  const std::string what = face.is_shape ? fmt::format("shape {}", face.number) : "its round shapes";
  return fmt::format("'{}' ({}{}{})", surface.name, source, source.empty() ? "" : ", ", what);
}

}  // namespace

std::vector<FaceList> list_faces(const MeshResult& meshed) {
  std::vector<FaceList> lists;
  for (const Kind& kind : kKinds) lists.push_back({kind.key, kind.description, 0, {}});
  for (const ChangedFace& change : meshed.report.changes)
    (change.change == FaceChange::kFaceted ? add_faceted : add)(
        lists[static_cast<std::size_t>(change.change)], {change.surface, change.face});
  lists.push_back(list_sealed(meshed.mesh));
  std::erase_if(lists, [](const FaceList& list) { return list.count == 0; });
  return lists;
}

std::string names_of(const Scene& scene, const FaceList& list) {
  std::string text;
  for (const FaceRef& face : list.first) text += (text.empty() ? "" : ", ") + name_of(scene, face);
  if (list.count > list.first.size()) text += fmt::format(" and {} more", list.count - list.first.size());
  return text;
}

std::uint32_t source_line(const Scene& scene, const FaceRef& face) {
  const Surface& surface = scene.surfaces[face.surface.index()];
  return face.is_shape || face.number >= surface.faces.size() ? 0 : surface.faces[face.number].source_line;
}

const std::string& source_of(const Scene& scene, const FaceRef& face) {
  const std::string& source = scene.surfaces[face.surface.index()].source;
  return source.empty() ? scene.source : source;
}

}  // namespace reemit
