#include "viewer_export/inspection/picture_object.h"

#include <bit>
#include <cmath>

#include <boost/container_hash/hash.hpp>

#include "scenes/io/common/srgb.h"

namespace reemit {

static_assert(sizeof(PictureObject::Vertex) == 16);

Rgba rgba_of_srgb(double r, double g, double b) {
  const auto byte = [](double srgb) {
    return static_cast<std::uint8_t>(std::lround(255 * linear_from_srgb(srgb)));
  };
  return {byte(r), byte(g), byte(b), 255};
}

std::size_t PictureObject::KeyHash::operator()(const Key& key) const {
  return boost::hash_range(key.begin(), key.end());
}

std::uint32_t PictureObject::vertex_at(const Vec3& p, const Rgba& colour) {
  const Eigen::Vector3f at = (p - origin_).cast<float>().array() + 0.0F;  // one sign of zero
  const Vertex vertex{{at.x(), at.y(), at.z()}, colour};
  const auto [known, is_new] =
      known_.try_emplace(std::bit_cast<Key>(vertex), static_cast<std::uint32_t>(vertices_.size()));
  if (is_new) vertices_.push_back(vertex);
  return known->second;
}

void PictureObject::add_triangle(const std::array<Vec3, 3>& corners, const Rgba& colour) {
  const std::uint32_t a = vertex_at(corners[0], colour);
  const std::uint32_t b = vertex_at(corners[1], colour);
  const std::uint32_t c = vertex_at(corners[2], colour);
  if (a != b && b != c && c != a) indices_.insert(indices_.end(), {a, b, c});
}

void PictureObject::add_line(const Vec3& from, const Vec3& to, const Rgba& colour) {
  has_lines_ = true;
  indices_.push_back(vertex_at(from, colour));
  indices_.push_back(vertex_at(to, colour));
}

}  // namespace reemit
