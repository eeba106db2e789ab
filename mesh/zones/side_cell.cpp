#include "mesh/zones/side_cell.h"

namespace reemit {

SidePoint cell_point(const SideCell& cell, float a, float b) {
  const auto corner = cell.corners.corners();
  const auto inside = [&](double Barycentric::*k) {
    return (1 - a - b) * corner[0].*k + a * corner[1].*k + b * corner[2].*k;
  };
  return {cell.triangle, {inside(&Barycentric::u), inside(&Barycentric::v)}, cell.front};
}

}  // namespace reemit
