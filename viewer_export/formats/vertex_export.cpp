#include "viewer_export/formats/vertex_export.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace reemit {
namespace {

/// Smallest and largest coordinates. Pre: there is a vertex.
std::pair<Vec3, Vec3> box_of(const VertexData& data) {
  Vec3 low = data.positions.front();
  Vec3 high = low;
  for (const Vec3& p : data.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {low, high};
}

}  // namespace

VertexColours colours_of(const VertexData& data) {
  std::vector<float> rgb;
  rgb.reserve(3 * data.vertex_count());
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    const Eigen::Array3d colour = data.rgb(data.radiance, v);
    for (const double c : colour) rgb.push_back(static_cast<float>(c));
  }
  return {std::move(rgb), data.tone_map};
}

double back_gap(const VertexData& data) {
  if (std::find(data.on_back.begin(), data.on_back.end(), true) == data.on_back.end()) return 0;
  const auto [low, high] = box_of(data);
  return back_gap((high - low).norm());
}

double back_gap(double diagonal) {
  constexpr double kShareOfDiagonal = 5e-5;
  return kShareOfDiagonal * diagonal;
}

std::vector<Vec3> positions_for_viewing(const VertexData& data, double gap) {
  constexpr double kShareOfSurface = 1e-3;
  std::vector<Eigen::AlignedBox3d> boxes(data.surface_names.size());
  for (std::size_t v = 0; v < data.vertex_count(); ++v)
    boxes[data.surfaces[v].index()].extend(data.positions[v]);
  std::vector<Vec3> positions = data.positions;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (data.on_back[v])
      positions[v] += std::min(gap, kShareOfSurface * boxes[data.surfaces[v].index()].diagonal().norm()) *
                      data.normals[v];
  return positions;
}

Vec3 single_precision_origin(const VertexData& data) {
  if (data.positions.empty()) return Vec3::Zero();
  const auto [low, high] = box_of(data);
  return single_precision_origin(low, high);
}

Vec3 single_precision_origin(const Vec3& low, const Vec3& high) {
  const double size = (high - low).norm();
  const double reach = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  // Half a unit in the last place of a float is 6e-8 of the value.
  constexpr double kMostSizesAway = 16;
  if (reach <= kMostSizesAway * size || size == 0) return Vec3::Zero();
  return 0.5 * (low + high);
}

}  // namespace reemit
