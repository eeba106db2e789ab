#include "solver/reflect/gloss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/sampling/warp.h"

namespace reemit {
namespace {

constexpr float kPiFloat = std::numbers::pi_v<float>;

float tangent2(const Vec3f& w) {
  return (w.x() * w.x() + w.y() * w.y()) / (w.z() * w.z());
}

/// Smith's Lambda of GGX: hidden over seen area of the facets.
float lambda(float alpha, const Vec3f& w) {
  return 0.5F * (std::sqrt(1 + alpha * alpha * tangent2(w)) - 1);
}

Vec3f mirrored(const Vec3f& from, const Vec3f& normal) {
  return (2 * from.dot(normal) * normal - from).normalized();
}

}  // namespace

GlossModel::GlossModel(GlossLobe lobe, double alpha)
    : lobe_(lobe),
      alpha_(static_cast<float>(alpha)),
      exponent_(static_cast<float>(std::max(0.0, 2 / (alpha * alpha) - 2))) {}

Vec3f GlossModel::sample_facet(const Vec3f& from, float u0, float u1) const {
  // Stretched until the surface is a hemisphere, of which the disk across the view is seen.
  const Vec3f view = Vec3f(alpha_ * from.x(), alpha_ * from.y(), from.z()).normalized();
  const float across = view.x() * view.x() + view.y() * view.y();
  const Vec3f t1 = across > 0 ? Vec3f(Vec3f(-view.y(), view.x(), 0) / std::sqrt(across)) : Vec3f(1, 0, 0);
  const Vec3f t2 = view.cross(t1);
  Point2 p = sample_disk(u0, u1);
  const float s = 0.5F * (1 + view.z());
  p.y = (1 - s) * std::sqrt(std::max(0.0F, 1 - p.x * p.x)) + s * p.y;
  const Vec3f n = p.x * t1 + p.y * t2 + std::sqrt(std::max(0.0F, 1 - p.x * p.x - p.y * p.y)) * view;
  return Vec3f(alpha_ * n.x(), alpha_ * n.y(), std::max(0.0F, n.z())).normalized();
}

float GlossModel::unmasked(const Vec3f& direction) const {
  return 1 / (1 + lambda(alpha_, direction));
}

bool GlossModel::sample(const Vec3f& from, float u0, float u1, Vec3f& to) const {
  const float phi = 2 * kPiFloat * u1;
  switch (lobe_) {
    case GlossLobe::kGgx:
      to = mirrored(from, sample_facet(from, u0, u1));
      break;
    case GlossLobe::kWard: {
      const float tangent = alpha_ * std::sqrt(-std::log1p(-u0));
      to = mirrored(from, Vec3f(tangent * std::cos(phi), tangent * std::sin(phi), 1).normalized());
      break;
    }
    case GlossLobe::kPhong: {
      const float cosine = std::pow(1 - u0, 1 / (exponent_ + 1));
      const float sine = std::sqrt(std::max(0.0F, 1 - cosine * cosine));
      to = Frame(Vec3f(-from.x(), -from.y(), from.z()))
               .to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
      break;
    }
  }
  return to.z() > 0;
}

GlossValue GlossModel::value(const Vec3f& from, const Vec3f& to) const {
  if (!(from.z() > 0 && to.z() > 0)) return {};
  switch (lobe_) {
    case GlossLobe::kGgx:
      return ggx(from, to);
    case GlossLobe::kWard:
      return ward(from, to);
    case GlossLobe::kPhong:
      return phong(from, to);
  }
  return {};
}

GlossValue GlossModel::ggx(const Vec3f& from, const Vec3f& to) const {
  const Vec3f half = (from + to).normalized();
  const float a2 = alpha_ * alpha_;
  const float t = (half.x() * half.x() + half.y() * half.y()) / a2 + half.z() * half.z();
  const float facets = 1 / (kPiFloat * a2 * t * t);  // D [WAL07, eq. 33]
  const float hidden_from = lambda(alpha_, from);
  GlossValue v;
  v.brdf_per_sr = facets / ((1 + hidden_from + lambda(alpha_, to)) * 4 * from.z() * to.z());
  v.pdf_per_sr = facets / ((1 + hidden_from) * 4 * from.z());
  v.half_cosine = from.dot(half);
  return v;
}

GlossValue GlossModel::ward(const Vec3f& from, const Vec3f& to) const {
  const Vec3f half = from + to;
  const float a2 = alpha_ * alpha_;
  const float length2 = half.squaredNorm();
  const float length = std::sqrt(length2);
  const float z2 = half.z() * half.z();
  const float bell = std::exp(-tangent2(half) / a2) / (kPiFloat * a2);
  GlossValue v;
  v.brdf_per_sr = bell * length2 / (z2 * z2);
  v.half_cosine = 0.5F * length;
  const float z = half.z() / length;
  v.pdf_per_sr = bell / (4 * v.half_cosine * z * z * z);
  return v;
}

GlossValue GlossModel::phong(const Vec3f& from, const Vec3f& to) const {
  const float cosine = from.z() * to.z() - from.x() * to.x() - from.y() * to.y();
  if (!(cosine > 0)) return {};
  const float lobe = std::pow(cosine, exponent_) / (2 * kPiFloat);
  return {(exponent_ + 2) * lobe, (exponent_ + 1) * lobe, std::min(1.0F, 0.5F * (from + to).norm())};
}

}  // namespace reemit
