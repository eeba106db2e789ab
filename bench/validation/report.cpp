#include "bench/validation/report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "bench/validation/families.h"
#include "bench/validation/plots.h"
#include "scenes/model/error.h"

namespace reemit::validation {
namespace {

const std::filesystem::path kSources = REEMIT_SOURCE_DIR "/bench/validation";

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw ResourceError(path.string(), "cannot be read", "Run from a complete source tree.");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw ResourceError(path.string(), "cannot be written", "Is the folder there and writable?");
}

void put(std::string& page, const std::string& place, const std::string& text) {
  const std::string mark = "{{" + place + "}}";
  const std::size_t at = page.find(mark);
  if (at == std::string::npos)
    throw ResourceError((kSources / "page.md.in").string(), "has no " + mark, "Restore it.");
  page.replace(at, mark.size(), text);
}

std::string csv(const std::vector<ValidationRow>& rows) {
  std::string text =
      "id,kind,method,expected,expected_abs_err,measured,standard_error,numerical_bound,degrees_of_freedom,"
      "deviation\n";
  for (const ValidationRow& r : rows)
    text += fmt::format("\"{}\",{},\"{}\",{:.12g},{:.3g},{:.12g},{:.5g},{:.3g},{},{:.3f}\n", r.id, r.kind,
                        r.method, r.expected, r.expected_abs_err, r.measured, r.standard_error,
                        r.numerical_bound, r.freedom, r.deviation());
  return text;
}

std::string summary_table(const std::vector<ValidationRow>& rows) {
  const RowSummary s = summarize(rows);
  std::size_t exact_zero = 0;
  std::size_t zero = 0;
  for (const ValidationRow& r : rows) {
    if (r.expected != 0) continue;
    ++zero;
    exact_zero += r.measured == 0 ? 1 : 0;
  }
  return fmt::format(
      "| | |\n|---|---|\n| rows | {} |\n| of these with noise worth the name | {} |\n"
      "| largest deviation | {:.2f} |\n| beyond 2: found (expected) | {} ({:.1f}) |\n"
      "| beyond 3: found (expected) | {} ({:.1f}) |\n| expected beyond 4 | {:.2f} |\n"
      "| largest standard error, of the value | {:.2f} % |\n"
      "| largest numerical bound, of the standard error | {:.2f} |\n"
      "| values that are 0: measured as exactly 0 | {} of {} |\n",
      s.rows, s.noisy, s.largest_deviation, s.beyond_2, s.expected_beyond_2, s.beyond_3, s.expected_beyond_3,
      s.expected_beyond_4, 100 * s.largest_relative_error, s.largest_bound_share, exact_zero, zero);
}

std::string kind_table(const std::vector<ValidationRow>& rows) {
  std::string text =
      "| kind | rows | largest deviation | beyond 2: found (expected) | largest standard error | methods |\n"
      "|---|---|---|---|---|---|\n";
  for (const Family& family : families())
    for (const std::string& kind : family.kinds) {
      std::vector<ValidationRow> own;
      std::vector<std::string> methods;
      for (const ValidationRow& r : rows) {
        if (r.kind != kind) continue;
        own.push_back(r);
        const std::string method = r.method.substr(0, r.method.find(','));
        if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
      }
      if (own.empty()) continue;
      const RowSummary s = summarize(own);
      text += fmt::format("| {} | {} | {:.2f} | {} ({:.1f}) | {:.3f} % | {} |\n", kind, s.rows,
                          s.largest_deviation, s.beyond_2, s.expected_beyond_2,
                          100 * s.largest_relative_error, fmt::join(methods, "; "));
    }
  return text;
}

std::string convergence_table(const std::vector<CubeStep>& steps) {
  std::string text =
      "| rho | place | N | squares, exact | triangles, shooting | gather, every hit read | gather, close "
      "hits "
      "carried on | continuous |\n|---|---|---|---|---|---|---|---|\n";
  for (const CubeStep& s : steps) {
    const auto percent = [&](double value) { return 100 * (value / s.continuous - 1); };
    const auto with_error = [&](const ValidationRow& r) {
      return fmt::format("{:+.2f} ± {:.2f} %", percent(r.measured), 100 * r.standard_error / s.continuous);
    };
    const std::string squares = s.square_zones > 0 ? fmt::format("{:+.2f} %", percent(s.square_zones)) : "";
    text +=
        fmt::format("| {} | {} | {} | {} | {} | {} | {} | {:.6g} |\n", s.rho, s.place, s.divisions, squares,
                    with_error(s.zones), with_error(s.plain_gather), with_error(s.gather), s.continuous);
  }
  return text;
}

}  // namespace

RowSummary summarize(const std::vector<ValidationRow>& rows) {
  RowSummary s;
  s.rows = rows.size();
  for (const ValidationRow& r : rows) {
    const double deviation = std::fabs(r.deviation());
    s.largest_deviation = std::max(s.largest_deviation, deviation);
    s.largest_relative_error = std::max(s.largest_relative_error, r.relative_error());
    if (!r.is_noisy()) continue;
    ++s.noisy;
    s.largest_bound_share = std::max(s.largest_bound_share, r.numerical_bound / r.standard_error);
    s.beyond_2 += deviation > 2 ? 1 : 0;
    s.beyond_3 += deviation > 3 ? 1 : 0;
    s.expected_beyond_2 += r.odds_beyond(2);
    s.expected_beyond_3 += r.odds_beyond(3);
    s.expected_beyond_4 += r.odds_beyond(4);
  }
  return s;
}

void write_report(const std::vector<ValidationRow>& rows, const std::vector<CubeStep>& steps,
                  const std::filesystem::path& folder) {
  require_gnuplot();
  std::filesystem::create_directories(folder / "images");
  write_text(folder / "validation.csv", csv(rows));
  plot_deviations(rows, folder / "images/validation_deviations.svg");
  plot_convergence(steps, folder / "images/validation_cube.svg");
  std::string page = read_text(kSources / "page.md.in");
  put(page, "summary", summary_table(rows));
  put(page, "kinds", kind_table(rows));
  put(page, "cube", convergence_table(steps));
  put(page, "planted", read_text(kSources / "planted_bias.md"));
  write_text(folder / "validation.md", page);
}

}  // namespace reemit::validation
