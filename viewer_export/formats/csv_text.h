#pragma once
#include <string>

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

}  // namespace reemit
