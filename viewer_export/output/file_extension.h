#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"

namespace reemit {

/// The row of a format table whose `extension` is that of the file name (case is ignored). Throws InputError
/// that lists the known ones.
template <class Format>
const Format& format_by_extension(std::span<const Format> formats, const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  std::string known;
  for (const Format& format : formats) {
    if (format.extension == extension) return format;
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
  }
  throw InputError(file.string(), extension.empty() ? "has no extension" : "has an unknown extension",
                   "The format follows from the extension; known are " + known + ".");
}

}  // namespace reemit
