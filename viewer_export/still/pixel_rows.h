#pragma once
#include <array>
#include <cstddef>

/// Arithmetic on rows of pixels, compiled for several instruction sets and chosen when the program starts;
/// all versions return the same bits.
namespace reemit::pixel_rows {

/// sum[i] += weight[i] value[i].
void add_weighted(float* sum, const float* weight, const float* value, std::size_t count);

/// sum[i] += weight[i]^2 variance[i].
void add_variances(float* sum, const float* weight, const float* variance, std::size_t count);

/// Values of pixels, and how much noise is in them (variance).
struct Pixels {
  const float* value;
  const float* variance;
};
/// How differences of pixels count.
struct DifferenceScales {
  float share;     ///< Of all that is added up.
  float strength;  ///< Standard errors by which pixels may differ ([RKZ12] eq. 3: k).
  float noise;     ///< Share of the noise by which they differ if they are alike: below 1 if they share some.
};
/// sum[i] += the squared difference of two pixels over what noise explains ([RKZ12] eq. 3, where the smaller
/// variance stands for both, so that it is the same from either).
void add_differences(float* sum, const Pixels& p, const Pixels& q, const DifferenceScales& scales,
                     std::size_t count);

/// Likewise of pixels p and the means of two others, q and r.
void add_pair_differences(float* sum, const Pixels& p, const Pixels& q, const Pixels& r,
                          const DifferenceScales& scales, std::size_t count);

/// mean[i] becomes the mean of value[i-reach .. i+reach], as far as they are in [0,count).
void average_along(float* mean, const float* value, int reach, std::size_t count);

/// mean[i] becomes the mean of `rows` values at distance `stride`, the first of them value[i].
void average_across(float* mean, const float* value, std::size_t rows, std::size_t stride, std::size_t count);

/// What pixels see.
struct Things {
  std::array<const float*, 3> normal;
  const float* depth;
  const float* slope_x;  ///< Of depth per pixel.
  const float* slope_y;
};
/// How far pixels lie apart, and what counts as distance 1.
struct ThingScales {
  float normals;        ///< Length of the difference of normals.
  float depth;          ///< Relative difference of depth.
  float columns, rows;  ///< Between the pixels: the slope of depth allows for that many times itself.
};
/// distance[i] of what pixels p and q see: squared, of normal or depth, whichever is larger.
void find_distances(float* distance, const Things& p, const Things& q, const ThingScales& scales,
                    std::size_t count);

/// weight[i] = precision[i] (1 - d/farthest)^4 with d the larger of the distances, within [0,farthest].
void weigh(float* weight, const float* distance, const float* other_distance, float farthest,
           const float* precision, std::size_t count);

/// value[i] becomes the larger, or the smaller of both.
void raise(float* value, const float* other, std::size_t count);
void lower(float* value, const float* other, std::size_t count);

}  // namespace reemit::pixel_rows
