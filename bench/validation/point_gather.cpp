#include "bench/validation/point_gather.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "solver/gather/gather_batch.h"
#include "solver/gather/point_sampler.h"
#include "solver/sampling/warp.h"

namespace reemit::validation {
namespace {

/// Triangles of surfaces, drawn in proportion to area.
class AreaSampler {
 public:
  AreaSampler(const ZoneMesh& mesh, const std::vector<SurfaceId>& surfaces) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      if (std::find(surfaces.begin(), surfaces.end(), mesh.triangle(TriangleId(t)).surface) == surfaces.end())
        continue;
      total_ += mesh.triangle_area(TriangleId(t));
      triangles_.emplace_back(t);
      cumulative_.push_back(total_);
    }
    if (triangles_.empty()) throw std::out_of_range("surfaces without triangles");
  }
  SurfacePoint place(const RayTracer& rays, const std::array<float, 2>& u) const {
    const double at = static_cast<double>(u[0]) * total_;
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, at);
    const auto i = static_cast<std::size_t>(found - cumulative_.begin());
    const double before = i == 0 ? 0 : cumulative_[i - 1];
    const auto stretched =
        static_cast<float>(std::clamp((at - before) / (cumulative_[i] - before), 0.0, 1 - 0x1p-24));
    const auto [s, t] = sample_triangle(stretched, u[1]);
    return surface_point(rays, triangles_[i], s, t, true);
  }

 private:
  double total_ = 0;
  std::vector<TriangleId> triangles_;
  std::vector<double> cumulative_;
};

}  // namespace

GatherEffort gather_effort(int shadow_rays, double rays_each, const Effort& effort) {
  return {shadow_rays, shadow_rays * std::max(1, static_cast<int>(rays_each * effort.work))};
}

SurfacePoint point_on(const RayTracer& rays, const Vec3& point, const Vec3& normal) {
  const ZoneMesh& mesh = rays.mesh();
  const Vec3 n = normal.normalized();
  const double tolerance = 1e-6 * rays.metres_per_unit();
  for (std::size_t i = 0; i < mesh.flat_count(); ++i) {
    const TriangleId t(i);
    const Vec3 edge1 = mesh.corner(t, 1) - mesh.corner(t, 0);
    const Vec3 edge2 = mesh.corner(t, 2) - mesh.corner(t, 0);
    const Vec3 offset = point - mesh.corner(t, 0);
    const Vec3& triangle_normal = mesh.triangle_normal(t);
    if ((triangle_normal - n).norm() > 1e-3 || std::fabs(offset.dot(triangle_normal)) > tolerance) continue;
    const double area2 = edge1.cross(edge2).dot(triangle_normal);
    const double u = offset.cross(edge2).dot(triangle_normal) / area2;
    const double v = edge1.cross(offset).dot(triangle_normal) / area2;
    constexpr double kSlack = 1e-7;
    if (u < -kSlack || v < -kSlack || u + v > 1 + kSlack) continue;
    const double inside_u = std::clamp(u, 0.0, 1.0);
    return surface_point(rays, t, static_cast<float>(inside_u),
                         static_cast<float>(std::clamp(v, 0.0, 1 - inside_u)), true);
  }
  throw std::out_of_range("no face at the point of a reference value");
}

PointGather::PointGather(const SolvedRoom& room, std::uint64_t seed, double close_hit)
    : room_(&room), seed_(seed), direct_(room.room()) {
  fields_.reserve(room.solutions().size());
  for (const Solution& s : room.solutions()) fields_.emplace_back(room.room(), s, ZoneSums::kGroups);
  for (const RadianceField& field : fields_)
    gathers_.emplace_back(field, direct_, GatherSettings{.close_hit = close_hit, .seed = seed});
}

template <class PlaceOf>
std::vector<Estimates> PointGather::gather(std::uint64_t index, const GatherEffort& effort,
                                           const PlaceOf& place_of) const {
  const std::size_t bands = room_->scene().bands.count();
  std::vector<Estimates> result(bands, Estimates(SolvedRoom::kReplicates, 0.0));
  const int points = effort.light_samples;
  const int rays_per_point = std::max(1, effort.gather_rays / points);
  tbb::parallel_for(std::size_t{0}, SolvedRoom::kReplicates, [&](std::size_t r) {
    const PointSampler sampler(seed_, RngPurpose::kProbe, index, static_cast<int>(r),
                               std::countr_zero(static_cast<unsigned>(points)));
    GatherBatch batch(gathers_[r / ZoneSums::kGroups]);
    // Sums of single samples in double: thousands of terms would wear down single precision.
    std::vector<float> sums(static_cast<std::size_t>(points) * 2 * bands, 0.0F);
    const std::vector<float> light_weight(bands, 1.0F);
    const std::vector<float> ray_weight(bands, 1.0F / static_cast<float>(rays_per_point));
    for (int i = 0; i < points; ++i) {
      const SurfacePoint x = place_of(sampler.place(i));
      float* direct = &sums[static_cast<std::size_t>(i) * 2 * bands];
      direct_.add_sample(x, sampler.light(i, 0, 1), light_weight.data(), direct);
      for (int j = 0; j < rays_per_point; ++j) {
        const std::array<float, 2> u = sampler.hemisphere(i, j, rays_per_point);
        const PathKey key{index, static_cast<std::uint32_t>(r),
                          static_cast<std::uint32_t>(i * rays_per_point + j),
                          static_cast<std::uint32_t>(r % ZoneSums::kGroups)};
        batch.add(x, u[0], u[1], key, ray_weight.data(), direct + bands);
      }
    }
    batch.flush();
    for (std::size_t band = 0; band < bands; ++band) {
      double sum = 0;
      for (int i = 0; i < points; ++i) {
        const float* sample = &sums[static_cast<std::size_t>(i) * 2 * bands];
        sum +=
            static_cast<double>(sample[band]) + std::numbers::pi * static_cast<double>(sample[bands + band]);
      }
      result[band][r] = sum / points;
    }
  });
  return result;
}

Estimates PointGather::at(const Vec3& point, const Vec3& normal, const GatherEffort& effort,
                          std::size_t band) const {
  const SurfacePoint x = point_on(room_->rays(), point, normal);
  const Vec3f name = room_->rays().normalised(point);
  const auto index = std::uint64_t{std::bit_cast<std::uint32_t>(name.x())} * 0x9E3779B97F4A7C15U ^
                     std::uint64_t{std::bit_cast<std::uint32_t>(name.y())} << 32 ^
                     std::bit_cast<std::uint32_t>(name.z());
  return gather(index, effort, [&](const std::array<float, 2>&) { return x; })[band];
}

Estimates PointGather::mean(const std::vector<SurfaceId>& surfaces, const GatherEffort& effort,
                            std::size_t band) const {
  return means(surfaces, effort)[band];
}

std::vector<Estimates> PointGather::means(const std::vector<SurfaceId>& surfaces,
                                          const GatherEffort& effort) const {
  const AreaSampler area(room_->mesh(), surfaces);
  return gather(surfaces.front().index(), effort,
                [&](const std::array<float, 2>& u) { return area.place(room_->rays(), u); });
}

Estimates direct_irradiance(const Room& room, const SurfacePoint& x, int samples, std::uint64_t seed) {
  const DirectLight direct(room);
  Estimates result(SolvedRoom::kReplicates, 0.0);
  tbb::parallel_for(std::size_t{0}, result.size(), [&](std::size_t r) {
    const std::array<std::uint32_t, 4> bits = CounterRng(seed, RngPurpose::kProbe).bits4(r, 0, 0);
    std::vector<double> sum(room.band_count(), 0.0);
    direct.add_samples(x, SobolSequence(std::uint64_t{bits[0]} << 32 | bits[1]), 0, samples, sum.data());
    result[r] = sum[0] / samples;
  });
  return result;
}

Estimates traced_irradiance(const Room& room, const SurfacePoint& x, const GatherEffort& effort,
                            std::uint64_t seed, std::size_t band) {
  const DirectLight direct(room);
  const PathTracer tracer(room, direct, seed);
  const std::size_t bands = room.band_count();
  const int rays_per_sample = std::max(1, effort.gather_rays / effort.light_samples);
  Estimates result(SolvedRoom::kReplicates, 0.0);
  tbb::parallel_for(std::size_t{0}, result.size(), [&](std::size_t r) {
    const PointSampler sampler(seed, RngPurpose::kProbe, 0, static_cast<int>(r),
                               std::countr_zero(static_cast<unsigned>(effort.light_samples)));
    const std::vector<float> light_weight(bands, 1.0F);
    double sum = 0;
    for (int i = 0; i < effort.light_samples; ++i) {
      std::vector<float> arrived(bands, 0.0F);
      direct.add_sample(x, sampler.light(i, 0, 1), light_weight.data(), arrived.data());
      std::vector<float> radiance(bands, 0.0F);
      for (int j = 0; j < rays_per_sample; ++j) {
        std::vector<float> weight(bands, 1.0F / static_cast<float>(rays_per_sample));
        const std::array<float, 2> u = sampler.hemisphere(i, j, rays_per_sample);
        const PathKey key{0, static_cast<std::uint32_t>(r),
                          static_cast<std::uint32_t>(i * rays_per_sample + j), 0};
        tracer.add_indirect(x, u[0], u[1], key, weight.data(), radiance.data());
      }
      sum += static_cast<double>(arrived[band]) + std::numbers::pi * static_cast<double>(radiance[band]);
    }
    result[r] = sum / effort.light_samples;
  });
  return result;
}

}  // namespace reemit::validation
