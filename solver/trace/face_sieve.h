#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "solver/trace/ray_tracer.h"

namespace reemit {

class EmbreeTree;

/// A few faces of a room, to sort out rays that meet none of them whatever else is in their way: a tree of
/// these alone is passed sooner than that of the whole room. Cut-outs count as if they had no holes. Const
/// members may be called from any thread.
class FaceSieve {
 public:
  /// `chosen`: by triangle. A curved shape counts whole if any patch of it does.
  FaceSieve(const RayTracer& rays, const std::vector<bool>& chosen);
  ~FaceSieve();
  FaceSieve(FaceSieve&&) noexcept;
  FaceSieve& operator=(FaceSieve&&) noexcept;

  /// Which of the first `count` <= 16 rays go through one of the faces, as bits; but for rounding, all that
  /// do.
  std::uint32_t crossed16(const Ray16& rays, int count) const;

 private:
  std::unique_ptr<EmbreeTree> embree_;
};

}  // namespace reemit
