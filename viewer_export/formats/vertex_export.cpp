#include "viewer_export/formats/vertex_export.h"

namespace reemit {

VertexColours colours_of(const VertexData& data) {
  std::vector<float> rgb;
  rgb.reserve(3 * data.vertex_count());
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    const Eigen::Array3d colour = data.rgb(data.radiance, v);
    for (const double c : colour) rgb.push_back(static_cast<float>(c));
  }
  ToneMap tone_map = make_tone_map(rgb, data.tone_map);
  return {std::move(rgb), tone_map};
}

Vec3 single_precision_origin(const VertexData& data) {
  if (data.positions.empty()) return Vec3::Zero();
  Vec3 low = data.positions.front();
  Vec3 high = low;
  for (const Vec3& p : data.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).norm();
  const double reach = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  // Half a unit in the last place of a float is 6e-8 of the value.
  constexpr double kFarthest = 16;
  if (reach <= kFarthest * size || size == 0) return Vec3::Zero();
  return 0.5 * (low + high);
}

}  // namespace reemit
