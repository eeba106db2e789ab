#include "solver/sampling/shapes/rectangle_sampler.h"

#include <algorithm>
#include <cmath>

namespace reemit {

RectangleSampler::RectangleSampler(const Vec3& corner, const Vec3& edge_u, const Vec3& edge_v,
                                   const Vec3& front, const Vec3& x, const Vec3& n, Density density)
    : corner_(corner), edge_u_(edge_u), edge_v_(edge_v), front_(front), x_(x), n_(n), density_(density) {
  height_ = front.dot(x - corner);
  if (!(height_ > 0)) return;
  const double low = n.dot(corner - x);
  const double highest = low + std::max(0.0, n.dot(edge_u)) + std::max(0.0, n.dot(edge_v));
  if (!(highest > 0)) return;
  const double area2 = edge_u.squaredNorm() * edge_v.squaredNorm();
  const double lowest = low + std::min(0.0, n.dot(edge_u)) + std::min(0.0, n.dot(edge_v));
  if (density == Density::kSolidAngle && lowest >= 0 && set_up_solid_angle()) {
    lights_ = true;
    return;
  }
  if (density == Density::kArea) {
    extent_ = std::sqrt(area2);
    lights_ = extent_ > 0;
    return;
  }
  const std::array<Vec3, 4> corners{corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v};
  polygon_.emplace(corners, front, x, n, density);
  lights_ = polygon_->lights();
  density_ = polygon_->density();
}

bool RectangleSampler::set_up_solid_angle() {
  const double length_u = edge_u_.norm();
  const double length_v = edge_v_.norm();
  if (!(length_u > 0 && length_v > 0)) return false;
  unit_u_ = edge_u_ / length_u;
  unit_v_ = edge_v_ / length_v;
  const Vec3 from = corner_ - x_;
  u_low_ = unit_u_.dot(from);
  u_high_ = u_low_ + length_u;
  v_low_ = unit_v_.dot(from);
  v_high_ = v_low_ + length_v;
  const double beside_u = std::max({0.0, u_low_, -u_high_});
  const double beside_v = std::max({0.0, v_low_, -v_high_});
  const double beside2 = beside_u * beside_u + beside_v * beside_v;
  constexpr double kGrazing = 0.03;  // the map loses digits with the fourth power of this
  if (height_ * height_ < kGrazing * kGrazing * beside2) return false;
  const double size2 = length_u * length_u + length_v * length_v;
  constexpr double kFar = 300;  // where the difference of two slabs keeps some 11 digits
  if (beside2 + height_ * height_ > kFar * kFar * size2) return false;
  b_low_ = v_low_ / std::hypot(v_low_, height_);
  b_high_ = v_high_ / std::hypot(v_high_, height_);
  angle_low_ = slab_angle(u_low_ / std::hypot(u_low_, height_));
  extent_ = slab_angle(u_high_ / std::hypot(u_high_, height_)) - angle_low_;
  return extent_ > 0;
}

/// Signed solid angle between the planes u = 0 and that of `sine` = u / hypot(u, height). The two terms are
/// the angles of [URE13] less a right angle each, in a form without trigonometry of their sum.
double RectangleSampler::slab_angle(double sine) const {
  return std::asin(std::clamp(sine * b_high_, -1.0, 1.0)) - std::asin(std::clamp(sine * b_low_, -1.0, 1.0));
}

ShapePoint RectangleSampler::sample(double u0, double u1) const {
  if (!lights_) return {};
  if (polygon_) return polygon_->sample(u0, u1);
  if (density_ == Density::kArea)
    return area_point(corner_ + u0 * edge_u_ + u1 * edge_v_, front_, extent_, x_, n_);
  // asin(c b1) - asin(c b0) = angle, solved for c.
  const double angle = angle_low_ + u0 * extent_;
  const double half = std::sin(0.5 * angle);
  const double across2 = (b_high_ - b_low_) * (b_high_ - b_low_) + 4 * b_high_ * b_low_ * half * half;
  const double sine = across2 > 0 ? std::sin(angle) / std::sqrt(across2) : 0.0;
  const double cos2 = (1 - sine) * (1 + sine);
  const double u = std::clamp(cos2 > 0 ? height_ * sine / std::sqrt(cos2) : (sine > 0 ? u_high_ : u_low_),
                              u_low_, u_high_);
  // At given u, d omega is proportional to d (v / sqrt(v^2 + u^2 + height^2)).
  const double away2 = u * u + height_ * height_;
  const double h_low = v_low_ / std::sqrt(v_low_ * v_low_ + away2);
  const double h_high = v_high_ / std::sqrt(v_high_ * v_high_ + away2);
  const double h = h_low + u1 * (h_high - h_low);
  const double rest = (1 - h) * (1 + h);
  const double v =
      std::clamp(rest > 0 ? h * std::sqrt(away2 / rest) : (h > 0 ? v_high_ : v_low_), v_low_, v_high_);
  const Vec3 to = u * unit_u_ + v * unit_v_ - height_ * front_;
  const Vec3 direction = to / std::sqrt(away2 + v * v);
  return direction_point(x_ + to, front_, direction, 1 / extent_, std::max(0.0, n_.dot(direction)) * extent_);
}

double RectangleSampler::pdf_per_sr(const Vec3& point) const {
  if (!lights_) return 0;
  if (polygon_) return polygon_->pdf_per_sr(point);
  if (density_ == Density::kArea) return area_pdf_per_sr(point, front_, extent_, x_);
  return 1 / extent_;
}

std::array<double, 2> RectangleSampler::invert(const Vec3& point) const {
  if (!lights_) return {0.5, 0.5};
  if (polygon_) return polygon_->invert(point);
  if (density_ == Density::kArea) {
    const Vec3 p = point - corner_;
    return {std::clamp(p.dot(edge_u_) / edge_u_.squaredNorm(), 0.0, 1.0),
            std::clamp(p.dot(edge_v_) / edge_v_.squaredNorm(), 0.0, 1.0)};
  }
  const Vec3 to = point - x_;
  const double u = unit_u_.dot(to);
  const double v = unit_v_.dot(to);
  const double away2 = u * u + height_ * height_;
  const double h_low = v_low_ / std::sqrt(v_low_ * v_low_ + away2);
  const double h_high = v_high_ / std::sqrt(v_high_ * v_high_ + away2);
  const double h = v / std::sqrt(v * v + away2);
  return {std::clamp((slab_angle(u / std::sqrt(away2)) - angle_low_) / extent_, 0.0, 1.0),
          std::clamp((h - h_low) / (h_high - h_low), 0.0, 1.0)};
}

double RectangleSampler::irradiance() const {
  if (!lights_) return 0;
  const std::array<Vec3, 4> corners{corner_ - x_, corner_ + edge_u_ - x_, corner_ + edge_u_ + edge_v_ - x_,
                                    corner_ + edge_v_ - x_};
  return lambert_irradiance(ClippedPolygon(corners, Vec3::Zero(), n_).corners(), n_);
}

}  // namespace reemit
