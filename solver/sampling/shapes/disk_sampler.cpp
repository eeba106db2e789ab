#include "solver/sampling/shapes/disk_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/sampling/shapes/plane_maps.h"

namespace reemit {
namespace {

using std::numbers::pi;

}  // namespace

DiskSampler::DiskSampler(const Disk& disk, const Vec3& x, const Vec3& n, Density density)
    : disk_(disk), x_(x), n_(n), density_(density) {
  if (density_ == Density::kVisibleArea) density_ = Density::kArea;
  const Vec3 to_centre = disk.centre - x;
  height_ = -disk.normal.dot(to_centre);
  const double level = n.dot(to_centre);
  const double along = n.dot(disk.normal);
  const double reach = disk.radius * std::sqrt(std::max(0.0, 1 - along * along));
  if (!(height_ > 0) || !(disk.radius > 0) || !(level + reach > 0)) return;
  lights_ = true;
  const double size = 2 * disk.radius;
  if (to_centre.squaredNorm() > kFarSizes * kFarSizes * size * size) density_ = Density::kArea;
  if (density_ == Density::kArea) {
    const Tangents tangents(disk.normal);
    towards_ = tangents.t;
    return;
  }
  const AlignedFrame frame(disk.normal, to_centre);
  towards_ = frame.e1;
  offset_ = frame.across;
  foot_ = x - height_ * disk.normal;
  const RoundRegion region{RoundRegion::Kind::kDisk, offset_, disk.radius, height_, height_};
  angles_.emplace(region, -disk.normal, towards_, n, density_ == Density::kCosine);
  if (angles_->total() > 0) return;
  angles_.reset();
  density_ = Density::kArea;
}

ShapePoint DiskSampler::sample(double u0, double u1) const {
  if (!lights_) return {};
  if (density_ == Density::kArea) {
    const auto d = unit_disk(u0, u1);
    const Vec3 across = disk_.normal.cross(towards_);
    const Vec3 point = disk_.centre + disk_.radius * (d[0] * towards_ + d[1] * across);
    return area_point(point, disk_.normal, pi * disk_.radius * disk_.radius, x_, n_);
  }
  const AzimuthElevation::Direction d = angles_->sample(u0, u1);
  // In the plane of the disk, from the foot.
  Vec3 radial = d.unit - disk_.normal.dot(d.unit) * disk_.normal;
  const double length = radial.norm();
  const Vec3 point = foot_ + (length > 0 ? d.distance / length : 0.0) * radial;
  return direction_point(point, disk_.normal, d.unit, d.pdf_per_sr, d.irradiance);
}

double DiskSampler::pdf_per_sr(const Vec3& point) const {
  if (!lights_) return 0;
  if (density_ == Density::kArea)
    return area_pdf_per_sr(point, disk_.normal, pi * disk_.radius * disk_.radius, x_);
  return angles_->pdf_per_sr((point - x_).normalized());
}

std::array<double, 2> DiskSampler::invert(const Vec3& point) const {
  if (!lights_) return {0.5, 0.5};
  if (density_ == Density::kArea) {
    const Vec3 p = (point - disk_.centre) / disk_.radius;
    return invert_unit_disk(p.dot(towards_), p.dot(disk_.normal.cross(towards_)));
  }
  return angles_->invert((point - x_).normalized());
}

}  // namespace reemit
