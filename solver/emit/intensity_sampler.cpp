#include "solver/emit/intensity_sampler.h"

#include <cmath>
#include <cstdint>

#include "scenes/model/instruction_sets.h"
#include "scenes/model/sine_cosine.h"

namespace reemit {
namespace {

/// As std::clamp to [0,1], which hands on references and keeps loops from becoming vectors.
inline double to_unit_interval(double x) {
  const double below = x < 1 ? x : 1;
  return below > 0 ? below : 0;
}

inline double root_of_positive(double x) {
  return std::sqrt(x > 0 ? x : 0);
}

/// In each lane a linear function times the sine, over a cell of polar angles.
struct alignas(64) PolarCells {
  double width[16];             // [rad]
  double sine[16], cosine[16];  // where it begins
  double f[16], slope[16];      // of the linear function, where it begins, and per radian
  double wanted[16];            // the integral up to the angle that is sought
  double angle[16];             // from where the cell begins [rad]
};

/// Finds the angles. The first guess takes the integrand as linear between the ends of the cell, which costs
/// one root. Newton steps that leave the bracket are replaced by its middle; each squares the error, so the
/// last one leaves some 1e-8 of the width or less. Lanes that are there wait for the others.
inline void invert_polar(PolarCells& __restrict cells, const double* __restrict whole,
                         const double* __restrict end_sine) {
  constexpr int kMostSteps = 60;
  constexpr double kEnough = 1e-4;
  alignas(64) double low[16];
  alignas(64) double high[16];
  alignas(64) std::int64_t moves[16];
  for (int i = 0; i < 16; ++i) {
    const double begin = cells.f[i] * cells.sine[i];
    const double end = (cells.f[i] + cells.slope[i] * cells.width[i]) * end_sine[i];
    const double share = whole[i] > 0 ? to_unit_interval(cells.wanted[i] / whole[i]) : 0.5;
    const double root = root_of_positive(begin * begin + share * (end * end - begin * begin));
    const double sum = begin + root;
    cells.angle[i] = cells.width[i] * (sum > 0 ? share * (begin + end) / sum : share);
    low[i] = 0;
    high[i] = cells.width[i];
    moves[i] = 1;
  }
  for (int step = 0; step < kMostSteps; ++step) {
    std::int64_t any_moves = 0;
    for (int i = 0; i < 16; ++i) {
      const double x = cells.angle[i];
      const SineCosine of = sine_and_cosine(x);
      // The integrals of sin(a + x) and of x sin(a + x), about a.
      const double constant = cells.cosine[i] * of.versine + cells.sine[i] * of.sine;
      const double linear =
          cells.cosine[i] * (of.sine - x * of.cosine) + cells.sine[i] * (x * of.sine - of.versine);
      const double excess = cells.f[i] * constant + cells.slope[i] * linear - cells.wanted[i];
      high[i] = excess > 0 ? x : high[i];
      low[i] = excess > 0 ? low[i] : x;
      const double density =
          (cells.f[i] + cells.slope[i] * x) * (cells.sine[i] * of.cosine + cells.cosine[i] * of.sine);
      const double newton = density > 0 ? x - excess / density : low[i];
      const double middle = 0.5 * (low[i] + high[i]);
      const double above = newton > low[i] ? newton : middle;
      const double next = newton < high[i] ? above : middle;
      const double moved = std::fabs(next - x);
      cells.angle[i] = moves[i] != 0 ? next : x;
      moves[i] = moved > kEnough * cells.width[i] ? moves[i] : 0;
      any_moves |= moves[i];
    }
    if (any_moves == 0) return;
  }
}

}  // namespace

REEMIT_FOR_INSTRUCTION_SETS
void sample_intensity16(const IntensityTable& table, const SquarePoints16& __restrict at,
                        Directions16& __restrict to) {
  using Index = std::int64_t;  // as wide as the numbers that it finds
  const auto rows = static_cast<Index>(table.polar().size());
  const Index last = static_cast<Index>(table.azimuth().size()) - 1;
  const double* const polar = table.polar().data();
  const double* const azimuth = table.azimuth().data();
  const double* const candela = table.candela().data();
  const double* const polar_sine = table.polar_sines().data();
  const double* const polar_cosine = table.polar_cosines().data();
  const double* const flux_below = table.flux_below().data();
  const double* const integral = table.azimuth_integrals().data();
  const double total_flux = table.total_flux();

  alignas(64) Index row[16];
  alignas(64) double wanted[16];
  for (int i = 0; i < 16; ++i) {
    wanted[i] = at.u0[i] * total_flux;
    row[i] = 0;
  }
  // Halves as large for all lanes alike; which of the two it is nothing could predict, so it is no branch.
  for (Index left = rows - 1; left > 1; left -= left / 2)
    for (int i = 0; i < 16; ++i) {
      const Index middle = row[i] + left / 2;
      const double below = flux_below[middle];
      const bool is_below = below <= wanted[i];
      row[i] = is_below ? middle : row[i];
    }
  PolarCells cells;
  alignas(64) double whole[16];
  alignas(64) double end_sine[16];
  for (int i = 0; i < 16; ++i) {
    const Index k = row[i];
    cells.width[i] = polar[k + 1] - polar[k];
    cells.sine[i] = polar_sine[k];
    cells.cosine[i] = polar_cosine[k];
    end_sine[i] = polar_sine[k + 1];
    cells.f[i] = integral[last * rows + k];
    cells.slope[i] = (integral[last * rows + k + 1] - cells.f[i]) / cells.width[i];
    cells.wanted[i] = wanted[i] - flux_below[k];
    whole[i] = flux_below[k + 1] - flux_below[k];
  }
  invert_polar(cells, whole, end_sine);

  // The line integrals over azimuths at a polar angle between two grid lines.
  alignas(64) double share[16];
  alignas(64) double begin[16];  // that up to the first line of the cell
  alignas(64) Index column[16];
  for (int i = 0; i < 16; ++i) {
    share[i] = to_unit_interval(cells.angle[i] / cells.width[i]);
    const Index k = last * rows + row[i];
    wanted[i] = at.u1[i] * ((1 - share[i]) * integral[k] + share[i] * integral[k + 1]);
    begin[i] = (1 - share[i]) * integral[row[i]] + share[i] * integral[row[i] + 1];
    column[i] = 0;
  }
  for (Index left = last; left > 1; left -= left / 2)
    for (int i = 0; i < 16; ++i) {
      const Index middle = column[i] + left / 2;
      const Index k = middle * rows + row[i];
      const double upto = (1 - share[i]) * integral[k] + share[i] * integral[k + 1];
      const bool is_below = upto <= wanted[i];
      column[i] = is_below ? middle : column[i];
      begin[i] = is_below ? upto : begin[i];
    }
  const GoniometerAxes& axes = table.axes();
  for (int i = 0; i < 16; ++i) {
    const Index k = column[i] * rows + row[i];
    const double f0 = (1 - share[i]) * candela[k] + share[i] * candela[k + 1];
    const double f1 = (1 - share[i]) * candela[k + rows] + share[i] * candela[k + rows + 1];
    const double width = azimuth[column[i] + 1] - azimuth[column[i]];
    // Solves f0 t + (f1 - f0) t^2 / 2 = rest for t in [0,1]; the form that does not cancel.
    const double over = (wanted[i] - begin[i]) / width;
    const double rest = over > 0 ? over : 0;
    const double sum = f0 + root_of_positive(f0 * f0 + 2 * (f1 - f0) * rest);
    const double t = sum > 0 ? 2 * rest / sum : 0.5;
    const SineCosine turn = sine_and_cosine(azimuth[column[i]] + to_unit_interval(t) * width);
    const SineCosine of = sine_and_cosine(cells.angle[i]);
    const double sine = cells.sine[i] * of.cosine + cells.cosine[i] * of.sine;
    const double cosine = cells.cosine[i] * of.cosine - cells.sine[i] * of.sine;
    const double zero = sine * turn.cosine;
    const double ninety = sine * turn.sine;
    to.x[i] = cosine * axes.pole.x() + zero * axes.zero.x() + ninety * axes.ninety.x();
    to.y[i] = cosine * axes.pole.y() + zero * axes.zero.y() + ninety * axes.ninety.y();
    to.z[i] = cosine * axes.pole.z() + zero * axes.zero.z() + ninety * axes.ninety.z();
  }
}

Vec3 sample_intensity(const IntensityTable& table, double u0, double u1) {
  SquarePoints16 at{};
  at.u0[0] = u0;
  at.u1[0] = u1;
  Directions16 to;
  sample_intensity16(table, at, to);
  return to.direction(0);
}

}  // namespace reemit
