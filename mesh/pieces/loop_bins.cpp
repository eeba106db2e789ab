#include "mesh/pieces/loop_bins.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reemit {

LoopBins::LoopBins(const std::vector<Vec2>& loop) {
  low_ = std::numeric_limits<double>::infinity();
  double high = -low_;
  double travelled = 0;  // along y
  for (std::size_t i = 0; i < loop.size(); ++i) {
    low_ = std::min(low_, loop[i].y());
    high = std::max(high, loop[i].y());
    travelled += std::abs(loop[(i + 1) % loop.size()].y() - loop[i].y());
  }
  if (high > low_) {
    // An edge is in all strips it runs through: strips this high hold about two entries per edge in all.
    const double most = static_cast<double>(loop.size()) * (high - low_) / travelled;
    bins_ = std::max<std::size_t>(1, static_cast<std::size_t>(most));
    bins_per_metre_ = static_cast<double>(bins_) / (high - low_);
  }
  first_.assign(bins_ + 1, 0);
  const auto for_each_strip = [&](auto visit) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2& a = loop[i];
      const Vec2& b = loop[(i + 1) % loop.size()];
      const std::size_t from = bin_of(std::min(a.y(), b.y()));
      const std::size_t to = bin_of(std::max(a.y(), b.y()));
      for (std::size_t bin = from; bin <= to; ++bin) visit(bin, Edge{a, b});
    }
  };
  for_each_strip([&](std::size_t bin, const Edge&) { ++first_[bin + 1]; });
  for (std::size_t bin = 0; bin < bins_; ++bin) first_[bin + 1] += first_[bin];
  edges_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for_each_strip([&](std::size_t bin, const Edge& edge) { edges_[next[bin]++] = edge; });
}

std::size_t LoopBins::bin_of(double y) const {
  const double bin = (y - low_) * bins_per_metre_;
  return bin > 0 ? std::min(bins_ - 1, static_cast<std::size_t>(bin)) : 0;
}

int LoopBins::winding(const Vec2& p) const {
  const std::size_t bin = bin_of(p.y());
  int winding = 0;
  for (std::uint32_t i = first_[bin]; i < first_[bin + 1]; ++i)
    winding += winding_of_edge(edges_[i].from, edges_[i].to, p);
  return winding;
}

}  // namespace reemit
