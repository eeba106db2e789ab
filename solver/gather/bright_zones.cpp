#include "solver/gather/bright_zones.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

BrightZones::BrightZones(const RadianceField& field) : room_(&field.room()) {
  choose(field);
  if (!zones_.empty()) make_clumps();
}

void BrightZones::choose(const RadianceField& field) {
  const ZoneMesh& mesh = room_->mesh();
  const RayTracer& rays = room_->rays();
  const double metres = rays.metres_per_unit();
  radiance_.assign(mesh.zone_count(), 0.0F);
  double area = 0;
  double sum = 0;
  double square = 0;
  for (std::size_t z = 0; z < radiance_.size(); ++z) {
    double radiance = 0;
    for (std::size_t b = 0; b < field.band_count(); ++b)
      radiance += static_cast<double>(field.mean_reflected(ZoneId(z), b));
    if (!(radiance > 0)) continue;
    radiance_[z] = static_cast<float>(radiance);
    const double of_zone = mesh.zone_area(ZoneId(z));
    area += of_zone;
    sum += of_zone * radiance;
    square += of_zone * radiance * radiance;
  }
  double of_bright = 0;
  for (std::size_t z = 0; z < radiance_.size(); ++z) {
    const ZoneId zone(z);
    const auto radiance = static_cast<double>(radiance_[z]);
    if (!(radiance > 0) || radiance * area < kTimesMean * sum) continue;
    of_bright += mesh.zone_area(zone) * radiance * radiance;
    const double aimed_at = mesh.zone_area(zone) / mesh.solid_share(zone) / (metres * metres);
    zones_.push_back({zone, rays.normalised(mesh.zone_centroid(zone)),
                      mesh.side_normal(mesh.zone_side(zone)).cast<float>(), radiance * aimed_at});
  }
  if (of_bright < kLeastBrightShare * square) zones_.clear();
}

/// Splits what is worst to take for one, until there are enough.
void BrightZones::make_clumps() {
  struct Clump {
    std::size_t first, last;
    Vec3f middle, half, normal;  // of the box; mean, not of unit length
    float power = 0;
    float cost() const { return power * (half.norm() + 1 - normal.norm()); }
  };
  const auto clump_of = [&](std::size_t first, std::size_t last) {
    Clump clump{first, last, {}, {}, Vec3f::Zero()};
    Vec3f low = zones_[first].centre;
    Vec3f high = low;
    for (std::size_t i = first; i < last; ++i) {
      const auto power = static_cast<float>(zones_[i].power);
      low = low.cwiseMin(zones_[i].centre);
      high = high.cwiseMax(zones_[i].centre);
      clump.normal += power * zones_[i].normal;
      clump.power += power;
    }
    clump.normal /= clump.power;
    clump.middle = 0.5F * (low + high);
    clump.half = 0.5F * (high - low);
    return clump;
  };
  std::vector<Clump> clumps{clump_of(0, zones_.size())};
  while (clumps.size() < kMostClumps) {
    const auto worst = std::max_element(clumps.begin(), clumps.end(), [](const Clump& a, const Clump& b) {
      return (a.last - a.first > 1 ? a.cost() : -1.0F) < (b.last - b.first > 1 ? b.cost() : -1.0F);
    });
    const Clump clump = *worst;
    if (clump.last - clump.first < 2) break;
    const bool by_normal = clump.normal.norm() < kLikeNormals;
    Eigen::Index axis = 0;
    if (by_normal) {
      Vec3f spread = Vec3f::Zero();
      for (std::size_t i = clump.first; i < clump.last; ++i)
        spread += static_cast<float>(zones_[i].power) * (zones_[i].normal - clump.normal).cwiseAbs2();
      spread.maxCoeff(&axis);
    } else {
      clump.half.maxCoeff(&axis);
    }
    const auto at = [&](const Zone& z) { return by_normal ? z.normal[axis] : z.centre[axis]; };
    const auto begin = zones_.begin() + static_cast<std::ptrdiff_t>(clump.first);
    const auto end = zones_.begin() + static_cast<std::ptrdiff_t>(clump.last);
    std::sort(begin, end, [&](const Zone& a, const Zone& b) {
      return at(a) != at(b) ? at(a) < at(b) : a.zone.index() < b.zone.index();
    });
    std::size_t middle = clump.first;
    for (float power = 0; middle + 1 < clump.last && power < 0.5F * clump.power; ++middle)
      power += static_cast<float>(zones_[middle].power);
    middle = std::max(middle, clump.first + 1);
    *worst = clump_of(clump.first, middle);
    clumps.push_back(clump_of(middle, clump.last));
  }
  std::sort(clumps.begin(), clumps.end(), [](const Clump& a, const Clump& b) { return a.first < b.first; });

  clump_of_.assign(radiance_.size(), kNone);
  power_to_.resize(zones_.size());
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
    float size = 0;
    for (std::size_t i = clump.first; i < clump.last; ++i) {
      power += zones_[i].power;
      power_to_[i] = static_cast<float>(power);
      const ZoneId zone = zones_[i].zone;
      clump_of_[zone.index()] = static_cast<std::uint8_t>(k);
      size = std::max(size, static_cast<float>(
                                std::sqrt(zones_[i].power / static_cast<double>(radiance_[zone.index()]))));
    }
    power_[k] = static_cast<float>(power);
    radius_[k] = clump.half.norm() + size;
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

SurfacePoint BrightZones::aim(const View& view, const std::array<float, 3>& u) const {
  const float position = u[0] * view.total;
  float low = 0;
  std::size_t k = 0;
  while (k + 1 < clumps_ && !(position < low + view.weight[k])) low += view.weight[k++];
  const float rest = stretched(position, low, view.weight[k]);
  const auto begin = power_to_.begin() + first_[k];
  const auto end = power_to_.begin() + first_[k + 1];
  const float at = rest * power_[k];
  const auto chosen = std::min(std::upper_bound(begin, end, at), end - 1);
  const auto zone = static_cast<std::size_t>(chosen - power_to_.begin());
  return point_in_zone(*room_, zones_[zone].zone, {u[1], u[2]});
}

float BrightZones::pdf_per_sr(const Vec3f& x, const Vec3f& n, float total, ZoneId zone, float cosine,
                              float distance) const {
  const std::size_t k = clump_of_[zone.index()];
  if (!(total > 0)) return 0;
  return weight(k, x, n) / total * (radiance_[zone.index()] / power_[k]) * distance * distance / cosine;
}

}  // namespace reemit
