#pragma once
#include <bit>
#include <string>
#include <type_traits>
#include <vector>

#include "viewer_export/output/tone_map.h"
#include "viewer_export/vertex/vertex_data.h"

namespace reemit {

static_assert(std::endian::native == std::endian::little,
              "the binary writers copy values as they lie in memory");

/// Appends the bytes of a number in little-endian order.
template <class T>
void append_bytes(std::string& out, T value) {
  static_assert(std::is_arithmetic_v<T>);
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Radiance in linear Rec.709 at every vertex, 3 values each [W/(m2 sr)], and the tone map of the data.
struct VertexColours {
  std::vector<float> rgb;
  ToneMap tone_map;

  Eigen::Array3d displayable(std::size_t vertex) const {  ///< Linear [0,1].
    return tone_map(Eigen::Array3d(rgb[3 * vertex], rgb[3 * vertex + 1], rgb[3 * vertex + 2]));
  }
};
/// Pre: the data has its tone map.
VertexColours colours_of(const VertexData& data);

/// How far the backs of two-sided surfaces are moved off their fronts in files made for viewing, at most [m]:
/// 1/20,000 of the room's diagonal; 0 if there are no backs. Front and back would lie in one place, and a
/// program that draws both sides of every triangle, or traces rays, would show now one and now the other.
double back_gap(const VertexData& data);
/// The same for a room with backs and this diagonal [m].
double back_gap(double diagonal);
/// Positions for viewing [m]: fronts as they are, backs moved along their normals by `gap`, but by no more
/// than 1/1,000 of the diagonal of their surface: a room in a wide garden must not lose what hangs before its
/// walls.
std::vector<Vec3> positions_for_viewing(const VertexData& data, double gap);

/// Origin for positions in single precision [m]: 0, or the centre of a room so far from 0 that float
/// coordinates would lose more than a millionth of its size.
Vec3 single_precision_origin(const VertexData& data);
/// The same for a room with these smallest and largest coordinates [m].
Vec3 single_precision_origin(const Vec3& low, const Vec3& high);

}  // namespace reemit
