#include "solver/gather/bright_zones.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/gather/replicate_gather.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

/// A zone is bright from so many times the mean reflected radiance on.
constexpr double kTimesMean = 2;
/// Of the mean square of reflected radiance, the share that bright zones have at least.
constexpr double kLeastBrightShare = 0.8;
/// Length of the mean of the normals of a clump from which on they count as one.
constexpr float kLikeNormals = 0.7F;

struct BrightZone {
  ZoneId zone;
  Vec3f centre;
  Vec3f normal;
  double power;  // radiance times area [normalised]
};

/// By zone, reflected in all bands together.
std::vector<float> sum_over_bands(const RadianceField& field) {
  std::vector<float> radiance(field.room().mesh().zone_count(), 0.0F);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, radiance.size(), 4096), [&](const auto& range) {
    for (std::size_t z = range.begin(); z != range.end(); ++z) {
      double sum = 0;
      for (std::size_t b = 0; b < field.band_count(); ++b)
        sum += static_cast<double>(field.mean_reflected(ZoneId(z), b));
      radiance[z] = static_cast<float>(sum);
    }
  });
  return radiance;
}

std::vector<BrightZone> brightest(const Room& room, const std::vector<float>& radiance) {
  const ZoneMesh& mesh = room.mesh();
  const double metres = room.rays().metres_per_unit();
  double area = 0;
  double sum = 0;
  double square = 0;
  for (std::size_t z = 0; z < radiance.size(); ++z) {
    const auto of_zone = static_cast<double>(radiance[z]);
    if (!(of_zone > 0)) continue;
    area += mesh.zone_area(ZoneId(z));
    sum += mesh.zone_area(ZoneId(z)) * of_zone;
    square += mesh.zone_area(ZoneId(z)) * of_zone * of_zone;
  }
  std::vector<BrightZone> zones;
  double of_bright = 0;
  for (std::size_t z = 0; z < radiance.size(); ++z) {
    const ZoneId zone(z);
    const auto of_zone = static_cast<double>(radiance[z]);
    if (!(of_zone > 0) || of_zone * area < kTimesMean * sum) continue;
    of_bright += mesh.zone_area(zone) * of_zone * of_zone;
    const double aimed_at = mesh.zone_area(zone) / mesh.solid_share(zone) / (metres * metres);
    zones.push_back({zone, room.rays().normalised(mesh.zone_centroid(zone)),
                     mesh.side_normal(mesh.zone_side(zone)).cast<float>(), of_zone * aimed_at});
  }
  if (of_bright < kLeastBrightShare * square) zones.clear();
  return zones;
}

/// Neighbours in the list of bright zones.
struct Clump {
  std::size_t first, last;
  Vec3f middle, half;            // of the box around centres
  Vec3f normal = Vec3f::Zero();  // mean, not of unit length
  float power = 0;

  Clump(const std::vector<BrightZone>& zones, std::size_t begin, std::size_t end) : first(begin), last(end) {
    Vec3f low = zones[first].centre;
    Vec3f high = low;
    for (std::size_t i = first; i < last; ++i) {
      const auto of_zone = static_cast<float>(zones[i].power);
      low = low.cwiseMin(zones[i].centre);
      high = high.cwiseMax(zones[i].centre);
      normal += of_zone * zones[i].normal;
      power += of_zone;
    }
    normal /= power;
    middle = 0.5F * (low + high);
    half = 0.5F * (high - low);
  }
  bool is_divisible() const { return last - first > 1; }
  /// How bad it is to take it for one.
  float cost() const { return is_divisible() ? power * (half.norm() + 1 - normal.norm()) : -1.0F; }
};

/// Sorts the zones of a clump so that two halves of like power follow each other, apart by normals or by
/// place; returns where the second begins. Pre: clump.is_divisible().
std::size_t halve(const Clump& clump, std::vector<BrightZone>& zones) {
  const bool by_normal = clump.normal.norm() < kLikeNormals;
  Eigen::Index axis = 0;
  if (by_normal) {
    Vec3f spread = Vec3f::Zero();
    for (std::size_t i = clump.first; i < clump.last; ++i)
      spread += static_cast<float>(zones[i].power) * (zones[i].normal - clump.normal).cwiseAbs2();
    spread.maxCoeff(&axis);
  } else {
    clump.half.maxCoeff(&axis);
  }
  const auto at = [&](const BrightZone& z) { return by_normal ? z.normal[axis] : z.centre[axis]; };
  const auto begin = zones.begin();
  std::sort(begin + static_cast<std::ptrdiff_t>(clump.first), begin + static_cast<std::ptrdiff_t>(clump.last),
            [&](const BrightZone& a, const BrightZone& b) {
              return at(a) != at(b) ? at(a) < at(b) : a.zone.index() < b.zone.index();
            });
  std::size_t middle = clump.first;
  for (float power = 0; middle + 1 < clump.last && power < 0.5F * clump.power; ++middle)
    power += static_cast<float>(zones[middle].power);
  return std::max(middle, clump.first + 1);
}

/// Splits what is worst to take for one until there are enough; sorts the zones by clump.
std::vector<Clump> clumps_of(std::vector<BrightZone>& zones, std::size_t most) {
  std::vector<Clump> clumps{Clump(zones, 0, zones.size())};
  while (clumps.size() < most) {
    const auto worst = std::max_element(clumps.begin(), clumps.end(),
                                        [](const Clump& a, const Clump& b) { return a.cost() < b.cost(); });
    if (!worst->is_divisible()) break;
    const std::size_t first = worst->first;
    const std::size_t last = worst->last;
    const std::size_t middle = halve(*worst, zones);
    *worst = Clump(zones, first, middle);
    clumps.push_back(Clump(zones, middle, last));
  }
  std::sort(clumps.begin(), clumps.end(), [](const Clump& a, const Clump& b) { return a.first < b.first; });
  return clumps;
}

}  // namespace

BrightZones::BrightZones(const RadianceField& field)
    : room_(&field.room()), radiance_(sum_over_bands(field)) {
  std::vector<BrightZone> zones = brightest(*room_, radiance_);
  if (zones.empty()) return;
  const std::vector<Clump> clumps = clumps_of(zones, kMostClumps);
  clump_of_.assign(radiance_.size(), kNone);
  clumps_ = clumps.size();
  radius_.fill(1);  // no division by 0 where there is no clump
  for (std::size_t k = 0; k < clumps_; ++k) {
    const Clump& clump = clumps[k];
    first_[k] = static_cast<std::uint32_t>(clump.first);
    first_[k + 1] = static_cast<std::uint32_t>(clump.last);
    x_[k] = clump.middle.x();
    y_[k] = clump.middle.y();
    z_[k] = clump.middle.z();
    nx_[k] = clump.normal.x();
    ny_[k] = clump.normal.y();
    nz_[k] = clump.normal.z();
    spread_[k] = 1 - clump.normal.norm();
    double power = 0;
    double largest = 0;  // area of a zone
    for (std::size_t i = clump.first; i < clump.last; ++i) {
      const ZoneId zone = zones[i].zone;
      power += zones[i].power;
      power_to_.push_back(static_cast<float>(power));
      zones_.push_back(zone);
      clump_of_[zone.index()] = static_cast<std::uint8_t>(k);
      largest = std::max(largest, zones[i].power / static_cast<double>(radiance(zone)));
    }
    power_[k] = static_cast<float>(power);
    radius_[k] = clump.half.norm() + static_cast<float>(std::sqrt(largest));
  }
}

void BrightZones::view(const Vec3f& x, const Vec3f& n, View& view) const {
  // All clumps that there could be, so that the compiler can take several at once; those that are not have no
  // power.
  for (std::size_t k = 0; k < kMostClumps; ++k) view.weight[k] = weight(k, x, n);
  std::array<float, 4> sum{};
  for (std::size_t k = 0; k < kMostClumps; k += sum.size())
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += view.weight[k + i];
  view.total = (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

BrightZones::Aim BrightZones::aim(const Vec3f& x, const View& view, const std::array<float, 3>& u) const {
  const float position = u[0] * view.total;
  float low = 0;
  std::size_t k = 0;
  float up_to = 0;
  for (std::size_t i = 0; i < clumps_ && !(position < up_to); ++i) {
    if (!(view.weight[i] > 0)) continue;  // rounding must not choose one that cannot light x
    k = i;
    low = up_to;
    up_to += view.weight[i];
  }
  const float at = stretched(position, low, view.weight[k]) * power_[k];
  const auto begin = power_to_.begin() + first_[k];
  const auto end = power_to_.begin() + first_[k + 1];
  const auto chosen = std::min(std::upper_bound(begin, end, at), end - 1);
  const SurfacePoint target =
      point_in_zone(*room_, zones_[static_cast<std::size_t>(chosen - power_to_.begin())], {u[1], u[2]});
  const Vec3f way = room_->rays().point(target.triangle, target.u, target.v) - x;
  const float distance = way.norm();
  if (!(distance > 0)) return {};
  return {way / distance, target.triangle, target.front, distance};
}

float BrightZones::pdf_per_sr(const Vec3f& x, const Vec3f& n, float total, ZoneId zone, float cosine,
                              float distance) const {
  const std::size_t k = clump_of_[zone.index()];
  if (!(total > 0)) return 0;
  return weight(k, x, n) / total * (radiance_[zone.index()] / power_[k]) * distance * distance / cosine;
}

}  // namespace reemit
