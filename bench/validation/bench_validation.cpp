// Measures every reference case that applies to diffuse rooms and writes the validation page.

#include <chrono>
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/validation/families.h"

int main(int argc, char** argv) {
  using namespace reemit::validation;
  CLI::App app("Validation against values that are known without Monte Carlo");
  Effort effort;
  std::string only;
  app.add_option("--work", effort.work, "Work relative to the full run")->check(CLI::Range(1e-3, 100.0));
  app.add_option("--only", only, "One kind only, rows to standard output");
  CLI11_PARSE(app, argc, argv);
  const auto cases = read_reference_cases(reference_cases_path());
  for (const Family& f : families()) {
    for (const std::string& kind : f.kinds) {
      if (!only.empty() && only != kind) continue;
      const auto start = std::chrono::steady_clock::now();
      const auto rows = f.evaluate(cases_of(cases, {kind}), effort);
      const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      double worst = 0, rel = 0;
      for (const auto& r : rows) {
        worst = std::max(worst, std::fabs(r.deviation()));
        rel = std::max(rel, r.relative_error());
        if (!only.empty() || std::fabs(r.deviation()) > 3.5)
          fmt::print("  {:<40} {:<28} {:>12.7g} {:>12.7g} se {:>8.2e} dev {:6.2f}\n", r.id, r.method,
                     r.expected, r.measured, r.standard_error, r.deviation());
      }
      fmt::print("{:<28} rows {:4} worst {:6.2f} rel {:.4f} {:6.1f} s\n", kind, rows.size(), worst, rel, s);
      std::fflush(stdout);
    }
  }
  return 0;
}
