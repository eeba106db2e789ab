#include "scenes/io/obj/obj_geometry.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "scenes/io/common/text_file.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t kLargestObj = std::uintmax_t{2} << 30;
constexpr std::size_t kMostWarnings = 20;

// First pass: checks every line, follows names and materials, and leaves clean v, vn and f lines for
// tinyobjloader.
class ObjChecker {
 public:
  ObjChecker(const fs::path& file, ObjMaterials& materials, ObjGeometry& geometry)
      : file_(file), materials_(materials), geometry_(geometry) {}

  std::string clean(const std::string& text) {
    geometry_.groups.emplace_back();
    for (const TextLine& line : split_lines(text)) check(line);
    return std::move(clean_);
  }

 private:
  void check(const TextLine& line) {
    const std::string_view keyword = line.words[0];
    if (keyword[0] == '#') return;
    where_ = at_line(file_.string(), line.number);
    if (keyword == "v" || keyword == "vn") {
      check_numbers(line);
    } else if (keyword == "vt") {
      check_texture_point(line);
    } else if (keyword == "f") {
      check_face(line);
    } else if (keyword == "usemtl") {
      use_material(line);
    } else if (keyword == "mtllib") {
      load_materials(line);
    } else if (keyword == "g" || keyword == "o") {
      name_group(line);
    } else {
      warn_of(keyword);
    }
  }

  // Before a comment, if one follows; all must be numbers.
  std::size_t count_numbers(const TextLine& line) const {
    std::size_t count = 0;
    for (std::size_t i = 1; i < line.words.size() && line.words[i][0] != '#'; ++i, ++count)
      if (!parse_number(line.words[i]))
        throw InputError(where_, fmt::format("'{}' is not a finite number", line.words[i]),
                         line.words[i].find(',') != std::string_view::npos
                             ? "Write numbers with a decimal point."
                             : "Was the file cut off?");
    return count;
  }

  // x y z, then anything numeric: w, or a colour some programs add.
  void check_numbers(const TextLine& line) {
    const std::size_t count = count_numbers(line);
    if (line.words[0] == "v" && count >= 3) {
      const std::string problem = place_problem(
          {*parse_number(line.words[1]), *parse_number(line.words[2]), *parse_number(line.words[3])});
      if (!problem.empty()) throw InputError(where_, problem, kLengthAdvice);
    }
    if (count < 3 || count > 7 || (line.words[0] == "vn" && count != 3))
      throw InputError(where_, fmt::format("'{}' has {} numbers", line.words[0], count), "Give x, y and z.");
    clean_ += fmt::format("{} {} {} {}\n", line.words[0], line.words[1], line.words[2], line.words[3]);
  }

  // u, then v and w or not.
  void check_texture_point(const TextLine& line) {
    const std::size_t count = count_numbers(line);
    if (count < 1 || count > 3)
      throw InputError(where_, fmt::format("'vt' has {} numbers", count), "Give u and v.");
    clean_ += fmt::format("vt {} {}\n", line.words[1], count > 1 ? line.words[2] : "0");
  }

  void check_face(const TextLine& line) {
    std::size_t corners = 0;
    clean_ += 'f';
    for (std::size_t i = 1; i < line.words.size() && line.words[i][0] != '#'; ++i, ++corners) {
      clean_ += fmt::format(" {}", checked_corner(line.words[i]));
    }
    clean_ += '\n';
    if (corners == 0)
      throw InputError(where_, "a face without corners", "Was the file cut off? A face needs at least 3.");
    if (!material_) material_ = materials_.index_of("", where_);
    ObjFace face;
    face.group = group_;
    face.material = *material_;
    face.line = line.number;
    geometry_.faces.push_back(std::move(face));
  }

  // v, v/vt, v//vn or v/vt/vn; indices from 1 or, from the end, from -1. Some programs leave the slashes of
  // what a corner has not. Returns the corner without those.
  std::string_view checked_corner(std::string_view word) const {
    const std::string_view corner = word.substr(0, word.find_last_not_of('/') + 1);
    std::array<std::string_view, 3> parts;
    std::size_t count = 0;
    for (std::string_view rest = corner;; ++count) {
      const std::size_t slash = rest.find('/');
      if (count < 3) parts[count] = rest.substr(0, slash);
      if (slash == std::string_view::npos) break;
      rest.remove_prefix(slash + 1);
    }
    bool good = count < 3 && (count != 2 || !parts[2].empty());
    for (std::size_t i = 0; i <= count && good; ++i) {
      if (parts[i].empty() && i == 1 && count == 2) continue;
      const auto index = parse_integer(parts[i]);
      constexpr std::int64_t kMost = 2'000'000'000;
      good = index && *index != 0 && *index <= kMost && *index >= -kMost;
    }
    if (!good)
      throw InputError(where_, fmt::format("'{}' is not a corner of a face", word),
                       "Write v, v/vt, v//vn or v/vt/vn with indices from 1 (or from -1, backwards).");
    return corner;
  }

  void use_material(const TextLine& line) { material_ = materials_.index_of(rest_of(line, 1), where_); }

  // A list of files, or one whose name has blanks.
  void load_materials(const TextLine& line) {
    if (line.words.size() < 2) throw InputError(where_, "'mtllib' names no file", "Name the MTL file.");
    const fs::path folder = file_.parent_path();
    std::vector<std::string> names = {rest_of(line, 1)};
    std::error_code ignored;
    if (!fs::exists(folder / names[0], ignored)) names.assign(line.words.begin() + 1, line.words.end());
    for (std::string& name : names) {
      std::replace(name.begin(), name.end(), '\\', '/');
      if (libraries_.insert(name).second) materials_.read(folder, name, where_);
    }
  }

  void name_group(const TextLine& line) {
    const std::string name = rest_of(line, 1);
    if (line.words[0] == "o") object_ = name;
    const std::string group = line.words[0] == "g" && name != "default" ? name : "";
    const std::string full = object_ + (object_.empty() || group.empty() ? "" : "/") + group;
    const auto [entry, added] = group_indices_.try_emplace(full, geometry_.groups.size());
    if (added) geometry_.groups.push_back(full);
    group_ = entry->second;
  }

  void warn_of(std::string_view keyword) {
    static constexpr std::array kHarmless = {"s", "usemap", "maplib", "lod", "bevel", "c_interp", "d_interp"};
    if (std::find(kHarmless.begin(), kHarmless.end(), keyword) != kHarmless.end()) return;
    ++geometry_.ignored_statements;
    if (warned_.size() >= kMostWarnings || !warned_.emplace(keyword).second) return;
    geometry_.warnings.push_back(fmt::format(
        "{}: '{}' is ignored here and wherever it comes again; only polygons are read.", where_, keyword));
  }

  const fs::path& file_;
  ObjMaterials& materials_;
  ObjGeometry& geometry_;
  std::string where_, clean_, object_;
  std::map<std::string, std::size_t> group_indices_{{"", 0}};
  std::set<std::string> libraries_, warned_;
  std::size_t group_ = 0;
  std::optional<std::size_t> material_;
};

// What the callbacks of tinyobjloader fill; faces come in the order of the first pass.
struct Loading {
  ObjGeometry& geometry;
  const std::string& file;
  std::size_t next_face = 0;
};

std::uint32_t absolute(int index, std::size_t count, const Loading& loading, const ObjFace& face) {
  const std::int64_t value = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
  if (value < 0)
    throw InputError(at_line(loading.file, face.line), fmt::format("index {} is out of range", index),
                     fmt::format("There are {} vertices so far.", count));
  return static_cast<std::uint32_t>(value);
}

// Of a normal or texture coordinate. What refers to none leaves the face without: it still has a shape.
std::uint32_t optional_index(int index, std::size_t count) {
  const std::int64_t value = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
  return value < 0 ? 0xffffffffU : static_cast<std::uint32_t>(value);
}

void add_face(void* user, tinyobj::index_t* corners, int count) {
  auto& loading = *static_cast<Loading*>(user);
  ObjGeometry& geometry = loading.geometry;
  ObjFace& face = geometry.faces.at(loading.next_face++);
  for (int i = 0; i < count; ++i) {
    face.positions.push_back(absolute(corners[i].vertex_index, geometry.positions.size(), loading, face));
    if (corners[i].texcoord_index != 0)
      face.texture_points.push_back(
          optional_index(corners[i].texcoord_index, geometry.texture_points.size()));
    if (corners[i].normal_index != 0)
      face.normals.push_back(optional_index(corners[i].normal_index, geometry.normals.size()));
  }
}

// Positive indices may point forward, so their range is known at the end only.
// Faces that have normals at some corners only become flat, those with texture coordinates at some have none.
void check_ranges(ObjGeometry& geometry, const std::string& file) {
  const auto any_beyond = [](const std::vector<std::uint32_t>& indices, std::size_t count) {
    return std::any_of(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= count; });
  };
  std::size_t without = 0;  // faces that refer to normals which are not there
  std::uint32_t first = 0;
  for (ObjFace& face : geometry.faces) {
    for (const std::uint32_t index : face.positions)
      if (index >= geometry.positions.size())
        throw InputError(at_line(file, face.line), fmt::format("index {} is out of range", index + 1),
                         fmt::format("The file has {} vertices.", geometry.positions.size()));
    if (any_beyond(face.texture_points, geometry.texture_points.size()) ||
        face.texture_points.size() != face.positions.size())
      face.texture_points.clear();
    const bool no_normals = any_beyond(face.normals, geometry.normals.size());
    if (no_normals && without++ == 0) first = face.line;
    if (no_normals || face.normals.size() != face.positions.size()) face.normals.clear();
  }
  if (without > 0)
    geometry.warnings.push_back(
        fmt::format("{}: {} face(s) refer to a vn that the file has not and are flat, the first in line {}.",
                    file, without, first));
}

}  // namespace

ObjGeometry read_obj_geometry(const fs::path& file, ObjMaterials& materials) {
  ObjGeometry geometry;
  const std::string name = file.string();
  std::istringstream stream(ObjChecker(file, materials, geometry).clean(load_file(file, kLargestObj)));
  Loading loading{geometry, name};
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* user, double x, double y, double z, double) {
    static_cast<Loading*>(user)->geometry.positions.emplace_back(x, y, z);
  };
  callbacks.normal_cb = [](void* user, double x, double y, double z) {
    static_cast<Loading*>(user)->geometry.normals.emplace_back(x, y, z);
  };
  callbacks.texcoord_cb = [](void* user, double x, double y, double) {
    static_cast<Loading*>(user)->geometry.texture_points.push_back({x, y});
  };
  callbacks.index_cb = add_face;
  tinyobj::LoadObjWithCallback(stream, callbacks, &loading);
  check_ranges(geometry, name);
  return geometry;
}

}  // namespace reemit
