#include "solver/sky/sky_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace reemit {
namespace {

constexpr int kMostHalvings = 24;
/// With fewer samples nothing can be told.
constexpr std::size_t kFewest = 24;

class Divider {
 public:
  explicit Divider(double worth_of_cell) : worth_of_cell_(worth_of_cell) {}

  void divide(const NumberCell& cell, std::span<UsefulLight> light, int halvings) {
    if (cell.worth <= worth_of_cell_ || light.size() < kFewest || halvings == kMostHalvings) {
      cells.push_back(cell);
      return;
    }
    std::size_t best = 0;
    double most = -1;
    for (std::size_t k = 0; k < 4; ++k) {
      const double middle = cell.low[k] + 0.5 * cell.size[k];
      double below = 0;
      for (const UsefulLight& l : light) below += l.u[k] < middle ? static_cast<double>(l.worth) : 0;
      const double uneven = std::abs(below / cell.worth - 0.5);
      if (uneven > most) {
        most = uneven;
        best = k;
      }
    }
    NumberCell low = cell;
    low.size[best] *= 0.5;
    NumberCell high = low;
    high.low[best] += low.size[best];
    const auto middle = std::partition(light.begin(), light.end(),
                                       [&](const UsefulLight& l) { return l.u[best] < high.low[best]; });
    const auto count = static_cast<std::size_t>(middle - light.begin());
    low.worth = 0;
    for (const UsefulLight& l : light.first(count)) low.worth += static_cast<double>(l.worth);
    high.worth = cell.worth - low.worth;
    divide(low, light.first(count), halvings + 1);
    divide(high, light.subspan(count), halvings + 1);
  }

  std::vector<NumberCell> cells;

 private:
  double worth_of_cell_;
};

}  // namespace

std::vector<NumberCell> divide_numbers(std::vector<UsefulLight>& light, double worth_of_cell) {
  NumberCell whole;
  for (const UsefulLight& l : light) whole.worth += static_cast<double>(l.worth);
  Divider divider(worth_of_cell);
  divider.divide(whole, light, 0);
  return std::move(divider.cells);
}

}  // namespace reemit
