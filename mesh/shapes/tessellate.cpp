#include "mesh/shapes/tessellate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/zones/curved_patch.h"

namespace reemit {
namespace {

using Index = std::uint32_t;

/// Collects faces of one shape; corners are given from outside, or in the plane of a disk from the front.
class FaceCollector {
 public:
  FaceCollector(const CurvedShape& shape, bool inward, Surface& surface)
      : shape_(shape), inward_(inward), surface_(surface) {}

  Index vertex(const Vec3& position) {
    const auto index = static_cast<Index>(surface_.positions.size());
    surface_.positions.push_back(position);
    return index;
  }

  void face(std::vector<Index> outer, bool smooth) {
    if (inward_) std::reverse(outer.begin(), outer.end());
    Face face;
    face.outer = std::move(outer);
    if (smooth)
      for (const Index corner : face.outer) {
        face.normals.push_back(static_cast<Index>(surface_.normals.size()));
        surface_.normals.push_back(shape_.normal_at(surface_.positions[corner]));
      }
    surface_.faces.push_back(std::move(face));
  }

  void ring(std::vector<Index> outer, std::vector<Index> hole) {
    Face face;
    face.outer = std::move(outer);
    face.holes.push_back(std::move(hole));
    surface_.faces.push_back(std::move(face));
  }

 private:
  CurvedPatches shape_;
  bool inward_;
  Surface& surface_;
};

void append_sphere(const Sphere& s, int segments, Surface& surface) {
  FaceCollector faces(s, s.inward, surface);
  const int rings = segments / 2;
  std::vector<std::vector<Index>> rows;
  for (int ring = 0; ring <= rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    const bool pole = ring == 0 || ring == rings;
    auto& row = rows.emplace_back();
    for (int i = 0; i < (pole ? 1 : segments); ++i) {
      const double azimuth = 2 * std::numbers::pi * i / segments;
      const double r = pole ? 0 : std::sin(polar);
      row.push_back(faces.vertex(
          s.centre + s.radius * Vec3(r * std::sin(azimuth), std::cos(polar), r * std::cos(azimuth))));
    }
  }
  for (std::size_t ring = 0; ring + 1 < rows.size(); ++ring) {
    const auto& above = rows[ring];
    const auto& below = rows[ring + 1];
    for (std::size_t i = 0; i < static_cast<std::size_t>(segments); ++i) {
      const std::size_t next = (i + 1) % static_cast<std::size_t>(segments);
      if (above.size() == 1)
        faces.face({above[0], below[i], below[next]}, true);
      else if (below.size() == 1)
        faces.face({above[i], below[0], above[next]}, true);
      else
        faces.face({above[i], below[i], below[next], above[next]}, true);
    }
  }
}

}  // namespace

void append_faces(const CurvedShape& shape, int segments, Surface& surface) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return append_sphere(*sphere, segments, surface);
  const Frustum f = frustum_of(shape);
  FaceCollector faces(shape, f.inward, surface);
  const auto circle = [&](double height, double radius) {
    std::vector<Index> loop;
    for (int i = 0; i < (radius > 0 ? segments : 1); ++i) {
      const double azimuth = 2 * std::numbers::pi * i / segments;
      loop.push_back(faces.vertex(f.base + height * f.axis +
                                  radius * (std::cos(azimuth) * f.u + std::sin(azimuth) * f.v)));
    }
    return loop;
  };
  const std::vector<Index> wide = circle(0, f.r0);
  if (f.height == 0) {
    if (f.r1 > 0)
      faces.ring(wide, circle(0, f.r1));
    else
      faces.face(wide, false);
    return;
  }
  const std::vector<Index> narrow = circle(f.height, f.r1);
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const std::size_t next = (i + 1) % wide.size();
    if (narrow.size() == 1)
      faces.face({wide[i], wide[next], narrow[0]}, true);
    else
      faces.face({wide[i], wide[next], narrow[next], narrow[i]}, true);
  }
}

}  // namespace reemit
