#pragma once
#include <string>
#include <vector>

#include "bench/convergence/curve.h"
#include "bench/convergence/measurement.h"

namespace reemit::bench {

enum class Metric { kRms, kMedian };

/// All seeds of one level: reference noise taken out.
struct Level {
  Spread seconds;
  double work = 0;
  Spread error;
};

/// Error over time of one method in one room. Levels whose error is too near to that of the reference in any
/// seed are left out.
struct Curve {
  std::string room;
  std::string quantity;
  std::string method;
  Metric metric = Metric::kRms;
  std::string work_unit;
  std::vector<Level> levels;
  std::vector<std::vector<CurvePoint>> by_seed;

  std::vector<CurvePoint> medians() const;
};

/// Curves of a quantity, rooms and methods in the order in which they first come in the table.
std::vector<Curve> make_curves(const Table& table, const std::string& quantity, Metric metric);

/// How many times sooner one method reaches an error than another.
struct Factor {
  TimeToError slow;
  TimeToError fast;
  Spread ratio;           ///< Of the times, over seeds.
  bool is_bound = false;  ///< True if the ratio is a lower bound.
};

/// Nothing known (both times never) leaves ratio at 0.
Factor factor_between(const Curve& slow, const Curve& fast, double error);

/// The curve of this name; null if there is none or it has no levels.
const Curve* find_curve(const std::vector<Curve>& curves, const std::string& room, const std::string& method);

}  // namespace reemit::bench
