#include "mesh/duplicate_faces.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "mesh/face_notes.h"

namespace reemit {
namespace {

// The loop from its smallest vertex on, in the sense in which its second vertex is smaller than its last.
Loop canonical(const Loop& loop, bool& reversed) {
  const auto smallest = std::min_element(loop.begin(), loop.end());
  Loop forward(loop);
  std::rotate(forward.begin(), forward.begin() + (smallest - loop.begin()), forward.end());
  Loop backward(forward);
  std::reverse(backward.begin() + 1, backward.end());
  reversed = backward < forward;
  return reversed ? backward : forward;
}

struct Outline {
  std::vector<Loop> loops;
  bool reversed = false;  // of the outline against its canonical sense
};

Outline outline_of(const FacePiece& piece) {
  Outline out;
  out.loops.push_back(canonical(piece.loops[0], out.reversed));
  for (std::size_t i = 1; i < piece.loops.size(); ++i) {
    bool unused = false;
    out.loops.push_back(canonical(piece.loops[i], unused));
  }
  std::sort(out.loops.begin() + 1, out.loops.end());
  return out;
}

}  // namespace

void drop_duplicate_faces(const Scene& scene, std::vector<FacePiece>& pieces, MeshReport& report) {
  struct Kept {
    std::size_t piece;
    bool reversed;
  };
  std::map<std::vector<Loop>, Kept> seen;
  std::vector<bool> dropped(pieces.size(), false);
  const auto material = [&](std::size_t i) { return scene.surfaces[pieces[i].surface.index()].material; };
  FaceNotes notes;
  double area = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Outline outline = outline_of(pieces[i]);
    const auto [it, is_new] = seen.try_emplace(std::move(outline.loops), Kept{i, outline.reversed});
    if (is_new) continue;
    const std::size_t first = it->second.piece;
    const bool opposite = outline.reversed != it->second.reversed;
    const bool replace = pieces[i].emits && !pieces[first].emits;
    const std::size_t loser = replace ? first : i;
    const std::size_t winner = replace ? i : first;
    if (replace) it->second = {i, outline.reversed};
    if (opposite && material(i) == material(first) && !pieces[i].emits) pieces[winner].two_sided = true;
    dropped[loser] = true;
    ++report.duplicate_faces;
    report.surfaces[pieces[loser].surface.index()].removed += pieces[loser].area;
    area += pieces[loser].area;
    notes.add(scene, pieces[loser].surface, pieces[loser].face);
  }
  if (notes.count() == 0) return;
  std::size_t write = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (dropped[i]) continue;
    if (write != i) pieces[write] = std::move(pieces[i]);
    ++write;
  }
  pieces.resize(write);
  report.warnings.push_back(fmt::format("{} faces ({:.4g} m2) are there twice; the copies were left out: {}",
                                        notes.count(), area, notes.names()));
}

}  // namespace reemit
