#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// What a picture of the mesh shows of a side of a base triangle: the first of these that holds.
/// docs/meshing.md has the legend.
enum class SideKind : std::uint8_t {
  kFlipped,    ///< Of a face that was turned round.
  kSealed,     ///< No light reaches it.
  kCovered,    ///< What is left of a face of which others of its plane took a part.
  kCovers,     ///< Of a face that took a part of another or is kept of two alike.
  kRepaired,   ///< Of a face that is bent, crosses itself or was welded.
  kCut,        ///< Of a face that is cut along contacts.
  kFaceted,    ///< Flat, of a round shape that other faces pass through.
  kLuminaire,  ///< It emits.
  kUntouched,
};
inline constexpr std::size_t kSideKindCount = 9;

/// How a kind is shown.
struct SideKindStyle {
  const char* key;   ///< In JSON.
  const char* name;  ///< Of its object in the picture.
  std::array<std::uint8_t, 3> srgb;

  std::string hex() const;  ///< "#d4148c".
};
/// The same for every picture.
const SideKindStyle& style_of(SideKind kind);

/// By side (mesh/zones/side.h); of sides without zones, which no picture shows, that of their front.
std::vector<SideKind> kinds_of_sides(const Scene& scene, const MeshResult& meshed);

/// A side without light (ZoneMesh::is_sealed of its zones).
bool is_sealed(const ZoneMesh& mesh, SideId side);
/// Whether that side is of a luminaire.
bool emits(const Scene& scene, const ZoneMesh& mesh, SideId side);

/// Of one kind, the sides that have zones.
struct SideKindSum {
  SideKind kind = SideKind::kUntouched;
  std::size_t sides = 0;
  double area = 0;  ///< [m2]
};

/// Of every kind that occurs, in the order of the kinds.
std::vector<SideKindSum> sum_sides(const ZoneMesh& mesh, std::span<const SideKind> kinds);

}  // namespace reemit
