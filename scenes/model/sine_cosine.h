#pragma once
#include <bit>
#include <cstdint>

namespace reemit {

struct SineCosine {
  double sine, cosine;
  double versine;  ///< 1 - cosine, right where the angle is small too.
};

/// Of an angle in [-1000, 1000] [rad], sine and cosine within 2^-52; sine and versine of angles up to pi/4 in
/// amount within 2 units in the last place. Without calls and branches, so that loops over lanes stay loops
/// over vectors.
inline SineCosine sine_and_cosine(double x) {
  // Series about the nearest multiple of pi/2, whose number stands in the last bits of the sum with this.
  constexpr double kWhole = 0x1.8p52;
  constexpr double kPerQuarter = 0x1.45f306dc9c883p-1;    // 2/pi
  constexpr double kQuarter = 0x1.921fb544p0;             // pi/2 but for its last bits ...
  constexpr double kQuarterRest = 0x1.0b4611a626331p-34;  // ... which are these
  const double number = x * kPerQuarter + kWhole;
  const auto quarter = std::bit_cast<std::int64_t>(number);
  const double turns = number - kWhole;
  const double r = (x - turns * kQuarter) - turns * kQuarterRest;
  const double y = r * r;
  double s = 1.0 / 6227020800 - y * (1.0 / 1307674368000);
  s = 1.0 / 39916800 - y * s;
  s = 1.0 / 362880 - y * s;
  s = 1.0 / 5040 - y * s;
  s = 1.0 / 120 - y * s;
  s = 1.0 / 6 - y * s;
  s = r - r * (y * s);
  double v = 1.0 / 87178291200 - y * (1.0 / 20922789888000);
  v = 1.0 / 479001600 - y * v;
  v = 1.0 / 3628800 - y * v;
  v = 1.0 / 40320 - y * v;
  v = 1.0 / 720 - y * v;
  v = 1.0 / 24 - y * v;
  v = y * (0.5 - y * v);
  const double c = 1 - v;
  const bool is_odd = (quarter & 1) != 0;
  const double sine = is_odd ? c : s;
  const double cosine = is_odd ? s : c;
  SineCosine result{};
  result.sine = (quarter & 2) != 0 ? -sine : sine;
  result.cosine = ((quarter + 1) & 2) != 0 ? -cosine : cosine;
  result.versine = turns == 0 ? v : 1 - result.cosine;
  return result;
}

}  // namespace reemit
