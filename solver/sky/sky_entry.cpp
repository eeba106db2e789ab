#include "solver/sky/sky_entry.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "solver/sampling/warp.h"

namespace reemit {
namespace {

using std::numbers::pi;
/// The box is larger than the room by this share and more, so that no face of the room lies in it.
constexpr double kMargin = 1e-4;

/// [-pi, pi).
double wrapped(double angle) {
  return angle - 2 * pi * std::floor((angle + pi) / (2 * pi));
}

}  // namespace

SkyBox SkyBox::around(const Vec3& extent, const Vec3& up) {
  Eigen::Index least = 0;
  up.cwiseAbs().minCoeff(&least);
  const Vec3 first = (Vec3::Unit(least) - up[least] * up).normalized();
  SkyBox box;
  box.axes.row(0) = first.transpose();
  box.axes.row(1) = up.cross(first).transpose();
  box.axes.row(2) = up.transpose();
  const Vec3 half = box.axes.cwiseAbs() * extent;
  box.high = half + Vec3::Constant(kMargin * (1 + half.maxCoeff()));
  box.low = -box.high;
  return box;
}

double SkyBox::face_area(std::size_t face) const {
  const Vec3 size = high - low;
  const auto axis = static_cast<Eigen::Index>(face / 2);
  return size[(axis + 1) % 3] * size[(axis + 2) % 3];
}

SkyEntry::SkyEntry(const SkyTable& table, const SkyBox& box, std::optional<std::size_t> band)
    : table_(&table), box_(box) {
  const std::size_t columns = table.columns();
  for (std::size_t f = 0; f < kFaces; ++f) {
    Face& face = faces_[f];
    const double sign = f % 2 == 0 ? 1 : -1;
    const Vec3 normal =
        table.to_local() * (sign * box.axes.row(static_cast<Eigen::Index>(f / 2)).transpose());
    face.azimuth = std::atan2(normal.y(), normal.x());
    face.rows_until.assign(table.rows() + 1, 0.0);
    face.columns_until.assign(table.rows() * (columns + 1), 0.0F);
    std::vector<double> width(columns, 0.0);
    for (std::size_t c = 0; c < columns; ++c) {
      double low = 0;
      double high = 0;
      clip_azimuths(f, c, low, high);
      if (high > low) width[c] = is_upright(f) ? std::sin(high) - std::sin(low) : high - low;
    }
    std::vector<double> until(columns + 1, 0.0);
    for (std::size_t r = 0; r < table.rows(); ++r) {
      double low = 0;
      double high = 0;
      clip_altitudes(f, r, low, high);
      const double height = high > low ? std::abs(height_measure(f, high) - height_measure(f, low)) : 0;
      double row = 0;
      for (std::size_t c = 0; c < columns; ++c) {
        const SkyTable::Cell cell{r, c};
        row += width[c] * static_cast<double>(band ? table.radiance(cell)[*band] : table.brightness(cell));
        until[c + 1] = row;
      }
      for (std::size_t c = 0; c <= columns; ++c)
        face.columns_until[r * (columns + 1) + c] = static_cast<float>(
            row > 0 ? until[c] / row : static_cast<double>(c) / static_cast<double>(columns));
      face.irradiance += row * height;
      face.rows_until[r + 1] = face.irradiance;
    }
    if (face.irradiance > 0)
      for (double& u : face.rows_until) u /= face.irradiance;
  }
}

double SkyEntry::height_measure(std::size_t face, double altitude) const {
  if (is_upright(face)) return 0.5 * altitude + 0.25 * std::sin(2 * altitude);
  return 0.5 * std::sin(altitude) * std::sin(altitude);
}

double SkyEntry::altitude_of(std::size_t face, double measure, double low, double high) const {
  if (!is_upright(face))
    return std::clamp(up_sign(face) * std::asin(std::sqrt(std::clamp(2 * measure, 0.0, 1.0))), low, high);
  // Newton's steps: the measure rises with the altitude, and rows are low.
  double altitude = 0.5 * (low + high);
  for (int step = 0; step < 4; ++step) {
    const double slope = std::cos(altitude) * std::cos(altitude);
    if (!(slope > 0)) break;
    altitude = std::clamp(altitude - (height_measure(face, altitude) - measure) / slope, low, high);
  }
  return altitude;
}

void SkyEntry::clip_altitudes(std::size_t face, std::size_t row, double& low, double& high) const {
  low = table_->altitude(row + 1);
  high = table_->altitude(row);
  if (is_upright(face)) return;
  if (up_sign(face) > 0)
    low = std::max(low, 0.0);
  else
    high = std::min(high, 0.0);
}

void SkyEntry::clip_azimuths(std::size_t face, std::size_t column, double& low, double& high) const {
  low = table_->azimuth(column);
  high = table_->azimuth(column + 1);
  if (!is_upright(face)) return;
  const double width = high - low;
  low = wrapped(low - faces_[face].azimuth);
  high = std::min(low + width, pi / 2);
  low = std::max(low, -pi / 2);
}

SkyRay SkyEntry::start(std::size_t f, const Numbers& u) const {
  const Face& face = faces_[f];
  double within_row = 0;
  double within_column = 0;
  const std::size_t row = find_interval(face.rows_until.data(), table_->rows(), u[2], within_row);
  const std::size_t column = find_interval(&face.columns_until[row * (table_->columns() + 1)],
                                           table_->columns(), u[3], within_column);
  double low = 0;
  double high = 0;
  clip_altitudes(f, row, low, high);
  const double from = height_measure(f, high);
  const double altitude = altitude_of(f, from + within_row * (height_measure(f, low) - from), low, high);
  clip_azimuths(f, column, low, high);
  const double azimuth =
      is_upright(f)
          ? face.azimuth + std::asin(std::clamp(
                               std::sin(low) + within_column * (std::sin(high) - std::sin(low)), -1.0, 1.0))
          : low + within_column * (high - low);
  const Vec3 local(std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth),
                   std::sin(altitude));
  const auto axis = static_cast<Eigen::Index>(f / 2);
  const Eigen::Index a = (axis + 1) % 3;
  const Eigen::Index b = (axis + 2) % 3;
  Vec3 point;
  point[axis] = f % 2 == 0 ? box_.high[axis] : box_.low[axis];
  point[a] = box_.low[a] + u[0] * (box_.high[a] - box_.low[a]);
  point[b] = box_.low[b] + u[1] * (box_.high[b] - box_.low[b]);
  return {(box_.axes.transpose() * point).cast<float>(),
          (-(table_->to_local().transpose() * local).normalized()).cast<float>()};
}

std::size_t SkyEntry::invert(const Vec3& point, const Vec3& towards, Numbers& u) const {
  const Vec3 from = box_.axes * point;
  const Vec3 along = box_.axes * towards;
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t f = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (along[k] == 0) continue;
    const double way = ((along[k] > 0 ? box_.high[k] : box_.low[k]) - from[k]) / along[k];
    if (!(way < nearest)) continue;
    nearest = way;
    f = 2 * static_cast<std::size_t>(k) + (along[k] > 0 ? 0 : 1);
  }
  const Vec3 exit = from + std::max(0.0, nearest) * along;
  const auto axis = static_cast<Eigen::Index>(f / 2);
  const Eigen::Index a = (axis + 1) % 3;
  const Eigen::Index b = (axis + 2) % 3;
  u[0] = (exit[a] - box_.low[a]) / (box_.high[a] - box_.low[a]);
  u[1] = (exit[b] - box_.low[b]) / (box_.high[b] - box_.low[b]);
  const Vec3 local = table_->to_local() * towards;
  const SkyTable::Cell cell = table_->cell_of(local);
  const Face& face = faces_[f];
  const auto between = [](double low, double high, double share) {
    return low + std::clamp(share, 0.0, 1.0) * (high - low);
  };
  double low = 0;
  double high = 0;
  clip_altitudes(f, cell.row, low, high);
  const double altitude = std::clamp(std::asin(std::clamp(local.z(), -1.0, 1.0)), low, high);
  const double from_measure = height_measure(f, high);
  const double height = height_measure(f, low) - from_measure;
  u[2] = between(face.rows_until[cell.row], face.rows_until[cell.row + 1],
                 height != 0 ? (height_measure(f, altitude) - from_measure) / height : 0.5);
  clip_azimuths(f, cell.column, low, high);
  const double azimuth = std::atan2(local.y(), local.x());
  double share = 0.5;
  if (high > low)
    share = is_upright(f)
                ? (std::sin(std::clamp(wrapped(azimuth - face.azimuth), low, high)) - std::sin(low)) /
                      (std::sin(high) - std::sin(low))
                : (azimuth + 2 * pi - low) / (high - low);
  const float* columns = &face.columns_until[cell.row * (table_->columns() + 1) + cell.column];
  u[3] = between(static_cast<double>(columns[0]), static_cast<double>(columns[1]), share);
  for (double& number : u) number = std::clamp(number, 0.0, double{kLargestBelowOne});
  return f;
}

}  // namespace reemit
