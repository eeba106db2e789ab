#include "solver/sky/sky_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "solver/sky/sky_table.h"

namespace reemit {
namespace {

using std::numbers::pi;
/// Of what a direction has learnt, each of its four neighbours gets so much, twice over: rays were few, and a
/// direction in which light comes that none of them met would be drawn too seldom and count too much.
constexpr float kToNeighbours = 0.12F;
constexpr int kViewRounds = 2;
/// Points are looked up so far in front of their surface [normalised]: rays start a little before it, and a
/// ceiling may lie where two cells meet. No round number, for rooms have those.
constexpr float kBefore = 0.0041F;

/// One round of it; at the poles nothing is lost.
void share_with_neighbours(const std::vector<float>& from, std::vector<float>& to) {
  constexpr std::size_t kAcross = SkyView::kColumns;
  for (std::size_t d = 0; d < SkyView::kDirections; ++d) {
    const std::size_t row = d / kAcross;
    const std::size_t column = d % kAcross;
    const float beside = from[row * kAcross + (column + 1) % kAcross] +
                         from[row * kAcross + (column + kAcross - 1) % kAcross] +
                         (row > 0 ? from[d - kAcross] : from[d]) +
                         (row + 1 < SkyView::kRows ? from[d + kAcross] : from[d]);
    to[d] = (1 - 4 * kToNeighbours) * from[d] + kToNeighbours * beside;
  }
}

}  // namespace

double SkyView::solid_angle() {
  return 4 * pi / static_cast<double>(kDirections);
}

std::size_t SkyView::key_of(const Vec3f& x, const Vec3f& normal) {
  std::size_t key = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const float scaled = 0.5F * (x[k] + kBefore * normal[k] + 1) * static_cast<float>(kCells);
    key = key * kCells + static_cast<std::size_t>(std::clamp(scaled, 0.0F, static_cast<float>(kCells) - 1));
  }
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 6 * key + 2 * static_cast<std::size_t>(axis) + (normal[axis] < 0 ? 1 : 0);
}

std::size_t SkyView::direction_of(const Vec3& local) {
  const double row = 0.5 * (1 - local.z()) * static_cast<double>(kRows);
  const double column = (std::atan2(local.y(), local.x()) + pi) / (2 * pi) * static_cast<double>(kColumns);
  return std::min(static_cast<std::size_t>(std::max(0.0, row)), kRows - 1) * kColumns +
         std::min(static_cast<std::size_t>(std::max(0.0, column)), kColumns - 1);
}

std::uint32_t SkyView::add_place(const Vec3f& x, const Vec3f& normal) {
  std::uint32_t& place = places_[key_of(x, normal)];
  if (place == kUnknown) {
    place = static_cast<std::uint32_t>(rays_.size());
    rays_.push_back(0);
    escaped_.push_back(0);
    until_.resize(until_.size() + kDirections + 1, 0.0F);
  }
  return place;
}

void SkyView::add_escape(std::uint32_t place, const Vec3& local, float brightness) {
  ++escaped_[place];
  until_[place * (kDirections + 1) + 1 + direction_of(local)] += brightness;
}

void SkyView::take_over_from_neighbours() {
  const std::vector<std::uint32_t> known = places_;
  for (std::size_t key = 0; key < places_.size(); ++key) {
    if (known[key] != kUnknown) continue;
    std::size_t stride = 6;
    for (int k = 0; k < 3; ++k, stride *= kCells) {
      const std::size_t at = key / stride % kCells;
      if (at > 0 && known[key - stride] != kUnknown) places_[key] = known[key - stride];
      if (at + 1 < kCells && known[key + stride] != kUnknown) places_[key] = known[key + stride];
    }
  }
}

void SkyView::finish() {
  take_over_from_neighbours();
  std::vector<float> learnt(kDirections);
  std::vector<float> shared(kDirections);
  for (std::size_t place = 0; place < rays_.size(); ++place) {
    float* until = &until_[place * (kDirections + 1)];
    std::copy_n(until + 1, kDirections, learnt.begin());
    for (int round = 0; round < kViewRounds; ++round) {
      share_with_neighbours(learnt, shared);
      std::swap(learnt, shared);
    }
    double running = 0;
    for (std::size_t d = 0; d < kDirections; ++d) {
      running += static_cast<double>(learnt[d]);
      until[d + 1] = static_cast<float>(running);
    }
    if (!(running > 0)) {
      escaped_[place] = 0;  // nothing but darkness was seen
      continue;
    }
    for (std::size_t d = 0; d <= kDirections; ++d)
      until[d] = static_cast<float>(static_cast<double>(until[d]) / running);
    until[kDirections] = 1;
  }
}

Vec3 SkyView::sample(std::uint32_t place, double u0, double u1) const {
  double inside = 0;
  const std::size_t d = find_interval(&until_[place * (kDirections + 1)], kDirections, u0, inside);
  const std::size_t row = d / kColumns;
  const double z = 1 - 2 * (static_cast<double>(row) + inside) / static_cast<double>(kRows);
  const double azimuth =
      2 * pi * (static_cast<double>(d % kColumns) + u1) / static_cast<double>(kColumns) - pi;
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

double SkyView::pdf_per_sr(std::uint32_t place, const Vec3& local) const {
  const float* until = &until_[place * (kDirections + 1)];
  const std::size_t d = direction_of(local);
  return static_cast<double>(until[d + 1] - until[d]) / solid_angle();
}

}  // namespace reemit
