#include "mesh/box_pairs.h"

#include <algorithm>
#include <utility>

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

namespace reemit {
namespace {

using CgalBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

std::vector<CgalBox> to_cgal(const std::vector<IndexedBox>& boxes) {
  std::vector<CgalBox> out;
  out.reserve(boxes.size());
  for (const IndexedBox& b : boxes) {
    double low[3] = {b.min.x(), b.min.y(), b.min.z()};
    double high[3] = {b.max.x(), b.max.y(), b.max.z()};
    out.emplace_back(low, high, b.index);
  }
  return out;
}

// CGAL's order depends on its random streaming; sorting makes ours depend on the input alone.
void report(Pairs& pairs, const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [i, j] : pairs) visit(i, j);
}

}  // namespace

void for_each_box_pair(const std::vector<IndexedBox>& boxes,
                       const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
  std::vector<CgalBox> cgal = to_cgal(boxes);
  Pairs pairs;
  CGAL::box_self_intersection_d(cgal.begin(), cgal.end(), [&](const CgalBox& a, const CgalBox& b) {
    pairs.push_back(std::minmax(a.info(), b.info()));
  });
  report(pairs, visit);
}

void for_each_box_pair(const std::vector<IndexedBox>& a, const std::vector<IndexedBox>& b,
                       const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
  std::vector<CgalBox> cgal_a = to_cgal(a);
  std::vector<CgalBox> cgal_b = to_cgal(b);
  Pairs pairs;
  CGAL::box_intersection_d(
      cgal_a.begin(), cgal_a.end(), cgal_b.begin(), cgal_b.end(),
      [&](const CgalBox& x, const CgalBox& y) { pairs.emplace_back(x.info(), y.info()); });
  report(pairs, visit);
}

}  // namespace reemit
