#include "bench/many_luminaires/figures.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace reemit::bench {
namespace {

constexpr const char* kHeader = "part,subject,count,selection,quantity,median,least,most";
constexpr std::size_t kFields = 8;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  for (std::size_t from = 0;;) {
    const std::size_t comma = line.find(',', from);
    fields.push_back(line.substr(from, comma - from));
    if (comma == std::string::npos) return fields;
    from = comma + 1;
  }
}

template <class Number>
Number number_of(const std::string& text, const std::filesystem::path& file) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::runtime_error(fmt::format("{}: '{}' is not a number", file.string(), text));
  return value;
}

}  // namespace

void Figures::add(Figure row) {
  fmt::print(stderr, "{:<12} {:<16} {:>7} {:<9} {:<34} {:.4g} ({:.4g} .. {:.4g})\n", row.part, row.subject,
             row.count, row.selection, row.quantity, row.value.median, row.value.least, row.value.most);
  rows.push_back(std::move(row));
}

const Figure* Figures::find(const std::string& part, const std::string& subject, std::size_t count,
                            const std::string& selection, const std::string& quantity) const {
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const Figure& f) {
    return f.part == part && f.subject == subject && f.count == count && f.selection == selection &&
           f.quantity == quantity;
  });
  return it == rows.end() ? nullptr : &*it;
}

void write_figures(const Figures& figures, const std::filesystem::path& file) {
  std::ofstream out(file);
  for (const std::string& note : figures.notes) out << "# " << note << '\n';
  out << kHeader << '\n';
  for (const Figure& f : figures.rows)
    out << fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.6g}\n", f.part, f.subject, f.count, f.selection,
                       f.quantity, f.value.median, f.value.least, f.value.most);
  if (!out.flush()) throw std::runtime_error(fmt::format("{} cannot be written", file.string()));
}

Figures read_figures(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("{} cannot be read", file.string()));
  Figures figures;
  bool header = false;
  for (std::string line; std::getline(in, line);) {
    if (!header && line.starts_with("# ")) {
      figures.notes.push_back(line.substr(2));
      continue;
    }
    if (!header) {
      if (line != kHeader) break;
      header = true;
      continue;
    }
    const std::vector<std::string> f = fields_of(line);
    if (f.size() != kFields)
      throw std::runtime_error(fmt::format("{}: '{}' does not have {} fields", file.string(), line, kFields));
    figures.rows.push_back(
        {f[0],
         f[1],
         number_of<std::size_t>(f[2], file),
         f[3],
         f[4],
         {number_of<double>(f[5], file), number_of<double>(f[6], file), number_of<double>(f[7], file)}});
  }
  if (!header) throw std::runtime_error(fmt::format("{} is not a table of figures", file.string()));
  return figures;
}

}  // namespace reemit::bench
