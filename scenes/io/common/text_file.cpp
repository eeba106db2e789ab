#include "scenes/io/common/text_file.h"

#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "scenes/io/common/files_read.h"
#include "scenes/model/error.h"

namespace reemit {
namespace fs = std::filesystem;

void check_readable_file(const fs::path& file, std::uintmax_t largest) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    throw InputError(file.string(), "there is no such file", "Check the path and its spelling.");
  if (error) throw InputError(file.string(), error.message(), "Check the path and its permissions.");
  if (fs::is_directory(status)) throw InputError(file.string(), "it is a folder", "Name the file inside it.");
  if (!fs::is_regular_file(status))
    throw InputError(file.string(), "it is not a regular file", "Copy the contents into a file first.");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(file.string(), error.message(), "Check the permissions of the file.");
  if (size == 0) throw InputError(file.string(), "the file is empty", "Was it written completely?");
  if (size > largest)
    throw InputError(file.string(), fmt::format("the file has {} bytes", size),
                     fmt::format("Files of up to {} bytes are read: split the room.", largest));
  FilesRead::add(file);
}

std::string load_file(const fs::path& file, std::uintmax_t largest) {
  check_readable_file(file, largest);
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError(file.string(), "the file cannot be opened", "Check the permissions of the file.");
  std::string text(static_cast<std::size_t>(fs::file_size(file)), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.gcount() != static_cast<std::streamsize>(text.size()))
    throw InputError(file.string(), "the file cannot be read to its end", "Is it still being written?");
  // No binary format that comes this way begins with either mark.
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError(file.string(), "its text is UTF-16", "Save it as UTF-8 or as plain text (ASCII).");
  if (text.starts_with("version https://git-lfs."))
    throw InputError(file.string(), "it is a pointer that Git LFS left in the place of the file",
                     "Fetch the file itself: git lfs pull.");
  return text;
}

}  // namespace reemit
