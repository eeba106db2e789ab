#include "scenes/io/obj/obj_camera.h"

#include <cmath>
#include <numbers>

#include "scenes/io/common/text_file.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

constexpr std::uintmax_t kLargestCameraFile = 1 << 16;

[[noreturn]] void refuse(const std::string& where, const TextLine& line) {
  throw InputError(where, "'" + std::string(line.words[0]) + "' is not understood",
                   "Known are eye, direction, look-at, up, horizontal fov, vertical fov and image.");
}

Vec3 vector_of(const TextLine& line, const std::string& where) {
  if (line.words.size() != 4) refuse(where, line);
  Vec3 v;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = parse_number(line.words[i + 1]);
    if (!value) refuse(where, line);
    v[static_cast<Eigen::Index>(i)] = *value;
  }
  return v;
}

Vec3 place_of(const TextLine& line, const std::string& where) {
  const Vec3 place = vector_of(line, where);
  const std::string problem = place_problem(place);
  if (!problem.empty()) throw InputError(where, problem, kLengthAdvice);
  return place;
}

struct View {
  std::optional<Vec3> eye, look_at, direction;
  std::optional<double> horizontal_fov_deg;
  Camera camera;
};

void read_line(const TextLine& line, const std::string& where, View& view) {
  const std::string_view keyword = line.words[0];
  if (keyword == "eye") {
    view.eye = place_of(line, where);
  } else if (keyword == "direction") {
    view.direction = vector_of(line, where);
  } else if (keyword == "look-at") {
    view.look_at = place_of(line, where);
  } else if (keyword == "up") {
    view.camera.up = vector_of(line, where);
  } else if ((keyword == "horizontal" || keyword == "vertical") && line.words.size() >= 3 &&
             line.words[1] == "fov") {
    const auto angle = parse_number(line.words[2]);
    if (!angle || !(*angle > 0 && *angle < 180)) refuse(where, line);
    if (keyword == "horizontal")
      view.horizontal_fov_deg = *angle;
    else
      view.camera.vertical_fov_deg = *angle;
  } else if (keyword == "image" && line.words.size() == 4 && line.words[2] == "x") {
    const auto width = parse_integer(line.words[1]);
    const auto height = parse_integer(line.words[3]);
    if (!width || !height || *width < 1 || *height < 1 || *width > limits::kMostPixels ||
        *height > limits::kMostPixels)
      refuse(where, line);
    view.camera.width = static_cast<int>(*width);
    view.camera.height = static_cast<int>(*height);
  } else {
    refuse(where, line);
  }
}

Camera camera_of(const View& view, const std::string& where) {
  if (!view.eye || !(view.direction || view.look_at))
    throw InputError(where, "the eye or the direction is missing",
                     "Give 'eye' and 'direction' or 'look-at'.");
  Camera camera = view.camera;
  camera.eye = *view.eye;
  camera.look_at = view.look_at ? *view.look_at : Vec3(*view.eye + *view.direction);
  if (view.horizontal_fov_deg) {
    constexpr double kHalfDegree = std::numbers::pi / 360;
    const double half = std::tan(*view.horizontal_fov_deg * kHalfDegree) * camera.height / camera.width;
    camera.vertical_fov_deg = std::atan(half) / kHalfDegree;
  }
  return camera;
}

}  // namespace

std::optional<Camera> read_obj_camera(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  try {
    const std::string text = load_file(file, kLargestCameraFile);
    View view;
    for (const TextLine& line : split_lines(text))
      if (line.words[0][0] != '#') read_line(line, at_line(file.string(), line.number), view);
    return camera_of(view, file.string());
  } catch (const InputError& error) {
    warnings.push_back(std::string("The camera beside the room is not used: ") + error.what());
    return std::nullopt;
  }
}

}  // namespace reemit
