#include "viewer_export/points/point_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "scenes/io/common/text_file.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"
#include "scenes/model/memory.h"

namespace reemit {
namespace {

constexpr std::size_t kNumbers = 6;
constexpr const char* kLineAdvice = "Give x y z [m] and the direction it faces, as 1.5 0.85 2 0 1 0.";

/// The numbers of a line; nothing if one of its words is none.
std::optional<std::vector<double>> numbers_of(const TextLine& line) {
  std::vector<double> numbers;
  for (const std::string_view word : line.words) {
    const std::optional<double> number = parse_number(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

bool is_heading(const TextLine& line) {
  return std::none_of(line.words.begin(), line.words.end(),
                      [](std::string_view word) { return parse_number(word).has_value(); });
}

void add_point(const std::string& where, const std::vector<double>& numbers, PointSet& points) {
  if (numbers.size() != kNumbers)
    throw InputError(where,
                     fmt::format("{} numbers in the line of a point, which has {}", numbers.size(), kNumbers),
                     kLineAdvice);
  const Vec3 place(numbers[0], numbers[1], numbers[2]);
  if (const std::string problem = place_problem(place); !problem.empty())
    throw InputError(where, problem, kLengthAdvice);
  const Vec3 facing(numbers[3], numbers[4], numbers[5]);
  const double length = facing.norm();
  if (!(length > 0) || !std::isfinite(length))
    throw InputError(where, "the direction that the point faces has no length", kLineAdvice);
  points.places.push_back(place);
  points.normals.push_back(facing / length);
}

}  // namespace

PointSet grid_points(const std::string& name, const PointGrid& grid, const Vec3& up) {
  const Vec3 area = grid.along.cross(grid.across);
  // Sides that are parallel but for rounding span none.
  if (!(area.norm() > 1e-9 * grid.along.norm() * grid.across.norm()))
    throw InputError(name, "the sides of the grid span no area",
                     "Give the corner, the two sides from there and the number of fields, as "
                     "0.5,0.85,0.5 4,0,0 0,0,5 8x10.");
  if (grid.columns < 1 || grid.rows < 1)
    throw InputError(name, "the grid has no fields", "Give one at least along each of its sides.");
  const double fields = static_cast<double>(grid.columns) * static_cast<double>(grid.rows);
  check_memory(fmt::format("{}: {:.3g} points", name, fields), 2 * sizeof(Vec3) * fields, available_memory());
  Vec3 normal = area.normalized();
  if (normal.dot(up) < -1e-9) normal = Vec3::Zero() - normal;  // no -0
  PointSet points{name, {}, {}};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      points.places.push_back(grid.corner + (column + 0.5) / grid.columns * grid.along +
                              (row + 0.5) / grid.rows * grid.across);
      points.normals.push_back(normal);
    }
  return points;
}

PointSet read_points(const std::filesystem::path& file) {
  std::string text = load_file(file);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  PointSet points{file.stem().string(), {}, {}};
  bool is_first = true;
  for (const TextLine& line : split_lines(text)) {
    if (line.words.front().starts_with('#')) continue;
    const std::string where = at_line(file.string(), line.number);
    const std::optional<std::vector<double>> numbers = numbers_of(line);
    if (!numbers && !(is_first && is_heading(line)))
      throw InputError(where, "not a line of numbers", kLineAdvice);
    if (numbers) add_point(where, *numbers, points);
    is_first = false;
  }
  if (points.places.empty()) throw InputError(file.string(), "no point in it", kLineAdvice);
  return points;
}

}  // namespace reemit
