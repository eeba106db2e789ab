#include "mesh/repair/orientation.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "mesh/pieces/face_notes.h"

namespace reemit {
namespace {

template <class Visit>
void for_each_edge(const FacePiece& piece, Visit visit) {
  for (const Loop& loop : piece.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) visit(loop[i], loop[(i + 1) % loop.size()]);
}

struct EdgeUse {
  std::uint32_t to;  // the larger vertex
  std::uint32_t piece;
  bool forward;  // runs from the smaller to the larger vertex
};

// Edges of the pieces of one material, by their smaller vertex.
class EdgeUses {
 public:
  // `number` holds kNone for all vertices, and does so again when the object goes.
  EdgeUses(const std::vector<FacePiece>& pieces, const std::vector<std::size_t>& group,
           std::vector<std::uint32_t>& number)
      : number_(number) {
    const auto number_of = [&](std::uint32_t v) {
      if (number_[v] == kNone) {
        number_[v] = static_cast<std::uint32_t>(numbered_.size());
        numbered_.push_back(v);
        first_.push_back(0);
      }
      return number_[v];
    };
    first_.push_back(0);
    for (const std::size_t i : group)
      for_each_edge(pieces[i],
                    [&](std::uint32_t a, std::uint32_t b) { ++first_[number_of(std::min(a, b)) + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    uses_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const std::size_t i : group)
      for_each_edge(pieces[i], [&](std::uint32_t a, std::uint32_t b) {
        uses_[next[number_of(std::min(a, b))]++] = {std::max(a, b), static_cast<std::uint32_t>(i), a < b};
      });
    for (std::size_t v = 0; v < numbered_.size(); ++v)
      std::stable_sort(begin_of(v), begin_of(v + 1),
                       [](const EdgeUse& x, const EdgeUse& y) { return x.to < y.to; });
  }
  ~EdgeUses() {
    for (const std::uint32_t v : numbered_) number_[v] = kNone;
  }
  EdgeUses(const EdgeUses&) = delete;
  EdgeUses& operator=(const EdgeUses&) = delete;

  // Of an edge that some piece has.
  std::span<const EdgeUse> of(std::uint32_t a, std::uint32_t b) const {
    const auto [from, to] = std::minmax(a, b);
    const std::size_t v = number_[from];
    const auto uses = std::span(uses_).subspan(first_[v], first_[v + 1] - first_[v]);
    return {std::ranges::lower_bound(uses, to, {}, &EdgeUse::to),
            std::ranges::upper_bound(uses, to, {}, &EdgeUse::to)};
  }

  static constexpr std::uint32_t kNone = 0xffffffff;

 private:
  std::vector<EdgeUse>::iterator begin_of(std::size_t v) {
    return uses_.begin() + static_cast<std::ptrdiff_t>(first_[v]);
  }

  std::vector<std::uint32_t>& number_;   // by vertex, its place in numbered_
  std::vector<std::uint32_t> numbered_;  // the vertices of these pieces
  std::vector<std::size_t> first_;       // of uses_, by place in numbered_, and one past the last
  std::vector<EdgeUse> uses_;
};

struct Shell {
  std::vector<std::size_t> pieces;
  std::vector<bool> turned;  // against the first piece
  bool closed = true;
  bool orientable = true;
};

class Orientation {
 public:
  Orientation(const Scene& scene, const VertexTable& vertices, std::vector<FacePiece>& pieces,
              MeshReport& report)
      : scene_(scene),
        vertices_(vertices),
        pieces_(pieces),
        report_(report),
        in_shell_(pieces.size(), false),
        turned_(pieces.size(), false),
        flipped_(pieces.size(), false),
        number_(vertices.size(), EdgeUses::kNone) {}

  void run() {
    std::vector<std::vector<std::size_t>> by_material(scene_.materials.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      by_material[scene_.surfaces[pieces_[i].surface.index()].material.index()].push_back(i);
    for (const std::vector<std::size_t>& group : by_material) orient_group(group);
    warn();
  }

 private:
  void orient_group(const std::vector<std::size_t>& group) {
    const EdgeUses edges(pieces_, group, number_);
    for (const std::size_t i : group) {
      if (in_shell_[i]) continue;
      const Shell shell = collect_shell(i, edges);
      if (!shell.closed || !shell.orientable) continue;
      for (const std::size_t k : shell.pieces) pieces_[k].in_closed_shell = true;
      make_consistent(shell);
      turn_lamp_outwards(shell);
      if (signed_volume(shell) > 0)
        for (const std::size_t k : shell.pieces) pieces_[k].outside_of_solid = true;
    }
  }

  Shell collect_shell(std::size_t start, const EdgeUses& edges) {
    Shell shell;
    std::vector<std::size_t> stack{start};
    in_shell_[start] = true;
    while (!stack.empty()) {
      const std::size_t i = stack.back();
      stack.pop_back();
      const bool turned_i = turned_[i];
      shell.pieces.push_back(i);
      shell.turned.push_back(turned_i);
      for_each_edge(pieces_[i], [&](std::uint32_t a, std::uint32_t b) {
        const std::span<const EdgeUse> uses = edges.of(a, b);
        if (uses.size() != 2) {
          shell.closed = false;
          return;
        }
        const EdgeUse& other = uses[0].piece == i ? uses[1] : uses[0];
        if (other.piece == i) return;  // a seam
        const bool turned_other = turned_i != (other.forward == (a < b));
        if (!in_shell_[other.piece]) {
          in_shell_[other.piece] = true;
          turned_[other.piece] = turned_other;
          stack.push_back(other.piece);
        } else if (turned_[other.piece] != turned_other) {
          shell.orientable = false;
        }
      });
    }
    return shell;
  }

  void flip(std::size_t i) {
    pieces_[i].flip();
    flipped_[i] = !flipped_[i];
  }

  void make_consistent(const Shell& shell) {
    double area[2] = {0, 0};
    for (std::size_t k = 0; k < shell.pieces.size(); ++k)
      area[shell.turned[k] ? 1 : 0] += pieces_[shell.pieces[k]].area;
    const bool minority = area[1] <= area[0];
    for (std::size_t k = 0; k < shell.pieces.size(); ++k)
      if (shell.turned[k] == minority) flip(shell.pieces[k]);
  }

  double signed_volume(const Shell& shell) const {
    const Vec3& origin = vertices_[pieces_[shell.pieces[0]].loops[0][0]];
    double volume = 0;
    for (const std::size_t i : shell.pieces)
      volume += (pieces_[i].plane.origin - origin).dot(pieces_[i].plane.normal) * pieces_[i].area / 3;
    return volume;
  }

  void turn_lamp_outwards(const Shell& shell) {
    const FacePiece& first = pieces_[shell.pieces[0]];
    if (!first.emits || first.two_sided || signed_volume(shell) >= 0) return;
    Eigen::AlignedBox3d box;
    std::vector<bool> own(pieces_.size(), false);
    for (const std::size_t i : shell.pieces) {
      own[i] = true;
      for (const std::uint32_t v : pieces_[i].loops[0]) box.extend(vertices_[v]);
    }
    bool others_elsewhere = false;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (own[i]) continue;
      for (const std::uint32_t v : pieces_[i].loops[0]) {
        if (box.contains(vertices_[v])) return;
        others_elsewhere = true;
      }
    }
    for (const Surface& surface : scene_.surfaces)
      for (const CurvedShape& shape : surface.shapes) {
        const auto [low, high] = shape_bounds(shape);
        const Eigen::AlignedBox3d of_shape(low, high);
        if (box.intersects(of_shape) && !of_shape.contains(box)) return;
        others_elsewhere = true;
      }
    const auto is_light_inside = [&](const PunctualLight& light) {
      return std::visit(
          [&](const auto& l) {
            if constexpr (requires { l.position; }) return box.contains(l.position);
            return false;
          },
          light);
    };
    const auto is_eye_inside = [&](const Camera& camera) { return box.contains(camera.eye); };
    if (std::any_of(scene_.lights.begin(), scene_.lights.end(), is_light_inside) ||
        std::any_of(scene_.cameras.begin(), scene_.cameras.end(), is_eye_inside))
      return;
    if (!others_elsewhere) return;  // the shell is the whole room
    for (const std::size_t i : shell.pieces) flip(i);
  }

  void warn() {
    FaceNotes notes;
    double total = 0;
    double flipped_area = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const FacePiece& piece = pieces_[i];
      total += piece.area;
      if (!flipped_[i]) continue;
      notes.add(scene_, piece.surface, piece.face);
      report_.changes.push_back({piece.surface, piece.face, FaceChange::kFlipped});
      flipped_area += piece.area;
    }
    report_.flipped_faces = notes.count();
    if (notes.count() == 0) return;
    report_.warnings.push_back(fmt::format(
        "{} faces ({:.3g} % of the area) were turned round because their closed shell shows that their "
        "winding is wrong: {}",
        notes.count(), 100 * flipped_area / total, notes.names()));
  }

  const Scene& scene_;
  const VertexTable& vertices_;
  std::vector<FacePiece>& pieces_;
  MeshReport& report_;
  std::vector<bool> in_shell_;
  std::vector<bool> turned_;           // by piece in a shell, against the first of the shell
  std::vector<bool> flipped_;          // by piece: it faces the other way than as read
  std::vector<std::uint32_t> number_;  // for EdgeUses
};

}  // namespace

void orient_faces(const Scene& scene, const VertexTable& vertices, std::vector<FacePiece>& pieces,
                  MeshReport& report) {
  Orientation(scene, vertices, pieces, report).run();
}

}  // namespace reemit
