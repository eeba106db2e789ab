#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

/// What of the sky is seen in each part of the room: for each cell of a grid and each of six ways to face,
/// the share of the view that is sky, and how bright which directions are. Learnt from rays that start on
/// surfaces and in the air; shadow rays are drawn from it, so that they find a window from deep inside a
/// room. What few rays have told, for legs of a table are small, is completed by what surfaces see that face
/// alike 2, 4 and 8 cells around. Points where no surface is see what the air sees, which tells little of a
/// surface: the air of a cell may be that on the other side of a wall.
class SkyView {
 public:
  static constexpr std::size_t kCells = 8;  ///< Along each edge of [-1,1]^3.
  static constexpr std::size_t kFacings = 6;
  static constexpr std::size_t kRows = 16;  ///< Of directions, by equal steps of the cosine from up.
  static constexpr std::size_t kColumns = 32;
  static constexpr std::size_t kDirections = kRows * kColumns;
  /// Solid angle of a direction's cell [sr]; all are alike.
  static double solid_angle();

  static constexpr std::uint32_t kUnknown = 0xffffffff;
  /// The place of what is there and faces so (unit). kUnknown where no ray has been sent
  /// from; after finish() nowhere.
  std::uint32_t place_of(const Vec3f& x, const Vec3f& normal) const { return places_[key_of(x, normal)]; }
  /// Share of the view that is sky, of a place [0,1].
  double open_share(std::uint32_t place) const {
    return static_cast<double>(escaped_[place]) / static_cast<double>(rays_[place]);
  }
  /// Whether rays have met light. Then every place has directions; else none has.
  bool sees_sky() const { return sees_sky_; }

  /// A direction in the frame of the sky. Pre: finish() was called, sees_sky().
  Vec3 sample(std::uint32_t place, double u0, double u1) const;
  double pdf_per_sr(std::uint32_t place, const Vec3& local) const;

  // Learning: surfaces, then the air; finish() comes last.

  std::uint32_t add_place(const Vec3f& x, const Vec3f& normal);
  /// The place of the air in a cell that faces so. Pre: add_air().
  std::uint32_t place_in_air(std::size_t cell, std::size_t facing) const {
    return first_of_air_ + static_cast<std::uint32_t>(kFacings * cell + facing);
  }
  /// Makes the places of the air. Rays of different places may then be added from different threads.
  void add_air();
  void add_ray(std::uint32_t place) { ++rays_[place]; }
  /// A ray that left the room, with the brightness that it saw.
  void add_escape(std::uint32_t place, const Vec3& local, float brightness);
  /// Pre: add_air().
  void finish();

  /// The lower corner of a cell; its edges are 2 / kCells long.
  static Vec3f corner_of(std::size_t cell);
  /// A way to face.
  static Vec3f normal_of(std::size_t facing);

  SkyView() : places_(kFacings * kCells * kCells * kCells, kUnknown) {}

 private:
  static std::size_t key_of(const Vec3f& x, const Vec3f& normal);
  static std::size_t direction_of(const Vec3& local);
  /// Of the parts of the room that are some cells wide, for each way to face.
  static std::size_t part_of(std::size_t key, std::size_t width);
  std::uint32_t new_place();
  /// Of surfaces beside a cell that face alike; kUnknown where there are none.
  std::uint32_t neighbour(std::size_t key) const;
  /// What the rays of `from` have told, to `to` as well.
  void add_rays_of(std::uint32_t from, std::uint32_t to);
  /// For each key the place that knows what surfaces see in the smallest part around that has some, complete.
  std::vector<std::uint32_t> look_around();
  /// From what was counted by direction to shares; no ray that met darkness alone has escaped.
  void normalise(std::uint32_t place);
  /// Shares of both, weighed by `of_own` and 1 - of_own.
  void mix(std::uint32_t place, std::uint32_t with, double of_own);
  /// Mixes in what is around for what few rays cannot tell.
  void complete(std::uint32_t place, std::uint32_t around);
  void accumulate(std::uint32_t place);

  std::vector<std::uint32_t> places_;
  std::vector<std::uint32_t> rays_, escaped_;  // by place
  std::vector<float> until_;                   // [place * (kDirections + 1)]; brightness while learning
  std::uint32_t first_of_air_ = 0;
  bool sees_sky_ = false;
};

}  // namespace reemit
