#include "mesh/repair/duplicate_faces.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <boost/container_hash/hash.hpp>
#include <fmt/format.h>

#include "mesh/pieces/back_to_back.h"
#include "mesh/pieces/face_notes.h"

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

// By piece, the first one with the same corners, which mostly is the piece itself. Only what looks alike by a
// number is compared, so that next to nothing is kept of millions of faces.
std::vector<std::uint32_t> first_alike(const std::vector<FacePiece>& pieces) {
  std::vector<std::pair<std::size_t, std::uint32_t>> order;  // hash and piece
  order.reserve(pieces.size());
  for (std::uint32_t i = 0; i < pieces.size(); ++i)
    order.emplace_back(boost::hash<std::vector<Loop>>()(outline_of(pieces[i]).loops), i);
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> first(pieces.size());
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::find_if(begin, order.end(), [&](const auto& x) { return x.first != begin->first; });
    std::vector<std::pair<std::uint32_t, std::vector<Loop>>> different;
    for (auto it = begin; it != end; ++it) {
      first[it->second] = it->second;
      if (end - begin == 1) break;
      std::vector<Loop> loops = outline_of(pieces[it->second]).loops;
      const auto known =
          std::find_if(different.begin(), different.end(), [&](const auto& x) { return x.second == loops; });
      if (known != different.end())
        first[it->second] = known->first;
      else
        different.emplace_back(it->second, std::move(loops));
    }
    begin = end;
  }
  return first;
}

}  // namespace

void drop_duplicate_faces(const Scene& scene, std::vector<FacePiece>& pieces, MeshReport& report) {
  const std::vector<std::uint32_t> first_of = first_alike(pieces);
  std::unordered_map<std::size_t, std::size_t>
      kept;  // by first piece with the same corners, where it is another
  std::vector<bool> dropped(pieces.size(), false);
  const auto material = [&](std::size_t i) { return scene.surfaces[pieces[i].surface.index()].material; };
  FaceNotes notes;
  double area = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (first_of[i] == i) continue;
    const std::size_t first = kept.try_emplace(first_of[i], first_of[i]).first->second;
    const bool opposite = outline_of(pieces[i]).reversed != outline_of(pieces[first]).reversed;
    if (material(i) != material(first) && may_be_back_to_back(scene, pieces[i], pieces[first])) continue;
    const bool replace = pieces[i].emits && !pieces[first].emits;
    const std::size_t loser = replace ? first : i;
    const std::size_t winner = replace ? i : first;
    if (replace) kept[first_of[i]] = i;
    if (opposite && material(i) == material(first) && !pieces[i].emits) pieces[winner].two_sided = true;
    dropped[loser] = true;
    ++report.duplicate_faces;
    report.surfaces[pieces[loser].surface.index()].removed += pieces[loser].area;
    area += pieces[loser].area;
    notes.add(scene, pieces[loser].surface, pieces[loser].face);
    report.changes.push_back({pieces[loser].surface, pieces[loser].face, FaceChange::kDuplicate});
    report.changes.push_back({pieces[winner].surface, pieces[winner].face, FaceChange::kCovers});
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
