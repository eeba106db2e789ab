#pragma once
#include <string>

#include <fmt/format.h>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/export_info.h"

namespace reemit {

/// A text as a cell of a table, quoted as RFC 4180 says where it must be; # begins comments.
inline std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n#") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

/// What a table says of itself, as `#` comment lines; `units` in place of those of the info, if it is not
/// empty. Throws as OutputFile::write.
inline void write_csv_comments(const ExportInfo& info, const BandSet& bands, const std::string& units,
                               OutputFile& file) {
  for (const auto& [name, value] : describe(info, bands))
    file.write(fmt::format("# {}: {}\n", name, name == "units" && !units.empty() ? units : value));
}

}  // namespace reemit
