#pragma once
#include <cstddef>
#include <optional>
#include <vector>

namespace reemit::bench {

/// Median and range of a few values.
struct Spread {
  double median = 0;
  double least = 0;
  double most = 0;
};

/// An even number of values has the mean of the two in the middle as its median. Throws std::invalid_argument
/// without values.
Spread spread_of(std::vector<double> values);

/// One point of a curve of error over time.
struct CurvePoint {
  double seconds = 0;  ///< > 0
  double work = 0;     ///< Rays or samples, > 0.
  double error = 0;    ///< Relative, as a fraction, > 0.
};

/// How a time to an error was found.
enum class Reach {
  kMeasured,      ///< Between two measured points.
  kAtMost,        ///< The first point is below the error already: its time is an upper bound.
  kExtrapolated,  ///< Beyond the last point.
  kNever,         ///< The curve levels off above the error, as far as its points tell. No time.
};

struct TimeToError {
  Reach reach = Reach::kNever;
  double seconds = 0;  ///< Not for kNever.
};

/// Time at which a curve falls to an error, from the first crossing, straight in log-log between points.
/// Beyond the last point it is taken that error^2 = left^2 + c/work, noise that halves with four times the
/// work and a part that stays, and that time grows with work. left follows from the points by least squares
/// of the relative deviation of error^2; c is then chosen to meet the last point. Points in order of time.
/// Throws std::invalid_argument without points.
TimeToError time_to_error(const std::vector<CurvePoint>& curve, double error);

/// The part of the error that stays, as described above; 0 where it is less than half of the least error:
/// that little cannot be told from chance. 0 too where the error still falls with about the root of the work
/// between the last two points: medians of few samples fall slower than that at first.
double remaining_error(const std::vector<CurvePoint>& curve);

/// Slope of log(error) over log(work) by least squares; nothing with fewer than two different amounts of
/// work.
std::optional<double> convergence_rate(const std::vector<CurvePoint>& curve);

/// Error with the noise of the reference taken out in squares; nothing where the reference's error exceeds
/// half of the measured one: it then makes up more than a quarter of the square, and is itself known only so
/// well.
std::optional<double> without_reference(double measured, double reference);

}  // namespace reemit::bench
