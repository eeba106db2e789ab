#include "viewer_export/cli/output_path.h"

#include <system_error>

#include <fmt/format.h>

#include "scenes/io/common/output_file.h"
#include "scenes/model/error.h"
#include "viewer_export/cli/interrupt.h"

namespace reemit::cli {
namespace fs = std::filesystem;
namespace {

std::string choose_another(const std::string& option = "-o") {
  return "choose another output with " + option;
}

void check_can_write(const fs::path& file) {
  const FinishWriting finish;
  try {
    check_writable(file);
  } catch (const ResourceError& problem) {
    throw OutputError(problem.what());
  }
}

}  // namespace

void check_output_file(const fs::path& output, const fs::path& input, const std::string& option) {
  std::error_code problem;
  const fs::file_status status = fs::status(output, problem);
  if (fs::is_directory(status)) {
    throw InputError(output.string(), "output is a directory", "give the name of a file with " + option);
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw InputError(output.string(), "output is not a regular file and cannot be replaced",
                     choose_another(option));
  }
  if (fs::exists(status) && fs::equivalent(output, input, problem)) {
    throw InputError(output.string(), "output is the input file", choose_another(option));
  }
  check_can_write(output);
}

void check_keeps_room(const fs::path& output, const Scene& scene, const std::string& option) {
  std::error_code problem;
  for (const std::string& file : scene.files)
    if (fs::equivalent(output, file, problem))
      throw InputError(output.string(), "the room is made of this file", choose_another(option));
}

void make_output_directory(const fs::path& output) {
  std::error_code problem;
  const fs::file_status status = fs::status(output, problem);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw InputError(output.string(), "output exists and is not a directory", choose_another());
  }
  // "pictures/" and "pictures" are the same folder, and the same folder is above them.
  const fs::path folder = output.has_filename() ? output : output.parent_path();
  if (folder.has_parent_path() && !fs::exists(folder.parent_path(), problem))
    throw OutputError(fmt::format("{}: {}\n  {}", output.string(), missing_folder(folder), kCreateFolder));
  if (!fs::exists(status)) fs::create_directory(folder, problem);
  if (!fs::is_directory(folder)) {
    throw OutputError(output.string() + ": cannot create the directory: " + problem.message() + "\n  " +
                      choose_another());
  }
  check_can_write(output / "probe");
}

void write_output(const std::function<void()>& writer) {
  const FinishWriting finish;
  try {
    writer();
  } catch (const ResourceError& problem) {
    throw OutputError(problem.what());
  }
}

}  // namespace reemit::cli
