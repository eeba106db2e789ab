// The geometric entities of the interpreter: arguments to shapes, shapes to faces in the room.
#include <algorithm>
#include <cmath>

#include "scenes/io/mgf/mgf_interpreter.h"
#include "scenes/io/mgf/mgf_shapes.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

constexpr std::size_t kMostArguments = 100'000;  // of one polygon

bool is_curved(std::string_view keyword) {
  return keyword == "sph" || keyword == "cyl" || keyword == "cone" || keyword == "ring" || keyword == "torus";
}

bool is_polygonal(std::string_view keyword) {
  return keyword == "f" || keyword == "fh" || keyword == "prism";
}

/// Arguments of a geometric entity by their place in its line, from 1.
class MgfArguments {
 public:
  MgfArguments(const MgfContexts& contexts, const TextLine& line, const std::string& where)
      : contexts_(contexts), line_(line), where_(where) {}

  const MgfVertex& vertex(std::size_t index) const {
    return contexts_.vertices.find(line_.words[index], where_);
  }
  double number(std::size_t index) const { return mgf_number(line_, index, where_); }

 private:
  const MgfContexts& contexts_;
  const TextLine& line_;
  const std::string& where_;
};

}  // namespace

bool MgfInterpreter::run_geometry(const File& file, const TextLine& line, const std::string& where) {
  const bool curved = is_curved(line.words[0]);
  if (!curved && !is_polygonal(line.words[0])) return false;
  contexts_.check_current_material(where);
  const MgfSceneBuilder::Target target{object_path_, contexts_.materials.current_name(),
                                       contexts_.materials.current(), file.name, line.number};
  if (line.words[0] == "torus") ++tessellated_count_;
  if (curved && line.words[0] != "torus")
    builder_.add(curved_shape_of(line, where), transform_, target);
  else
    builder_.add(faces_of(line, where), transform_, target);
  return true;
}

std::vector<Polygon> MgfInterpreter::faces_of(const TextLine& line, const std::string& where) {
  const std::string_view keyword = line.words[0];
  const MgfArguments given(contexts_, line, where);
  const auto roundness = [&](double radius) {
    const double scale = std::cbrt(std::abs(transform_.linear().determinant()));
    return mgf_roundness(scale * std::abs(radius), contexts_.materials.current().ed.value > 0);
  };
  const std::size_t last = line.words.size() - 1;
  if (keyword == "f") {
    check_argument_count(line, 3, kMostArguments, where);
    return mgf_face({vertices_of(line, 1, last, where)}, where);
  }
  if (keyword == "fh") return face_with_holes(line, where);
  if (keyword == "prism") {
    check_argument_count(line, 4, kMostArguments, where);
    return mgf_prism(vertices_of(line, 1, last - 1, where), given.number(last), where);
  }
  check_argument_count(line, 3, 3, where);
  return mgf_torus(given.vertex(1), given.number(2), given.number(3), roundness(given.number(3)), where);
}

CurvedShape MgfInterpreter::curved_shape_of(const TextLine& line, const std::string& where) {
  const std::string_view keyword = line.words[0];
  const MgfArguments given(contexts_, line, where);
  if (keyword == "sph") {
    check_argument_count(line, 2, 2, where);
    return mgf_sphere(given.vertex(1).position, given.number(2), where);
  }
  if (keyword == "cyl") {
    check_argument_count(line, 3, 3, where);
    return mgf_cone(given.vertex(1).position, given.number(2), given.vertex(3).position, given.number(2),
                    where);
  }
  if (keyword == "cone") {
    check_argument_count(line, 4, 4, where);
    return mgf_cone(given.vertex(1).position, given.number(2), given.vertex(3).position, given.number(4),
                    where);
  }
  check_argument_count(line, 3, 3, where);
  return mgf_ring(given.vertex(1), given.number(2), given.number(3), where);
}

std::vector<MgfVertex> MgfInterpreter::vertices_of(const TextLine& line, std::size_t first, std::size_t last,
                                                   const std::string& where) const {
  std::vector<MgfVertex> vertices;
  for (std::size_t i = first; i <= last; ++i)
    vertices.push_back(contexts_.vertices.find(line.words[i], where));
  return vertices;
}

// fh v1 v2 ... - h1 h2 ... - ...: a single '-' begins the next hole.
std::vector<Polygon> MgfInterpreter::face_with_holes(const TextLine& line, const std::string& where) const {
  check_argument_count(line, 3, kMostArguments, where);
  std::vector<std::vector<MgfVertex>> loops;
  for (std::size_t first = 1; first < line.words.size();) {
    const auto begin = line.words.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = std::find(begin, line.words.end(), "-");
    const auto count = static_cast<std::size_t>(end - begin);
    loops.push_back(count == 0 ? std::vector<MgfVertex>{}
                               : vertices_of(line, first, first + count - 1, where));
    first += count + 1;
  }
  return mgf_face(loops, where);
}

}  // namespace reemit
