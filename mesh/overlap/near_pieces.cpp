#include "mesh/overlap/near_pieces.h"

#include <utility>

#include <fmt/format.h>

#include "mesh/overlap/coplanar_overlap.h"
#include "mesh/pieces/face_notes.h"
#include "scenes/model/error.h"

namespace reemit {

NearPieces::NearPieces(const VertexTable& vertices, const std::vector<FacePiece>& pieces) {
  std::vector<IndexedBox> boxes;
  boxes.reserve(pieces.size());
  first_.reserve(pieces.size() + 1);
  corners_.reserve(3 * pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    boxes.push_back(box_of(vertices, pieces[i], i, 0));
    first_.push_back(corners_.size());
    for (const std::uint32_t v : pieces[i].loops[0]) corners_.push_back(vertices[v]);
  }
  first_.push_back(corners_.size());
  tree_ = BoxTree(std::move(boxes));
}

LookLimit::LookLimit(const Scene& scene, const std::vector<FacePiece>& pieces)
    : scene_(scene), pieces_(pieces) {
  // Furnished rooms need some tens of looks per face; this bounds the time to some tenths of a millisecond
  // each.
  constexpr std::size_t kMostLooks = 10'000'000;
  constexpr std::size_t kMostLooksPerPiece = 1000;
  most_looks_ = kMostLooks + kMostLooksPerPiece * pieces.size();
}

void LookLimit::refuse(std::size_t piece) const {
  throw InputError(
      "face " + face_name(scene_, pieces_[piece].surface, pieces_[piece].face),
      fmt::format("too many faces lie within each other's bounding boxes, here and elsewhere: more "
                  "than {} comparisons for {} faces",
                  most_looks_, pieces_.size()),
      "join thin triangles that meet in one corner to polygons, or leave this object out");
}

}  // namespace reemit
