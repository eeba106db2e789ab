#include "viewer_export/still/pixel_rows.h"

#include <algorithm>

#include "scenes/model/instruction_sets.h"

namespace reemit::pixel_rows {
namespace {

/// Square of a difference that matters to nobody, so that pixels without noise can be compared.
inline float tiny_beside(float p, float q) {
  return 0.5e-6F * (p * p + q * q) + 1e-30F;
}

}  // namespace

REEMIT_FOR_INSTRUCTION_SETS
void add_weighted(float* __restrict sum, const float* __restrict weight, const float* __restrict value,
                  std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += weight[i] * value[i];
}

REEMIT_FOR_INSTRUCTION_SETS
void add_variances(float* __restrict sum, const float* __restrict weight, const float* __restrict variance,
                   std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += weight[i] * weight[i] * variance[i];
}

REEMIT_FOR_INSTRUCTION_SETS
void add_differences(float* __restrict sum, const Pixels& p, const Pixels& q, const DifferenceScales& scales,
                     std::size_t count) {
  const auto [share, strength, noise] = scales;
  const float* const value_p = p.value;
  const float* const value_q = q.value;
  const float* const variance_p = p.variance;
  const float* const variance_q = q.variance;
  const float allowed = strength * strength;
  for (std::size_t i = 0; i < count; ++i) {
    const float difference = value_p[i] - value_q[i];
    const float vp = variance_p[i];
    const float vq = variance_q[i];
    const float tiny = tiny_beside(value_p[i], value_q[i]);
    const float least = vp < vq ? vp : vq;
    sum[i] += share * (difference * difference - 2 * noise * least) / (tiny + allowed * (vp + vq));
  }
}

REEMIT_FOR_INSTRUCTION_SETS
void add_pair_differences(float* __restrict sum, const Pixels& p, const Pixels& q, const Pixels& r,
                          const DifferenceScales& scales, std::size_t count) {
  const auto [share, strength, noise] = scales;
  const float *value_p = p.value, *value_q = q.value, *value_r = r.value;
  const float *variance_p = p.variance, *variance_q = q.variance, *variance_r = r.variance;
  const float allowed = strength * strength;
  for (std::size_t i = 0; i < count; ++i) {
    const float mean = 0.5F * (value_q[i] + value_r[i]);
    const float difference = value_p[i] - mean;
    const float vp = variance_p[i];
    const float vm = 0.25F * (variance_q[i] + variance_r[i]);
    const float tiny = tiny_beside(value_p[i], mean);
    const float least = vp < vm ? vp : vm;
    sum[i] += share * (difference * difference - noise * (vp + least)) / (tiny + allowed * (vp + vm));
  }
}

REEMIT_FOR_INSTRUCTION_SETS
void average_along(float* __restrict mean, const float* __restrict value, int reach, std::size_t count) {
  const auto near = static_cast<std::size_t>(reach);
  const auto average_at = [&](std::size_t i) {
    const std::size_t from = i < near ? 0 : i - near;
    const std::size_t to = i + near + 1 < count ? i + near + 1 : count;
    float sum = 0;
    for (std::size_t j = from; j < to; ++j) sum += value[j];
    mean[i] = sum / static_cast<float>(to - from);
  };
  const std::size_t width = 2 * near + 1;
  if (count < width) {
    for (std::size_t i = 0; i < count; ++i) average_at(i);
    return;
  }
  for (std::size_t i = 0; i < near; ++i) average_at(i);
  float* __restrict const inner = mean + near;
  const std::size_t inner_count = count - 2 * near;
  for (std::size_t i = 0; i < inner_count; ++i) inner[i] = value[i];
  for (std::size_t k = 1; k < width; ++k)
    for (std::size_t i = 0; i < inner_count; ++i) inner[i] += value[i + k];
  const auto terms = static_cast<float>(width);
  for (std::size_t i = 0; i < inner_count; ++i) inner[i] /= terms;
  for (std::size_t i = count - near; i < count; ++i) average_at(i);
}

REEMIT_FOR_INSTRUCTION_SETS
void average_across(float* __restrict mean, const float* __restrict value, std::size_t rows,
                    std::size_t stride, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) mean[i] = value[i];
  for (std::size_t j = 1; j < rows; ++j)
    for (std::size_t i = 0; i < count; ++i) mean[i] += value[j * stride + i];
  const auto terms = static_cast<float>(rows);
  for (std::size_t i = 0; i < count; ++i) mean[i] /= terms;
}

REEMIT_FOR_INSTRUCTION_SETS
void find_distances(float* __restrict distance, const Things& p, const Things& q, const ThingScales& scales,
                    std::size_t count) {
  const auto [normals, depth, columns, rows] = scales;
  const float *px = p.normal[0], *py = p.normal[1], *pz = p.normal[2];
  const float *qx = q.normal[0], *qy = q.normal[1], *qz = q.normal[2];
  const float *depth_p = p.depth, *depth_q = q.depth, *slope_x = p.slope_x, *slope_y = p.slope_y;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = px[i] - qx[i], y = py[i] - qy[i], z = pz[i] - qz[i];
    const float turned = (x * x + y * y + z * z) / (normals * normals);
    const float allowed = depth * depth_p[i] + 2 * (columns * slope_x[i] + rows * slope_y[i]);
    const float apart = (depth_p[i] - depth_q[i]) / allowed;
    distance[i] = turned > apart * apart ? turned : apart * apart;
  }
}

REEMIT_FOR_INSTRUCTION_SETS
void weigh(float* __restrict weight, const float* __restrict distance, const float* __restrict other_distance,
           float farthest, const float* __restrict precision, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float larger = distance[i] > other_distance[i] ? distance[i] : other_distance[i];
    const float positive = larger > 0 ? larger : 0;
    const float near = 1 - (positive < farthest ? positive : farthest) / farthest;
    weight[i] = precision[i] * (near * near * near * near);
  }
}

REEMIT_FOR_INSTRUCTION_SETS
void raise(float* __restrict value, const float* __restrict other, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) value[i] = value[i] > other[i] ? value[i] : other[i];
}

REEMIT_FOR_INSTRUCTION_SETS
void lower(float* __restrict value, const float* __restrict other, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) value[i] = value[i] < other[i] ? value[i] : other[i];
}

}  // namespace reemit::pixel_rows
