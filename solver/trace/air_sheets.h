#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/trace/measuring_point.h"

namespace reemit {

class EmbreeTree;

/// Planes in the air through measuring points, each only about its points, that tell which light passes them
/// on its way and let it pass. Points of one plane, such as those of a grid, share a sheet, so that light is
/// told of once for all of them. Const members may be called from any thread.
class AirSheets {
 public:
  /// `reach` > 0: the largest distance from a point that will be asked about [normalised units].
  AirSheets(std::span<const MeasuringPoint> points, float reach);
  ~AirSheets();
  AirSheets(AirSheets&&) noexcept;
  AirSheets& operator=(AirSheets&&) noexcept;

  std::size_t count() const { return sheets_.size(); }
  /// The sheet that a point lies on.
  std::uint32_t sheet_of(std::size_t point) const { return sheet_[point]; }
  const Vec3f& normal(std::uint32_t sheet) const { return sheets_[sheet].normal; }

  struct Crossing {
    std::uint32_t sheet;
    float distance;  ///< Along the ray [normalised units].
  };
  /// Where a ray of unit direction and this length (infinity: without an end) crosses sheets towards their
  /// backs, no farther than `reach` from one of their points; ascending by sheet, each once.
  std::vector<Crossing> crossings(const Vec3f& origin, const Vec3f& direction, float length,
                                  float reach) const;

 private:
  struct Sheet {
    Vec3f normal;
    float offset;  // of its plane along the normal
  };

  std::vector<Sheet> sheets_;
  std::vector<std::uint32_t> sheet_;  // by point
  std::vector<Vec3f> places_;         // by point
  std::unique_ptr<EmbreeTree> embree_;
};

}  // namespace reemit
