#include "bench/zone_plans/export_check.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <tbb/parallel_for.h>

#include "solver/gather/gather_batch.h"
#include "solver/gather/replicate_gather.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit::bench {
namespace {

constexpr std::uint64_t kSeed = 12345;
constexpr std::uint32_t kHalves = 2;
constexpr ReplicateEffort kEffort{64, 4};
/// Points are found again from this far above their triangle [normalised units].
constexpr float kAbove = 1e-4F;
constexpr double kWrongShare = 0.25;
constexpr double kWrongOfMean = 0.1;

/// A point of an exported triangle.
struct ExportPoint {
  std::array<std::uint32_t, 3> vertex;
  std::array<double, 3> weight;
};

/// Evenly over their area.
class ExportPoints {
 public:
  explicit ExportPoints(const VertexData& data) : data_(data) {
    for (const auto& t : data.triangles) {
      const Vec3& a = data.positions[t[0]];
      area_ += 0.5 * (data.positions[t[1]] - a).cross(data.positions[t[2]] - a).norm();
      area_up_to_.push_back(area_);
    }
  }
  /// `u` in [0,1): `u[0]` along the triangles.
  ExportPoint at(double along, const std::array<float, 2>& u) const {
    const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, along * area_);
    const auto [a, b] = sample_triangle(u[0], u[1]);
    const auto wa = static_cast<double>(a);
    const auto wb = static_cast<double>(b);
    return {data_.triangles[static_cast<std::size_t>(found - area_up_to_.begin())], {1 - wa - wb, wa, wb}};
  }

 private:
  const VertexData& data_;
  double area_ = 0;
  std::vector<double> area_up_to_;  // by triangle
};

/// The place in the room; none where another thing lies so close above it that it cannot be told.
std::optional<SurfacePoint> place_of(const Room& room, const VertexData& data, const ExportPoint& point) {
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) x += point.weight[k] * data.positions[point.vertex[k]];
  const Vec3f normal = data.normals[point.vertex[0]].cast<float>();
  const Vec3f above = room.rays().normalised(x) + kAbove * normal;
  Hit hit;
  if (!room.rays().closest(above, -normal, hit) || std::abs(hit.distance - kAbove) > 0.7F * kAbove) return {};
  if (room.surfaces().emits(hit.triangle, hit.front)) return {};
  return surface_point(room.rays(), hit, -normal);
}

/// What is shown and seen there in one band [W/(m2 sr)]; nothing where nothing could be compared.
struct Comparison {
  double shown = 0;
  std::array<double, kHalves> seen{};
  bool is_made = false;
};

}  // namespace

ExportDifference export_difference(const Room& room, const Solution& solution, std::size_t points) {
  const std::atomic<bool> never{false};
  VertexSettings settings;
  settings.light_samples = 256;
  const VertexData data = gather_vertices(room, solution, settings, {}, never);
  const RadianceField field(room, solution, kHalves);
  const DirectLight direct(room);
  const HemisphereGather gather(field, direct, GatherSettings{.seed = kSeed});
  const ExportPoints all(data);
  const std::size_t bands = room.band_count();
  std::vector<Comparison> compared(points * bands);
  tbb::parallel_for(std::size_t{0}, points, [&](std::size_t i) {
    const PointSampler place(kSeed, RngPurpose::kDiscretisation, i, kHalves, 0);
    const float shift = place.hemisphere(0, 0, 1)[0];
    const ExportPoint point = all.at(
        (static_cast<double>(i) + static_cast<double>(shift)) / static_cast<double>(points), place.place(0));
    const std::optional<SurfacePoint> x = place_of(room, data, point);
    if (!x) return;
    std::vector<float> found(std::size_t{2} * kHalves * bands, 0.0F);  // by half: direct and gathered
    GatherBatch batch(gather, kEffort.gathers);
    for (std::uint32_t half = 0; half < kHalves; ++half) {
      const PointSampler sampler(kSeed, RngPurpose::kDiscretisation, i, static_cast<int>(half),
                                 std::countr_zero(static_cast<unsigned>(kEffort.points)));
      float* const of_half = &found[2 * half * bands];
      add_replicate(
          direct, sampler, kEffort, {i, half, 0, half}, [&](const auto&) { return *x; }, batch, of_half,
          of_half + bands);
    }
    batch.flush();
    const float* const reflectance = room.surfaces().reflectance(x->triangle, x->front);
    for (std::size_t b = 0; b < bands; ++b) {
      Comparison& c = compared[i * bands + b];
      for (std::size_t k = 0; k < 3; ++k)
        c.shown += point.weight[k] * static_cast<double>(data.radiance[point.vertex[k] * bands + b]);
      for (std::size_t half = 0; half < kHalves; ++half)
        c.seen[half] = static_cast<double>(reflectance[b]) *
                       (static_cast<double>(found[2 * half * bands + b]) / std::numbers::pi +
                        static_cast<double>(found[(2 * half + 1) * bands + b]));
      c.is_made = true;
    }
  });

  std::erase_if(compared, [](const Comparison& c) { return !c.is_made; });
  double mean = 0;
  double difference = 0;
  double square = 0;
  for (const Comparison& c : compared) {
    mean += 0.5 * (c.seen[0] + c.seen[1]) / static_cast<double>(compared.size());
    difference += (c.shown - c.seen[0]) * (c.shown - c.seen[1]);
    square += c.seen[0] * c.seen[1];
  }
  const auto wrong = std::count_if(compared.begin(), compared.end(), [&](const Comparison& c) {
    const double light = 0.5 * (c.seen[0] + c.seen[1]);
    return std::abs(c.shown - light) > kWrongShare * light + kWrongOfMean * mean;
  });
  if (!(square > 0)) return {};
  return {std::sqrt(std::max(0.0, difference) / square),
          static_cast<double>(wrong) / static_cast<double>(compared.size())};
}

}  // namespace reemit::bench
