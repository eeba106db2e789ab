#include "scenes/io/ply/ply_reader.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/io/common/srgb.h"
#include "scenes/io/common/text_file.h"
#include "scenes/io/ply/ply_header.h"
#include "scenes/model/error.h"

namespace reemit {

namespace {

/// Reads one value after the other from the body of a PLY file, all as double (exact for every PLY type).
class PlyBody {
 public:
  PlyBody(const std::string& bytes, const PlyHeader& header, const std::string& file)
      : bytes_(bytes), at_(header.size), line_(header.lines + 1), format_(header.format), file_(file) {}

  double next(PlyType type) { return format_ == PlyFormat::kAscii ? next_word() : next_binary(type); }

  std::size_t next_list_length(const PlyProperty& list) {
    const double length = next(list.count_type);
    const std::size_t each = format_ == PlyFormat::kAscii ? 2 : size_of(list.type);
    if (!(length >= 0) || length != std::floor(length) ||
        length > double(bytes_.size() - at_ + 1) / double(each)) {
      fail(fmt::format("a list of length {} does not fit into the file", length));
    }
    return static_cast<std::size_t>(length);
  }

  void skip(const PlyProperty& property) {
    const std::size_t count = property.is_list ? next_list_length(property) : 1;
    for (std::size_t i = 0; i < count; ++i) next(property.type);
  }

  [[noreturn]] void fail(const std::string& problem) const {
    const std::string where = format_ == PlyFormat::kAscii ? fmt::format("{}:{}", file_, line_)
                                                           : fmt::format("{} (byte {})", file_, at_);
    throw InputError(where, problem, "The file is damaged or cut off; write it anew.");
  }

  std::uint32_t line() const { return format_ == PlyFormat::kAscii ? static_cast<std::uint32_t>(line_) : 0; }

 private:
  double next_word() {
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    while (at_ < bytes_.size() && is_space(bytes_[at_])) line_ += bytes_[at_++] == '\n' ? 1 : 0;
    const std::size_t start = at_;
    while (at_ < bytes_.size() && !is_space(bytes_[at_])) ++at_;
    const std::string_view word(bytes_.data() + start, at_ - start);
    if (word.empty()) fail("the file ends too early");
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) fail("expected a number");
    return value;
  }

  double next_binary(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return raw<std::int8_t>();
      case PlyType::kUint8:
        return raw<std::uint8_t>();
      case PlyType::kInt16:
        return raw<std::int16_t>();
      case PlyType::kUint16:
        return raw<std::uint16_t>();
      case PlyType::kInt32:
        return raw<std::int32_t>();
      case PlyType::kUint32:
        return raw<std::uint32_t>();
      case PlyType::kFloat:
        return double{raw<float>()};
      case PlyType::kDouble:
        break;
    }
    return raw<double>();
  }

  template <class T>
  T raw() {
    if (bytes_.size() - at_ < sizeof(T)) fail("the file ends too early");
    unsigned char buffer[sizeof(T)];
    std::memcpy(buffer, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    constexpr bool kLittleHost = std::endian::native == std::endian::little;
    if ((format_ == PlyFormat::kLittleEndian) != kLittleHost)
      std::reverse(std::begin(buffer), std::end(buffer));
    return std::bit_cast<T>(buffer);
  }

  const std::string& bytes_;
  std::size_t at_;
  std::size_t line_;
  PlyFormat format_;
  const std::string& file_;
};

/// Which number of a vertex a property is: x y z nx ny nz, u and v of textures, which have several names, and
/// red, green and blue; nothing for any other.
std::optional<std::size_t> coordinate_of(const PlyProperty& property) {
  static constexpr std::pair<std::string_view, std::size_t> kNames[] = {{"x", 0},
                                                                        {"y", 1},
                                                                        {"z", 2},
                                                                        {"nx", 3},
                                                                        {"ny", 4},
                                                                        {"nz", 5},
                                                                        {"u", 6},
                                                                        {"v", 7},
                                                                        {"s", 6},
                                                                        {"t", 7},
                                                                        {"texture_u", 6},
                                                                        {"texture_v", 7},
                                                                        {"red", 8},
                                                                        {"green", 9},
                                                                        {"blue", 10},
                                                                        {"diffuse_red", 8},
                                                                        {"diffuse_green", 9},
                                                                        {"diffuse_blue", 10},
                                                                        {"r", 8},
                                                                        {"g", 9},
                                                                        {"b", 10}};
  const auto it = std::find_if(std::begin(kNames), std::end(kNames),
                               [&](const auto& name) { return name.first == property.name; });
  if (it == std::end(kNames) || property.is_list) return std::nullopt;
  return it->second;
}
constexpr std::size_t kNumbers = 11;

/// Colours in integers are sRGB, those in floating point linear.
double colour_of(double value, PlyType type) {
  if (type == PlyType::kFloat || type == PlyType::kDouble) return std::clamp(value, 0.0, 1.0);
  const double most = type == PlyType::kUint16 ? 65535 : 255;
  return linear_from_srgb(std::clamp(value / most, 0.0, 1.0));
}

void read_vertices(const PlyElement& element, PlyBody& body, Surface& surface) {
  bool given[kNumbers] = {};
  for (const PlyProperty& property : element.properties) {
    if (const auto k = coordinate_of(property)) given[*k] = true;
  }
  if (!given[0] || !given[1] || !given[2]) body.fail("the vertices have no x, y and z");
  const bool has_normals = given[3] && given[4] && given[5];
  const bool has_coordinates = given[6] && given[7];
  surface.has_vertex_colours = given[8] && given[9] && given[10];
  for (std::uint64_t i = 0; i < element.count; ++i) {
    double values[kNumbers] = {};
    for (const PlyProperty& property : element.properties) {
      if (const auto k = coordinate_of(property)) {
        values[*k] = body.next(property.type);
        const bool is_needed = *k < 3 || *k >= 8;
        if (is_needed && !std::isfinite(values[*k])) body.fail(fmt::format("vertex {} is not finite", i));
        if (*k >= 8) values[*k] = colour_of(values[*k], property.type);
      } else {
        body.skip(property);
      }
    }
    surface.positions.emplace_back(values[0], values[1], values[2]);
    if (has_coordinates || surface.has_vertex_colours) {
      TexturePoint& point = surface.texture_points.emplace_back();
      if (std::isfinite(values[6]) && std::isfinite(values[7])) point.uv[0] = {values[6], values[7]};
      if (surface.has_vertex_colours)
        for (std::size_t c = 0; c < 3; ++c) point.colour[c] = static_cast<float>(values[8 + c]);
    }
    if (has_normals) surface.normals.push_back(Vec3(values[3], values[4], values[5]).normalized());
  }
}

bool is_vertex_list(const PlyProperty& property) {
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Of a strip: another one begins.
constexpr std::uint32_t kRestart = 0xffffffff;

/// The vertices that element number `i` names; `restarts`: numbers below 0 are kRestart, else refused.
void read_indices(const PlyProperty& property, std::uint64_t vertices, std::uint64_t i, bool restarts,
                  PlyBody& body, std::vector<std::uint32_t>& indices) {
  indices.resize(body.next_list_length(property));
  for (std::uint32_t& index : indices) {
    const double value = body.next(property.type);
    if (!(value < double(vertices)) || value != std::floor(value) || (value < 0 && !restarts))
      body.fail(fmt::format("face {} names vertex {}, but there are {} vertices", i, value, vertices));
    index = value < 0 ? kRestart : static_cast<std::uint32_t>(value);
  }
}

void read_faces(const PlyElement& element, std::uint64_t vertices, PlyBody& body, PlyMesh& mesh) {
  std::uint64_t degenerate = 0;
  std::uint64_t first = 0;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    Face face;
    for (const PlyProperty& property : element.properties) {
      if (is_vertex_list(property)) {
        read_indices(property, vertices, i, false, body, face.outer);
      } else {
        body.skip(property);
      }
    }
    if (face.outer.size() < 3) {
      if (degenerate++ == 0) first = i;
      continue;
    }
    face.source_line = body.line();
    mesh.surface.faces.push_back(std::move(face));
  }
  if (degenerate > 0)
    mesh.warnings.push_back(fmt::format(
        "{} faces of fewer than 3 vertices were left out, the first is face {}", degenerate, first));
  if (std::any_of(element.properties.begin(), element.properties.end(), [](const PlyProperty& property) {
        const auto k = coordinate_of(property);
        return k && *k >= 8;
      }))
    mesh.warnings.push_back("colours of faces are not read, only those of vertices");
}

/// Every three vertices in a row are a triangle, the second and each other after it wound the other way;
/// numbers below 0 begin a new strip.
void read_strips(const PlyElement& element, std::uint64_t vertices, PlyBody& body, PlyMesh& mesh) {
  std::vector<std::uint32_t> strip;
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const PlyProperty& property : element.properties) {
      if (!is_vertex_list(property)) {
        body.skip(property);
        continue;
      }
      read_indices(property, vertices, i, true, body, strip);
      std::size_t begin = 0;
      for (std::size_t k = 0; k < strip.size(); ++k) {
        if (strip[k] == kRestart) begin = k + 1;
        if (k < begin + 2) continue;
        const auto at = [&](std::size_t back) { return strip[k - back]; };
        if (at(0) == at(1) || at(1) == at(2) || at(0) == at(2)) continue;  // turns the strip
        const bool is_turned = (k - begin) % 2 == 1;
        Face face;
        face.outer = {at(is_turned ? 1 : 2), at(is_turned ? 2 : 1), at(0)};
        face.source_line = body.line();
        mesh.surface.faces.push_back(std::move(face));
      }
    }
}

/// Normals are used only where every face has proper ones.
void attach_normals(Surface& surface) {
  const bool proper = surface.normals.size() == surface.positions.size() &&
                      std::all_of(surface.normals.begin(), surface.normals.end(),
                                  [](const Vec3& normal) { return std::abs(normal.norm() - 1) < 1e-6; });
  if (!proper) {
    surface.normals.clear();
    return;
  }
  for (Face& face : surface.faces) face.normals = face.outer;
}

}  // namespace

PlyMesh read_ply(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string bytes = load_file(file);
  const PlyHeader header = read_ply_header(bytes, name);
  const auto vertices = std::find_if(header.elements.begin(), header.elements.end(),
                                     [](const PlyElement& element) { return element.name == "vertex"; });
  if (vertices == header.elements.end()) throw InputError(name, "the file has no vertices", "Export a mesh.");
  PlyBody body(bytes, header, name);
  PlyMesh mesh;
  Surface& surface = mesh.surface;
  surface.source = name;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(element, body, surface);
    } else if (element.name == "face") {
      read_faces(element, vertices->count, body, mesh);
    } else if (element.name == "tristrips") {
      read_strips(element, vertices->count, body, mesh);
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) body.skip(property);
      }
    }
  }
  if (surface.faces.empty())
    throw InputError(name, "the file has no faces", "Export a mesh, not a cloud of points.");
  attach_normals(surface);
  if (!surface.texture_points.empty())
    for (Face& face : surface.faces) face.texture_points = face.outer;
  return mesh;
}

}  // namespace reemit
