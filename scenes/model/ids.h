#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

namespace reemit {

/// Index that belongs to one kind of thing only, so that a zone is never taken for a surface.
template <class Tag>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(std::size_t index) : value_(static_cast<std::uint32_t>(index)) {}
  constexpr std::size_t index() const { return value_; }
  constexpr bool valid() const { return value_ != std::numeric_limits<std::uint32_t>::max(); }
  constexpr auto operator<=>(const Id&) const = default;

 private:
  std::uint32_t value_ = std::numeric_limits<std::uint32_t>::max();
};

using MaterialId = Id<struct MaterialTag>;
using SurfaceId = Id<struct SurfaceTag>;
using ZoneId = Id<struct ZoneTag>;
using TriangleId = Id<struct TriangleTag>;  ///< A base triangle: what rays are traced against.

}  // namespace reemit
