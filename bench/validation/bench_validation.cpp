// Measures every reference case and writes the validation page.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include "bench/program_options.h"
#include "bench/validation/cube_convergence.h"
#include "bench/validation/families.h"
#include "bench/validation/plots.h"
#include "bench/validation/report.h"
#include "scenes/model/stopwatch.h"

namespace {

using namespace reemit::validation;

constexpr double kLimit = 4;  // standard errors

void print_row(const ValidationRow& r) {
  fmt::print("  {:<38} {:<34} {:>13.8g} {:>13.8g} +- {:<9.2g} {:>6.2f}\n", r.id, r.method, r.expected,
             r.measured, r.standard_error, r.deviation());
}

/// Measures all rows of the kinds that are asked for; an empty name asks for all.
std::vector<ValidationRow> measure(const std::vector<ReferenceCase>& cases, const std::string& only,
                                   const Effort& effort) {
  std::vector<ValidationRow> all;
  for (const Family& family : families())
    for (const std::string& kind : family.kinds) {
      if (!only.empty() && only != kind) continue;
      const auto start = std::chrono::steady_clock::now();
      const std::vector<ValidationRow> rows = family.evaluate(cases_of(cases, {kind}), effort);
      const double time = reemit::seconds_since(start);
      for (const ValidationRow& r : rows)
        if (!only.empty() || std::fabs(r.deviation()) > kLimit) print_row(r);
      const RowSummary s = summarize(rows);
      fmt::print("{:<22} {:>4} rows, largest deviation {:>5.2f}, standard errors up to {:.3f} %, {:.1f} s\n",
                 kind, s.rows, s.largest_deviation, 100 * s.largest_relative_error, time);
      std::fflush(stdout);
      all.insert(all.end(), rows.begin(), rows.end());
    }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  reemit::bench::ProgramOptions app("Validation against values that are known without Monte Carlo");
  Effort effort;
  std::string only;
  std::string folder;
  app.add_option("--write", folder, "Write validation.md, validation.csv and plots into this folder");
  app.add_option("--only", only, "One kind of cases only; prints its rows");
  app.add_option("--work", effort.work, "Work relative to the full run; errors grow as 1/sqrt(work)")
      .in_range(1e-3, 100.0);
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    if (!folder.empty()) require_gnuplot();
    const std::vector<ReferenceCase> cases = read_reference_cases(reference_cases_path());
    const std::vector<ValidationRow> rows = measure(cases, only, effort);
    const RowSummary s = summarize(rows);
    fmt::print("all {} rows: largest deviation {:.2f}; beyond 3: {} ({:.1f} expected)\n", s.rows,
               s.largest_deviation, s.beyond_3, s.expected_beyond_3);
    if (!folder.empty()) write_report(rows, measure_cube_convergence(cases, effort), folder);
    return s.largest_deviation <= kLimit ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
}
