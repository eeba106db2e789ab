#pragma once
#include <array>
#include <cstddef>

#include "scenes/model/vec.h"

namespace reemit {

/// What a disk or the mantle of a cylinder is to a point x at the origin, in cylinder coordinates about its
/// axis through x. Heights are along the axis.
struct RoundRegion {
  enum class Kind {
    kDisk,      ///< Disk at height `low` > 0.
    kNearSide,  ///< Mantle from `low` to `high`, x outside, its outside.
    kFarSide,   ///< The same, its inside, x inside or looking in through an end past the near side.
  };
  Kind kind;
  double offset;     ///< Distance of x from the axis of the shape [m].
  double radius;     ///< [m]
  double low, high;  ///< [m]
};

/// Directions from x to a disk or the mantle of a cylinder above the horizon of x, by azimuth and elevation
/// about the axis of the shape: at a given azimuth it covers one interval of elevation, in which both solid
/// angle and cos(theta) d omega have closed-form integrals. The azimuth is drawn from a density that is
/// linear between nodes where it is proportional to these integrals; as it is known exactly, so is the
/// density of the whole.
class AzimuthElevation {
 public:
  struct Direction {
    Vec3 unit{0, 0, 1};     ///< Direction from x.
    double distance = 0;    ///< From the axis through x to the shape [m].
    double pdf_per_sr = 0;  ///< [1/sr]
    double irradiance = 0;  ///< cos(theta) / pdf_per_sr [sr].
  };

  /// `axis`: unit; `towards`: unit, at right angles to it, from x to the axis of the shape. `n`: unit normal
  /// at x. `cosine`: weighted with cos(theta).
  AzimuthElevation(const RoundRegion& region, const Vec3& axis, const Vec3& towards, const Vec3& n,
                   bool cosine);

  /// About the integral [sr], by the trapezoidal rule; 0 if no node sees anything.
  double total() const { return total_; }
  Direction sample(double u0, double u1) const;
  /// Density at a unit direction that meets the region.
  double pdf_per_sr(const Vec3& direction) const;
  std::array<double, 2> invert(const Vec3& direction) const;

 private:
  /// Cosine and sine of the elevation at both ends, c >= 0; empty if s0 >= s1.
  struct Span {
    double c0, s0, c1, s1;
    bool empty = true;
  };
  struct Azimuth {
    double c, s;       // cosine and sine
    double jacobian;   // d azimuth / d parameter
    double near, far;  // distances of the circle, near = 0 where x is inside it
  };

  Azimuth azimuth(double parameter) const;
  Azimuth azimuth(double parameter_c, double parameter_s) const;
  double parameter_of(const Vec3& direction) const;
  double radial_part(const Azimuth& a) const { return a.c * n1_ + a.s * n2_; }
  /// Sets `cut` where the horizon, or the shape itself, takes something away.
  Span span(const Azimuth& a, bool& cut) const;
  double weight(const Azimuth& a, const Span& e) const;
  double cosine_to(double n_r, const Span& e, double c, double s, double angle) const;
  double density(double parameter) const;

  static constexpr std::size_t kMostNodes = 17;
  RoundRegion region_;
  Vec3 axis_, e1_, e2_;
  double n1_, n2_, n3_;  // n in the frame (e1, e2, axis)
  bool cosine_;
  bool around_;  // x is inside the circle: the parameter is the azimuth
  bool slim_;    // a mantle that is slim as seen from x: the parameter is the place across it, -1 to 1
  double start_ = 0, step_ = 0;  // of the parameter
  std::size_t cells_ = 0;
  double total_ = 0;
  std::array<double, kMostNodes> node_;   // density, times total
  std::array<double, kMostNodes> up_to_;  // integral before the node
};

}  // namespace reemit
