#include "solver/zoning/cell_looks.h"

#include <algorithm>

namespace reemit {
namespace {

/// Points of a cell: those seen before count among them, but some are new, for by the old ones the cut was
/// chosen that left the cell.
constexpr int kPoints = 8;
constexpr int kNewPoints = 2;
constexpr int kShadowRays = 4;
constexpr int kGatherRays = 8;
/// Weight of the other corners at a corner that is looked at: the light of a vertex at the rim of a surface
/// is that of points about as far inside (VertexSettings::reach).
constexpr float kInside = 1.0F / 32;

using Weights = std::array<float, 3>;

InCell place_of(const Weights& weight) {
  return {weight[1], weight[2]};
}

/// Looks at one place of each number that has none.
template <class Place>
void look_where_missing(const SideCell& cell, PilotLight::Looker& looker, const Place& place,
                        std::array<std::optional<Seen>, 3>& seen) {
  std::vector<SeenPoint> places;
  for (std::size_t k = 0; k < 3; ++k)
    if (!seen[k]) places.push_back({place(k), {}});
  if (places.empty()) return;
  looker.look_at(cell, places, {static_cast<int>(places.size()), kShadowRays, kGatherRays});
  auto next = places.begin();
  for (std::optional<Seen>& s : seen)
    if (!s) s = (next++)->seen;
}

/// The point's difference, look by look, from what these three have there by its weights.
double square_of_difference(const SeenPoint& point, const Weights& weight,
                            const std::array<const Seen*, 3>& corner) {
  double first = -static_cast<double>(point.seen.first_look);
  double second = -static_cast<double>(point.seen.second_look);
  for (std::size_t k = 0; k < 3; ++k) {
    first += static_cast<double>(weight[k] * corner[k]->first_look);
    second += static_cast<double>(weight[k] * corner[k]->second_look);
  }
  return first * second;
}

Weights weights_of(const InCell& at) {
  return {1 - at.a - at.b, at.a, at.b};
}

}  // namespace

std::pair<CellLooks, CellLooks> looks_of_halves(const CellLooks& looks, std::size_t corner) {
  const std::size_t next = (corner + 1) % 3;
  const std::size_t last = (corner + 2) % 3;
  CellLooks first;
  CellLooks second;
  for (SeenPoint point : looks.points) {
    const bool is_second = half_of(point.at, static_cast<std::uint32_t>(corner)) != 0;
    (is_second ? second : first).points.push_back(point);
  }
  first.corner = {looks.corner[corner], looks.corner[next], looks.middle[corner]};
  first.middle[2] = looks.middle[last];
  second.corner = {looks.corner[corner], looks.middle[corner], looks.corner[last]};
  second.middle[1] = looks.middle[next];
  return {std::move(first), std::move(second)};
}

void look_at_corners(const SideCell& cell, PilotLight::Looker& looker, CellLooks& looks) {
  const auto place = [](std::size_t k) {
    Weights weight{kInside, kInside, kInside};
    weight[k] = 1 - 2 * kInside;
    return place_of(weight);
  };
  look_where_missing(cell, looker, place, looks.corner);
}

void look_at_middles(const SideCell& cell, PilotLight::Looker& looker, CellLooks& looks) {
  const auto place = [](std::size_t k) {
    constexpr float kHalf = (1 - kInside) / 2;
    Weights weight{kHalf, kHalf, kHalf};
    weight[k] = kInside;
    return place_of(weight);
  };
  look_where_missing(cell, looker, place, looks.middle);
}

void look_at_points(const SideCell& cell, PilotLight::Looker& looker, CellLooks& looks) {
  const int missing = std::max(kNewPoints, kPoints - static_cast<int>(looks.points.size()));
  looker.look(cell, {missing, kShadowRays, kGatherRays});
  looks.points.insert(looks.points.end(), looker.points().begin(), looker.points().end());
}

double bent_variance(const CellLooks& looks) {
  double sum = 0;
  for (const SeenPoint& point : looks.points)
    sum += square_of_difference(point, weights_of(point.at),
                                {&*looks.corner[0], &*looks.corner[1], &*looks.corner[2]});
  return sum / static_cast<double>(looks.points.size());
}

double bent_variance_of_halves(const CellLooks& looks, std::size_t corner) {
  const Seen* const from = &*looks.corner[corner];
  const Seen* const next = &*looks.corner[(corner + 1) % 3];
  const Seen* const middle = &*looks.middle[corner];
  const Seen* const last = &*looks.corner[(corner + 2) % 3];
  double sum = 0;
  for (const SeenPoint& point : looks.points) {
    InCell at = point.at;
    if (half_of(at, static_cast<std::uint32_t>(corner)) == 0)
      sum += square_of_difference(point, weights_of(at), {from, next, middle});
    else
      sum += square_of_difference(point, weights_of(at), {from, middle, last});
  }
  return sum / static_cast<double>(looks.points.size());
}

double variance_between_halves(const CellLooks& looks, std::size_t corner) {
  std::array<std::size_t, 2> count{};
  std::array<double, 2> first{};
  std::array<double, 2> second{};
  for (const SeenPoint& point : looks.points) {
    InCell at = point.at;
    const std::uint32_t half = half_of(at, static_cast<std::uint32_t>(corner));
    ++count[half];
    first[half] += static_cast<double>(point.seen.first_look);
    second[half] += static_cast<double>(point.seen.second_look);
  }
  if (count[0] == 0 || count[1] == 0) return 0;
  const auto n0 = static_cast<double>(count[0]);
  const auto n1 = static_cast<double>(count[1]);
  const double product = (first[0] / n0 - first[1] / n1) * (second[0] / n0 - second[1] / n1);
  return n0 * n1 / ((n0 + n1) * (n0 + n1)) * product;
}

}  // namespace reemit
