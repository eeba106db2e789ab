#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "solver/sky/sky_table.h"

namespace reemit {

/// A packet that comes into the box around the room, in the normalised space.
struct SkyRay {
  Vec3f origin;
  Vec3f direction;  ///< Unit.
};

/// A box around the room whose sides are level or upright as the sky has it, in the normalised space.
struct SkyBox {
  Eigen::Matrix3d axes;  ///< Unit vectors of its edges as rows; the third is up.
  Vec3 low, high;        ///< Along these.

  /// The least box of axes x, y and z where one of them is up, that holds [-1,1] times `extent`; else one
  /// turned about them.
  static SkyBox around(const Vec3& extent, const Vec3& up);
  double face_area(std::size_t face) const;
};

/// Light of the sky through the six sides of the box as four uniform numbers per face: two for the point,
/// two for the direction, such that packets of equal power are uniform in them. Side 2k looks along axis k,
/// side 2k+1 the other way.
class SkyEntry {
 public:
  static constexpr std::size_t kFaces = 6;
  using Numbers = std::array<double, 4>;

  /// `band`: light of that band alone; else of all together. The table must outlive it.
  SkyEntry(const SkyTable& table, const SkyBox& box, std::optional<std::size_t> band);

  /// What comes through a side over its area, summed over the bands that count [W/m2].
  double irradiance(std::size_t face) const { return faces_[face].irradiance; }
  /// Pre: light comes through the face.
  SkyRay start(std::size_t face, const Numbers& u) const;
  /// The face through which light from direction `towards` (unit, room) gets to a point of the room, and its
  /// numbers. Pre: the point is in the box.
  std::size_t invert(const Vec3& point, const Vec3& towards, Numbers& u) const;

 private:
  struct Face {
    double irradiance = 0;
    double azimuth = 0;  // of its normal, in the frame of the sky
    std::vector<double> rows_until;
    std::vector<float> columns_until;
  };
  bool is_upright(std::size_t face) const { return face < 4; }
  double up_sign(std::size_t face) const { return face == 4 ? 1 : -1; }
  /// Between altitudes: the integral of cos^2 (upright faces) or of cos sin.
  double height_measure(std::size_t face, double altitude) const;
  double altitude_of(std::size_t face, double measure, double low, double high) const;
  void clip_altitudes(std::size_t face, std::size_t row, double& low, double& high) const;
  /// Limits of a column, from the normal of an upright face and within its view; else as they are.
  void clip_azimuths(std::size_t face, std::size_t column, double& low, double& high) const;

  const SkyTable* table_;
  SkyBox box_;
  std::array<Face, kFaces> faces_;
};

}  // namespace reemit
