#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

/// What surfaces of each part of the room see of the sky: for each cell of a grid and each of six ways that a
/// surface may face, the share of its view that is sky, and how bright which directions are. Learnt from
/// rays; shadow rays are drawn from it, so that they find a window from deep inside a room.
class SkyView {
 public:
  static constexpr std::size_t kCells = 8;  ///< Along each edge of [-1,1]^3.
  static constexpr std::size_t kRows = 16;  ///< Of directions, by equal steps of the cosine from up.
  static constexpr std::size_t kColumns = 32;
  static constexpr std::size_t kDirections = kRows * kColumns;
  /// Solid angle of a direction's cell [sr]; all are alike.
  static double solid_angle();

  static constexpr std::uint32_t kUnknown = 0xffffffff;
  /// The place of surfaces there that face so (unit). kUnknown where no ray has been sent from.
  std::uint32_t place_of(const Vec3f& x, const Vec3f& normal) const { return places_[key_of(x, normal)]; }
  /// Share of the view that is sky, of a place [0,1].
  double open_share(std::uint32_t place) const {
    return static_cast<double>(escaped_[place]) / static_cast<double>(rays_[place]);
  }
  bool sees_sky(std::uint32_t place) const { return escaped_[place] > 0; }

  /// A direction in the frame of the sky. Pre: sees_sky(place).
  Vec3 sample(std::uint32_t place, double u0, double u1) const;
  double pdf_per_sr(std::uint32_t place, const Vec3& local) const;

  // Learning; finish() comes last.
  std::uint32_t add_place(const Vec3f& x, const Vec3f& normal);
  void add_ray(std::uint32_t place) { ++rays_[place]; }
  /// A ray that left the room, with the brightness that it saw.
  void add_escape(std::uint32_t place, const Vec3& local, float brightness);
  void finish();

  SkyView() : places_(6 * kCells * kCells * kCells, kUnknown) {}

 private:
  static std::size_t key_of(const Vec3f& x, const Vec3f& normal);
  static std::size_t direction_of(const Vec3& local);
  /// Cells that no ray was sent from see what those beside them see: corners of faces lie where cells meet.
  void take_over_from_neighbours();

  std::vector<std::uint32_t> places_;
  std::vector<std::uint32_t> rays_, escaped_;  // by place
  std::vector<float> until_;                   // [place * (kDirections + 1)]; brightness while learning
};

}  // namespace reemit
