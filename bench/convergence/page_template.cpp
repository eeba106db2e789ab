#include "bench/convergence/page_template.h"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace reemit::bench {

PageTemplate::PageTemplate(std::filesystem::path source) : source_(std::move(source)) {
  std::ifstream in(source_);
  if (!in) throw std::runtime_error(fmt::format("{} cannot be read", source_.string()));
  std::ostringstream buffer;
  buffer << in.rdbuf();
  text_ = buffer.str();
}

void PageTemplate::put(const std::string& name, const std::string& text) {
  const std::string mark = "@" + name + "@\n";
  const std::size_t at = text_.find(mark);
  if (at == std::string::npos)
    throw std::runtime_error(fmt::format("{} has no @{}@", source_.string(), name));
  text_.replace(at, mark.size(), text);
}

void PageTemplate::put_notes(const std::string& name, const std::vector<std::string>& notes) {
  std::string list;
  for (const std::string& note : notes) list += fmt::format("- {}\n", note);
  put(name, list);
}

void PageTemplate::write(const std::filesystem::path& file) const {
  std::ofstream out(file);
  out << text_;
  if (!out.flush()) throw std::runtime_error(fmt::format("{} cannot be written", file.string()));
}

}  // namespace reemit::bench
