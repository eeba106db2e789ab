#include "bench/many_luminaires/page.h"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

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

std::string note_list(const Figures& figures) {
  std::string text;
  for (const std::string& note : figures.notes) text += fmt::format("- {}\n", note);
  return text;
}

void replace(std::string& text, const std::string& mark, const std::string& with) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) throw std::runtime_error(fmt::format("page.md.in has no {}", mark));
  text.replace(at, mark.size(), with);
}

}  // namespace

void write_many_luminaires_page(const Figures& figures, const std::filesystem::path& folder) {
  const std::filesystem::path source =
      std::filesystem::path(REEMIT_SOURCE_DIR) / "bench/many_luminaires/page.md.in";
  std::ifstream in(source);
  if (!in) throw std::runtime_error(fmt::format("{} cannot be read", source.string()));
  std::ostringstream buffer;
  buffer << in.rdbuf();
  std::string text = buffer.str();
  replace(text, "@notes@\n", note_list(figures));
  replace(text, "@sphereflake_targets@\n", sphereflake_targets(figures));
  replace(text, "@sphereflake_times@\n", sphereflake_times(figures));
  replace(text, "@sphereflake_errors@\n", sphereflake_errors(figures));
  replace(text, "@panels@\n", panels(figures));
  replace(text, "@growth@\n", growth(figures));
  replace(text, "@exponents@\n", exponents(figures));
  const std::filesystem::path file = folder / "many_luminaires.md";
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error(fmt::format("{} cannot be written", file.string()));
}

}  // namespace reemit::bench
