#include "solver/sky/sky_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
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
/// What is known of the part of the room around counts as so many rays that met light.
constexpr double kRaysOfAround = 4;
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
  std::size_t cell = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const float scaled = 0.5F * (x[k] + kBefore * normal[k] + 1) * static_cast<float>(kCells);
    cell = cell * kCells + static_cast<std::size_t>(std::clamp(scaled, 0.0F, static_cast<float>(kCells) - 1));
  }
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return kFacings * cell + 2 * static_cast<std::size_t>(axis) + (normal[axis] < 0 ? 1 : 0);
}

Vec3f SkyView::corner_of(std::size_t cell) {
  const auto at = [](std::size_t i) { return 2 * static_cast<float>(i) / static_cast<float>(kCells) - 1; };
  return {at(cell / (kCells * kCells)), at(cell / kCells % kCells), at(cell % kCells)};
}

Vec3f SkyView::normal_of(std::size_t facing) {
  Vec3f normal(0, 0, 0);
  normal[static_cast<Eigen::Index>(facing / 2)] = facing % 2 == 0 ? 1.0F : -1.0F;
  return normal;
}

std::size_t SkyView::part_of(std::size_t key, std::size_t width) {
  std::size_t part = 0;
  for (std::size_t stride = kFacings * kCells * kCells; stride >= kFacings; stride /= kCells)
    part = part * (kCells / width) + key / stride % kCells / width;
  return kFacings * part + key % kFacings;
}

std::size_t SkyView::direction_of(const Vec3& local) {
  const double row = 0.5 * (1 - local.z()) * static_cast<double>(kRows);
  const double column = (std::atan2(local.y(), local.x()) + pi) / (2 * pi) * static_cast<double>(kColumns);
  return std::min(static_cast<std::size_t>(std::max(0.0, row)), kRows - 1) * kColumns +
         std::min(static_cast<std::size_t>(std::max(0.0, column)), kColumns - 1);
}

std::uint32_t SkyView::new_place() {
  rays_.push_back(0);
  escaped_.push_back(0);
  until_.resize(until_.size() + kDirections + 1, 0.0F);
  return static_cast<std::uint32_t>(rays_.size() - 1);
}

std::uint32_t SkyView::add_place(const Vec3f& x, const Vec3f& normal) {
  std::uint32_t& place = places_[key_of(x, normal)];
  if (place == kUnknown) place = new_place();
  return place;
}

void SkyView::add_air() {
  first_of_air_ = static_cast<std::uint32_t>(rays_.size());
  for (std::size_t key = 0; key < places_.size(); ++key) new_place();
}

void SkyView::add_escape(std::uint32_t place, const Vec3& local, float brightness) {
  ++escaped_[place];
  until_[place * (kDirections + 1) + 1 + direction_of(local)] += brightness;
}

void SkyView::add_rays_of(std::uint32_t from, std::uint32_t to) {
  rays_[to] += rays_[from];
  escaped_[to] += escaped_[from];
  for (std::size_t d = 1; d <= kDirections; ++d)
    until_[to * (kDirections + 1) + d] += until_[from * (kDirections + 1) + d];
}

void SkyView::normalise(std::uint32_t place) {
  float* const of_place = &until_[place * (kDirections + 1) + 1];
  std::vector<float> learnt(of_place, of_place + kDirections);
  std::vector<float> shared(kDirections);
  for (int round = 0; round < kViewRounds; ++round) {
    share_with_neighbours(learnt, shared);
    std::swap(learnt, shared);
  }
  const double sum = std::accumulate(learnt.begin(), learnt.end(), 0.0);
  if (!(sum > 0)) escaped_[place] = 0;
  for (std::size_t d = 0; d < kDirections; ++d)
    of_place[d] = sum > 0 ? static_cast<float>(static_cast<double>(learnt[d]) / sum) : 0.0F;
}

void SkyView::mix(std::uint32_t place, std::uint32_t with, double of_own) {
  float* const shares = &until_[place * (kDirections + 1)];
  const float* const others = &until_[with * (kDirections + 1)];
  for (std::size_t d = 1; d <= kDirections; ++d)
    shares[d] = static_cast<float>(of_own * static_cast<double>(shares[d]) +
                                   (1 - of_own) * static_cast<double>(others[d]));
}

void SkyView::complete(std::uint32_t place, std::uint32_t around) {
  const auto own = static_cast<double>(escaped_[place]);
  mix(place, around, own / (own + kRaysOfAround));
}

void SkyView::accumulate(std::uint32_t place) {
  float* const until = &until_[place * (kDirections + 1)];
  double running = 0;
  for (std::size_t d = 1; d <= kDirections; ++d) {
    running += static_cast<double>(until[d]);
    until[d] = static_cast<float>(running);
  }
  until[kDirections] = 1;
}

std::vector<std::uint32_t> SkyView::look_around() {
  const std::uint32_t whole = new_place();
  for (std::uint32_t place = 0; place < first_of_air_; ++place) add_rays_of(place, whole);
  normalise(whole);
  sees_sky_ = escaped_[whole] > 0;
  std::vector<std::uint32_t> around(places_.size(), whole);
  for (std::size_t width = kCells; width > 1; width /= 2) {
    std::vector<std::uint32_t> parts(places_.size(), kUnknown);
    for (std::size_t key = 0; key < places_.size(); ++key) {
      if (places_[key] == kUnknown) continue;
      std::uint32_t& part = parts[part_of(key, width)];
      if (part == kUnknown) part = new_place();
      add_rays_of(places_[key], part);
    }
    std::vector<bool> is_complete(rays_.size(), false);
    for (std::size_t key = 0; key < places_.size(); ++key) {
      const std::uint32_t part = parts[part_of(key, width)];
      if (part == kUnknown) continue;
      if (!is_complete[part]) {
        normalise(part);
        complete(part, around[key]);
        is_complete[part] = true;
      }
      around[key] = part;
    }
  }
  return around;
}

std::uint32_t SkyView::neighbour(std::size_t key) const {
  for (std::size_t stride = kFacings; stride < places_.size(); stride *= kCells) {
    const std::size_t at = key / stride % kCells;
    for (const std::size_t beside : {at > 0 ? key - stride : key, at + 1 < kCells ? key + stride : key})
      if (places_[beside] != kUnknown) return places_[beside];
  }
  return kUnknown;
}

void SkyView::finish() {
  const std::vector<std::uint32_t> around = look_around();
  for (std::size_t key = 0; key < places_.size(); ++key) {
    const std::uint32_t air = place_in_air(key / kFacings, key % kFacings);
    for (const std::uint32_t place : {air, places_[key]}) {
      if (place == kUnknown) continue;
      normalise(place);
      complete(place, around[key]);
    }
  }
  // Corners of faces lie where cells meet: a cell that no ray of a surface started from may hold a bit of
  // one.
  std::vector<std::uint32_t> found = places_;
  for (std::size_t key = 0; key < places_.size(); ++key) {
    if (places_[key] != kUnknown) continue;
    found[key] = place_in_air(key / kFacings, key % kFacings);
    const std::uint32_t beside = neighbour(key);
    if (beside != kUnknown) mix(found[key], beside, 0.5);
  }
  places_ = std::move(found);
  for (std::uint32_t place = 0; place < rays_.size(); ++place) accumulate(place);
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
