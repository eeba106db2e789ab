#pragma once
#include <cstdint>
#include <vector>

#include "solver/sky/sky_entry.h"

namespace reemit {

/// Light that was found useful: numbers of a packet that would bring it, and how much it is worth.
struct UsefulLight {
  SkyEntry::Numbers u;
  float worth;
};

/// A box of the numbers of packets, whose packets share its power evenly.
struct NumberCell {
  SkyEntry::Numbers low{0, 0, 0, 0};
  SkyEntry::Numbers size{1, 1, 1, 1};
  double worth = 0;

  double volume() const { return size[0] * size[1] * size[2] * size[3]; }
  SkyEntry::Numbers at(const SkyEntry::Numbers& u) const {
    return {low[0] + u[0] * size[0], low[1] + u[1] * size[1], low[2] + u[2] * size[2],
            low[3] + u[3] * size[3]};
  }
};

/// Halves the unit box again and again where the useful light lies unevenly, until a cell has no more than
/// `worth_of_cell` of it. Reorders `light`.
std::vector<NumberCell> divide_numbers(std::vector<UsefulLight>& light, double worth_of_cell);

}  // namespace reemit
