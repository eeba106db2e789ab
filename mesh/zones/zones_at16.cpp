#include <algorithm>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/instruction_sets.h"

namespace reemit {
namespace {

/// All ones or no bits. Choices by such masks, unlike those between loads, are never turned into branches.
inline std::uint32_t mask_of(bool condition) {
  return 0U - static_cast<std::uint32_t>(condition);
}

}  // namespace

// As zone_at, lane by lane, but all lanes go down the cells that are cut further together: which cells these
// are nothing could predict, so a loop for each lane would end in a branch mispredicted.
REEMIT_FOR_INSTRUCTION_SETS
void ZoneMesh::zones_at16(const TrianglePoints16& __restrict points, std::uint32_t* __restrict zone) const {
  static_assert(sizeof(ZoneId) == sizeof(std::uint32_t));
  if (sides_.empty()) {
    std::fill(zone, zone + 16, kNone);
    return;
  }
  const Side* __restrict const sides = sides_.data();
  const Node* __restrict const nodes = nodes_.data();  // one at least
  // As bytes: loops over bool stay scalar.
  const auto* __restrict const front = reinterpret_cast<const unsigned char*>(points.front);
  alignas(64) std::uint32_t is_back[16];
  for (int lane = 0; lane < 16; ++lane) is_back[lane] = front[lane] ^ 1U;
  alignas(64) std::uint32_t first[16];
  alignas(64) std::uint32_t at[16];
  alignas(64) std::uint32_t cut[16];
  alignas(64) float a[16];
  alignas(64) float b[16];
  std::uint32_t any_cut = 0;
  for (int lane = 0; lane < 16; ++lane) {
    const std::uint32_t t = points.triangle[lane];
    const std::uint32_t is_none = mask_of(t == kNone);
    const std::uint32_t side = (2 * t + is_back[lane]) & ~is_none;
    const auto first_zone = static_cast<std::uint32_t>(sides[side].first_zone.index());
    const auto n = static_cast<std::int32_t>(sides[side].divisions);
    const std::uint32_t start = sides[side].nodes;
    // The place of place_in_triangle and its number.
    const float un = points.u[lane] * static_cast<float>(n);
    const float vn = points.v[lane] * static_cast<float>(n);
    auto i = static_cast<std::int32_t>(un);
    i = i > n - 1 ? n - 1 : i;
    i = i < 0 ? 0 : i;
    auto j = static_cast<std::int32_t>(vn);
    j = j > n - 1 - i ? n - 1 - i : j;
    j = j < 0 ? 0 : j;
    const float in_u = un - static_cast<float>(i);
    const float in_v = vn - static_cast<float>(j);
    const bool upper = (in_u + in_v > 1.0F) & (j < n - 1 - i);
    const auto row = static_cast<std::uint32_t>(i);
    const std::uint32_t number =
        2 * sides[side].divisions * row - row * row + 2 * static_cast<std::uint32_t>(j) + (upper ? 1U : 0U);
    const std::uint32_t is_whole = mask_of(start == kWhole);
    const std::uint32_t node = (start + number) & ~is_whole;
    const std::uint32_t node_at = nodes[node].at;
    const std::uint32_t node_cut = nodes[node].cut;
    first[lane] = first_zone | is_none;
    at[lane] = (number & is_whole) | (node_at & ~is_whole);
    cut[lane] = node_cut & ~is_whole;
    a[lane] = upper ? 1 - in_u : in_u;
    b[lane] = upper ? 1 - in_v : in_v;
    any_cut |= cut[lane];
  }
  while (any_cut != 0) {
    any_cut = 0;
    for (int lane = 0; lane < 16; ++lane) {
      InCell x{a[lane], b[lane]};
      const std::uint32_t half = half_of(x, cut[lane] - 1);
      const std::uint32_t goes_on = mask_of(cut[lane] != CellSplits::kNotCut);
      const std::uint32_t node = (at[lane] + half) & goes_on;
      const std::uint32_t node_at = nodes[node].at;
      const std::uint32_t node_cut = nodes[node].cut;
      at[lane] = (node_at & goes_on) | (at[lane] & ~goes_on);
      cut[lane] = node_cut & goes_on;
      a[lane] = x.a;
      b[lane] = x.b;
      any_cut |= cut[lane];
    }
  }
  for (int lane = 0; lane < 16; ++lane) zone[lane] = first[lane] == kNone ? kNone : first[lane] + at[lane];
}

}  // namespace reemit
