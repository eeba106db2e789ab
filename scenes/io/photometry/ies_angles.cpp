#include "scenes/io/photometry/ies_angles.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "scenes/model/error.h"

namespace reemit {
namespace {

constexpr double kDegreeSlack = 1e-6;  // [degree]

bool same(double a, double b) {
  return std::fabs(a - b) <= kDegreeSlack;
}

bool one_of(double angle, std::initializer_list<double> choices) {
  return std::any_of(choices.begin(), choices.end(), [angle](double c) { return same(angle, c); });
}

/// Planes by increasing azimuth; `column` is an index into the horizontal angles of the file.
struct Planes {
  std::vector<double> azimuth;
  std::vector<std::size_t> column;

  void add(double angle, std::size_t from) {
    azimuth.push_back(angle);
    column.push_back(from);
  }
  /// Adds the mirror images of the planes about azimuth `about`, which lies at or beyond the last plane.
  void mirror(double about) {
    for (std::size_t i = azimuth.size(); i-- > 0;)
      if (!same(azimuth[i], about)) add(2 * about - azimuth[i], column[i]);
  }
};

Planes unfolded_planes(const IesGrid& grid, bool& closed) {
  Planes planes;
  const std::vector<double>& h = grid.horizontal;
  if (grid.type != PhotometricType::kC) {
    if (same(h.front(), 0))  // the mirror images of 0 ... 90 come first
      for (std::size_t i = h.size(); i-- > 1;) planes.add(-h[i], i);
    for (std::size_t i = 0; i < h.size(); ++i) planes.add(h[i], i);
    return planes;
  }
  for (std::size_t i = 0; i < h.size(); ++i) planes.add(h[i], i);
  if (h.size() == 1) {
    planes.add(h[0] + 360, 0);
  } else if (same(h.back(), 90)) {
    planes.mirror(90);
    planes.mirror(180);
  } else if (same(h.back(), 180)) {
    planes.mirror(180);
  } else if (same(h.front(), 90)) {
    planes.mirror(270);
  } else if (!same(h.back(), 360)) {
    planes.add(h.front() + 360, 0);
    closed = true;
  }
  // Not off by what same() lets pass.
  planes.azimuth.front() = std::round(planes.azimuth.front());
  planes.azimuth.back() = planes.azimuth.front() + 360;
  return planes;
}

/// Sets `closed` if the last plane was missing and plane 0 was taken for it. Throws std::invalid_argument if
/// there is no flux.
IntensityTable unfolded(const IesGrid& grid, bool& closed) {
  closed = false;
  const Planes planes = unfolded_planes(grid, closed);
  const std::size_t rows = grid.vertical.size();
  const auto value = [&](std::size_t plane, std::size_t row) {
    return grid.candela[planes.column[plane] * rows + row];
  };
  std::vector<double> candela;
  candela.reserve(planes.azimuth.size() * rows);
  // The outermost angles are what their check lets pass, to kDegreeSlack.
  const auto colatitude = [](double angle) { return std::clamp(angle, 0.0, 180.0); };
  std::vector<double> polar;
  if (grid.type == PhotometricType::kB) {
    // The pole is horizontal: horizontal angles are latitudes, vertical ones azimuths.
    for (const double h : planes.azimuth) polar.push_back(colatitude(h + 90));
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t plane = 0; plane < polar.size(); ++plane) candela.push_back(value(plane, row));
    return {grid.type, polar, grid.vertical, std::move(candela)};
  }
  const double offset = grid.type == PhotometricType::kA ? 90 : 0;
  for (const double v : grid.vertical) polar.push_back(colatitude(v + offset));
  for (std::size_t plane = 0; plane < planes.azimuth.size(); ++plane)
    for (std::size_t row = 0; row < rows; ++row) candela.push_back(value(plane, row));
  return {grid.type, polar, planes.azimuth, std::move(candela)};
}

/// What to warn of when angles that can be read cover less than any range that LM-63 knows; else empty.
std::string unusual_range(const IesGrid& grid) {
  const auto range = [](const char* which, const std::vector<double>& angles) {
    return fmt::format("the {} angles run from {} to {} degrees only; there is no light outside of them",
                       which, angles.front(), angles.back());
  };
  const std::vector<double>& v = grid.vertical;
  const std::vector<double>& h = grid.horizontal;
  if (grid.type == PhotometricType::kC)
    return one_of(v.front(), {0, 90}) && one_of(v.back(), {90, 180}) ? "" : range("vertical", v);
  if (!one_of(v.front(), {-90, 0}) || !same(v.back(), 90)) return range("vertical", v);
  return one_of(h.front(), {-90, 0}) && same(h.back(), 90) ? "" : range("horizontal", h);
}

}  // namespace

IesComplaint check_vertical_angles(const IesGrid& grid) {
  const bool type_c = grid.type == PhotometricType::kC;
  const double first = grid.vertical.front();
  const double last = grid.vertical.back();
  const double least = type_c ? 0 : -90;
  const double most = type_c ? 180 : 90;
  if (first >= least - kDegreeSlack && last <= most + kDegreeSlack) return {};
  return {fmt::format("the vertical angles run from {} to {} degrees", first, last),
          type_c ? "In type C photometry they lie between 0 and 180 degrees."
                 : "In type A and B photometry they lie between -90 and 90 degrees."};
}

IesComplaint check_horizontal_angles(const IesGrid& grid) {
  const double first = grid.horizontal.front();
  const double last = grid.horizontal.back();
  const std::string problem = fmt::format("the horizontal angles run from {} to {} degrees", first, last);
  if (grid.type != PhotometricType::kC) {
    const bool within =
        (same(first, 0) || (first >= -90 - kDegreeSlack && first < 0)) && last <= 90 + kDegreeSlack;
    if (within && last > 0) return {};
    return {problem,
            "In type A and B photometry they run from 0, mirrored, or from below 0 to 90 degrees at most."};
  }
  if (grid.horizontal.size() == 1) {
    if (same(first, 0)) return {};
    return {fmt::format("the only horizontal angle is {} degrees", first),
            "It must be 0, for a distribution without regard to the plane."};
  }
  const bool from_zero =
      same(first, 0) && (one_of(last, {90, 180}) || (last > 180 && last <= 360 + kDegreeSlack));
  if (from_zero || (same(first, 90) && same(last, 270))) return {};
  return {problem,
          "In type C photometry they run from 0 to 90, 180 or 360 degrees by their symmetry, or from 90 to "
          "270."};
}

void clear_noise(std::vector<double>& intensities, const std::string& where,
                 std::vector<std::string>& warnings) {
  constexpr double kMostNoise = 0.01;
  if (intensities.empty()) return;
  const double least = -kMostNoise * *std::max_element(intensities.begin(), intensities.end());
  std::size_t count = 0;
  for (double& intensity : intensities) {
    if (!(intensity < 0 && intensity >= least)) continue;
    intensity = 0;
    ++count;
  }
  if (count > 0)
    warnings.push_back(fmt::format("{}: {} intensities slightly below 0 count as 0.", where, count));
}

std::shared_ptr<const IntensityTable> table_of(const IesGrid& grid, const std::string& where,
                                               const std::string& file, std::vector<std::string>& warnings) {
  bool closed = false;
  std::shared_ptr<const IntensityTable> table;
  try {
    table = std::make_shared<const IntensityTable>(unfolded(grid, closed));
  } catch (const std::invalid_argument&) {
    throw InputError(where, "the luminaire gives no light: its intensities add up to 0 or to no number",
                     "Was the file written completely?");
  }
  if (closed)
    warnings.push_back(
        fmt::format("{}: the horizontal angles end at {} degrees; from there to 360 it is taken to plane 0.",
                    file, grid.horizontal.back()));
  const std::string unusual = unusual_range(grid);
  if (!unusual.empty()) warnings.push_back(fmt::format("{}: {}.", file, unusual));
  return table;
}

}  // namespace reemit
