#include "mesh/pieces/face_notes.h"

#include <fmt/format.h>

namespace reemit {

std::string face_name(const Scene& scene, SurfaceId surface, std::uint32_t face) {
  const Surface& s = scene.surfaces[surface.index()];
  std::string where = s.source.empty() ? scene.source : s.source;
  if (face < s.faces.size() && s.faces[face].source_line > 0)
    where += fmt::format(":{}", s.faces[face].source_line);
  return fmt::format("'{}' ({}{}face {})", s.name, where, where.empty() ? "" : ", ", face);
}

void FaceNotes::add(const Scene& scene, SurfaceId surface, std::uint32_t face) {
  constexpr std::size_t kNamed = 3;
  ++count_;
  if (first_.size() < kNamed) first_.push_back(face_name(scene, surface, face));
}

std::string FaceNotes::names() const {
  std::string text = fmt::format("{}", fmt::join(first_, ", "));
  if (count_ > first_.size()) text += fmt::format(" and {} more", count_ - first_.size());
  return text;
}

}  // namespace reemit
