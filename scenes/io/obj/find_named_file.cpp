#include "scenes/io/obj/find_named_file.h"

#include <algorithm>
#include <system_error>

#include "scenes/io/common/text_parse.h"

namespace reemit {
namespace {
namespace fs = std::filesystem;

/// What a folder has under that name in any case; the first by the alphabet, as folders are listed in any
/// order. Empty if it has nothing.
fs::path find_in(const fs::path& folder, const fs::path& name) {
  const std::string wanted = lower_case(name.string());
  fs::path found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
    const fs::path file = entry.path().filename();
    if (lower_case(file.string()) == wanted && (found.empty() || file < found)) found = file;
  }
  return found.empty() ? fs::path() : folder / found;
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

}  // namespace

fs::path find_named_file(const fs::path& folder, std::string name) {
  if (is_file(folder / name)) return folder / name;
  std::replace(name.begin(), name.end(), '\\', '/');
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  const fs::path path(name);
  if (is_file(folder / path)) return folder / path;
  if (path.is_relative()) {
    fs::path at = folder;
    for (const fs::path& part : path) {
      if (part == "." || part == "..") {
        at /= part;
        continue;
      }
      at = find_in(at, part);
      if (at.empty()) break;
    }
    if (!at.empty() && is_file(at)) return at;
  }
  const fs::path beside = path.has_filename() ? find_in(folder, path.filename()) : fs::path();
  return is_file(beside) ? beside : fs::path();
}

}  // namespace reemit
