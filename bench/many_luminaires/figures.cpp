#include "bench/many_luminaires/figures.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "bench/convergence/csv_table.h"

namespace reemit::bench {
namespace {

constexpr const char* kHeader = "part,subject,count,selection,quantity,median,least,most";
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
  CsvTable table = read_csv(file, kHeader);
  Figures figures;
  figures.notes = std::move(table.notes);
  for (const std::vector<std::string>& f : table.rows)
    figures.rows.push_back(
        {f[0],
         f[1],
         number_of<std::size_t>(f[2], file),
         f[3],
         f[4],
         {number_of<double>(f[5], file), number_of<double>(f[6], file), number_of<double>(f[7], file)}});
  return figures;
}

}  // namespace reemit::bench
