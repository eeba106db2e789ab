#include "solver/trace/air_sheets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "solver/sampling/warp.h"
#include "solver/trace/embree_queries.h"

namespace reemit {
namespace {

/// Triangles of the square about a point that its part of a sheet lies in.
constexpr std::uint32_t kPerPoint = 2;

/// Planes whose normals and offsets differ by less than this may share a sheet [normalised units]: a fraction
/// of what measuring points are lifted by, so that no sheet slips behind a surface that a point lies on.
constexpr double kSamePlane = 0.5 * static_cast<double>(RayTracer::kLift);

using PlaneKey = std::array<std::int64_t, 4>;

PlaneKey plane_key(const MeasuringPoint& x) {
  const auto number = [](double value) { return static_cast<std::int64_t>(std::floor(value / kSamePlane)); };
  const Vec3 normal = x.normal.cast<double>();
  return {number(normal.x()), number(normal.y()), number(normal.z()),
          number(normal.dot(x.place.cast<double>()))};
}

/// What a query collects.
struct Crossed : QueryContext {
  std::vector<std::uint32_t> points;
};

void collect_and_pass(const RTCFilterFunctionNArguments* args) {
  auto& crossed = *static_cast<Crossed*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    crossed.points.push_back(RTCHitN_primID(args->hit, args->N, i) / kPerPoint);
    args->valid[i] = 0;
  }
}

}  // namespace

AirSheets::AirSheets(std::span<const MeasuringPoint> points, float reach)
    : embree_(std::make_unique<EmbreeTree>()) {
  std::map<PlaneKey, std::uint32_t> known;
  std::vector<Vec3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const MeasuringPoint& x : points) {
    const auto [at, is_new] = known.try_emplace(plane_key(x), static_cast<std::uint32_t>(sheets_.size()));
    if (is_new) sheets_.push_back({x.normal, x.normal.dot(x.place)});
    sheet_.push_back(at->second);
    places_.push_back(x.place);
    const Frame frame(x.normal);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      vertices.push_back(
          x.place + frame.to_world(Vec3f(reach * static_cast<float>(a), reach * static_cast<float>(b), 0)));
    for (const std::uint32_t k : {1U, 2U}) triangles.push_back({first, first + k, first + k + 1});
  }
  embree_->add_filtered(vertices, triangles, collect_and_pass);
  embree_->commit();
}

AirSheets::~AirSheets() = default;
AirSheets::AirSheets(AirSheets&&) noexcept = default;
AirSheets& AirSheets::operator=(AirSheets&&) noexcept = default;

std::vector<AirSheets::Crossing> AirSheets::crossings(const Vec3f& origin, const Vec3f& direction,
                                                      float length, float reach) const {
  Crossed crossed;
  RTCRay ray = make_ray(origin, direction, 0, length, 0);
  occluded1(embree_->scene(), ray, crossed);
  std::vector<Crossing> found;
  for (const std::uint32_t point : crossed.points) {
    const std::uint32_t sheet = sheet_[point];
    const float down = -sheets_[sheet].normal.dot(direction);
    if (!(down > 0)) continue;
    const float way = (sheets_[sheet].normal.dot(origin) - sheets_[sheet].offset) / down;
    if ((origin + way * direction - places_[point]).squaredNorm() < reach * reach)
      found.push_back({sheet, way});
  }
  const auto less = [](const Crossing& a, const Crossing& b) { return a.sheet < b.sheet; };
  const auto same = [](const Crossing& a, const Crossing& b) { return a.sheet == b.sheet; };
  std::sort(found.begin(), found.end(), less);
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

}  // namespace reemit
