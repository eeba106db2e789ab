#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "scenes/model/luminaire.h"

namespace reemit::test {

/// A table without symmetry: a beam in the lower hemisphere with lobes in azimuth and dark cells.
inline std::shared_ptr<const IntensityTable> lobed_table(PhotometricType type = PhotometricType::kC) {
  const std::vector<double> polar{0, 10, 35, 50, 70, 120, 180};
  const std::vector<double> azimuth = type == PhotometricType::kC
                                          ? std::vector<double>{0, 40, 90, 200, 250, 360}
                                          : std::vector<double>{-90, -40, 0, 20, 60, 90};
  std::vector<double> candela;
  for (std::size_t j = 0; j < azimuth.size(); ++j)
    for (std::size_t i = 0; i < polar.size(); ++i)
      candela.push_back(i == 4 && j == 2 ? 0.0 : static_cast<double>((i * 7 + j * 5) % 11) * 10);
  return std::make_shared<const IntensityTable>(type, polar, azimuth, candela);
}

/// cos(gamma) to the nadir, on lines one degree apart: total flux pi within 1e-4.
inline std::shared_ptr<const IntensityTable> lambertian_table() {
  std::vector<double> polar;
  std::vector<double> candela;
  for (int i = 0; i <= 90; ++i) polar.push_back(i);
  for (int plane = 0; plane < 2; ++plane)
    for (const double p : polar) candela.push_back(p == 90 ? 0 : std::cos(p * std::numbers::pi / 180));
  return std::make_shared<const IntensityTable>(PhotometricType::kC, polar, std::vector<double>{0, 360},
                                                candela);
}

inline LuminousOpening opening(LuminousOpening::Shape shape, double length, double width, double height,
                               LuminousOpening::Axis axis = LuminousOpening::Axis::kHeight) {
  LuminousOpening o;
  o.shape = shape;
  o.length = length;
  o.width = width;
  o.height = height;
  o.axis = axis;
  return o;
}

}  // namespace reemit::test
