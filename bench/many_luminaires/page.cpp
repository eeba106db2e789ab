#include "bench/many_luminaires/page.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/convergence/page_template.h"
#include "bench/many_luminaires/parts.h"

namespace reemit::bench {
namespace {

const std::string kTime = "time per sample [ns]";

std::string number(double value) {
  return value >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string with_range(const Spread& s, double factor = 1) {
  if (s.least == s.most) return number(factor * s.median);
  return fmt::format("{} ({} .. {})", number(factor * s.median), number(factor * s.least),
                     number(factor * s.most));
}

std::string cell(const Figure* figure, double factor = 1) {
  return figure == nullptr ? "" : with_range(figure->value, factor);
}

/// Lookup within the rows of one part, whatever their count.
const Figure* find(const Figures& figures, const std::string& part, const std::string& subject,
                   const std::string& selection, const std::string& quantity_start) {
  for (const Figure& f : figures.rows)
    if (f.part == part && f.subject == subject && f.selection == selection &&
        f.quantity.starts_with(quantity_start))
      return &f;
  return nullptr;
}

const std::vector<std::string> kSubjects{"all points", "floor", "spheres", "few points"};

std::string sphereflake_targets(const Figures& figures) {
  const auto value = [&](const char* quantity) {
    const Figure* f = find(figures, "sphereflake", "all points", "spatial", quantity);
    return f == nullptr ? "–" : fmt::format("**{}**", cell(f));
  };
  return fmt::format(
      "| time per sample at most 1.5 times that of the room with one lamp | {} | spatial selection, all "
      "points |\n"
      "| error at equal time at least 5 times lower than with constant selection | {} | the same |\n",
      value("time over"), value("error of constant"));
}

std::string sphereflake_times(const Figures& figures) {
  std::string text =
      "| points | one lamp [ns] | constant [ns] | linear [ns] | spatial [ns] | constant / one lamp | spatial "
      "/ one lamp "
      "|\n|---|---|---|---|---|---|---|\n";
  for (const std::string& subject : kSubjects) {
    const auto at = [&](const char* selection, const std::string& quantity) {
      return cell(find(figures, "sphereflake", subject, selection, quantity));
    };
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", subject, at(kOneLamp, kTime),
                        at("constant", kTime), at("linear", kTime), at("spatial", kTime),
                        at("constant", "time over"), at("spatial", "time over"));
  }
  text += "\nTime to build the table of luminaires:";
  for (const Selection s : kSelections)
    text +=
        fmt::format("{} {} {} ms", s == kSelections.front() ? "" : ",", name_of(s),
                    cell(find(figures, "sphereflake", "all points", std::string(name_of(s)), "table built")));
  return text + ".\n";
}

std::string sphereflake_errors(const Figures& figures) {
  std::string text =
      "| points | selection | error [%] | variance of a sample | mean off by [%] | reference's "
      "own error "
      "[%] | error of constant over this at equal time |\n|---|---|---|---|---|---|---|\n";
  for (const std::string& subject : kSubjects)
    for (const Selection s : kSelections) {
      const std::string name(name_of(s));
      const Figure* error = find(figures, "sphereflake", subject, name, "error of");
      if (error == nullptr || !error->quantity.ends_with("samples")) continue;
      const auto at = [&](const std::string& quantity, double factor = 1) {
        return cell(find(figures, "sphereflake", subject, name, quantity), factor);
      };
      text += fmt::format("| {} | {}, {} | {} | {} | {} | {} | {} |\n", subject, name,
                          error->quantity.substr(9), cell(error, 100), at("variance"), at("mean off", 100),
                          cell(find(figures, "sphereflake", subject, "reference", "its own"), 100),
                          at("error of constant"));
    }
  return text;
}

std::string panels(const Figures& figures) {
  std::string text =
      "| samples per pixel | selection | time [s] | rms [%] | median [%] | mean off by [%] | rms at equal "
      "time | median "
      "at equal time |\n|---|---|---|---|---|---|---|---|\n";
  for (const Figure& f : figures.rows) {
    if (f.part != "panels" || f.quantity != "wall time [s]") continue;
    const auto at = [&](const char* quantity, double factor = 1) {
      return cell(figures.find(f.part, f.subject, f.count, f.selection, quantity), factor);
    };
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", f.count, f.selection, cell(&f),
                        at("rms error", 100), at("median error", 100), at("mean off by", 100),
                        at("rms error over that of spatial at equal time"),
                        at("median error over that of spatial at equal time"));
  }
  return text;
}

std::string growth(const Figures& figures) {
  std::string text =
      "| luminaires | number | constant [ns] | linear [ns] | spatial [ns] | built in [ms] |\n"
      "|---|---|---|---|---|---|\n";
  for (const Figure& f : figures.rows) {
    if (f.part != "growth" || f.selection != "spatial" || f.quantity != kTime) continue;
    const auto at = [&](const char* selection, const std::string& quantity) {
      return cell(figures.find(f.part, f.subject, f.count, selection, quantity));
    };
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", f.subject, f.count, at("constant", kTime),
                        at("linear", kTime), cell(&f), at("spatial", "table built in [ms]"));
  }
  return text;
}

std::string exponents(const Figures& figures) {
  const std::string quantity = "exponent of growth from here on";
  std::string text = "| luminaires | from this number on | constant | spatial |\n|---|---|---|---|\n";
  for (const Figure& f : figures.rows)
    if (f.part == "growth" && f.selection == "spatial" && f.quantity == quantity) {
      const Figure* constant = figures.find(f.part, f.subject, f.count, "constant", quantity);
      text += fmt::format("| {} | {} | {} | {} |\n", f.subject, f.count,
                          constant == nullptr ? "" : fmt::format("{:.2f}", constant->value.median),
                          fmt::format("{:.2f}", f.value.median));
    }
  return text;
}

}  // namespace

void write_many_luminaires_page(const Figures& figures, const std::filesystem::path& folder) {
  PageTemplate page(std::filesystem::path(REEMIT_SOURCE_DIR) / "bench/many_luminaires/page.md.in");
  page.put_notes("notes", figures.notes);
  page.put("sphereflake_targets", sphereflake_targets(figures));
  page.put("sphereflake_times", sphereflake_times(figures));
  page.put("sphereflake_errors", sphereflake_errors(figures));
  page.put("panels", panels(figures));
  page.put("growth", growth(figures));
  page.put("exponents", exponents(figures));
  page.write(folder / "many_luminaires.md");
}

}  // namespace reemit::bench
