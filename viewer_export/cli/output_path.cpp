#include "viewer_export/cli/output_path.h"

#include <system_error>

#include <fmt/format.h>

#include "scenes/io/common/output_file.h"
#include "scenes/model/error.h"
#include "viewer_export/cli/interrupt.h"

namespace reemit::cli {
namespace fs = std::filesystem;
namespace {

constexpr const char* kChooseAnother = "choose another output with -o";

void check_can_write(const fs::path& file) {
  const FinishWriting finish;
  try {
    check_writable(file);
  } catch (const ResourceError& problem) {
    throw OutputError(problem.what());
  }
}

}  // namespace

void check_output_file(const fs::path& output, const fs::path& input) {
  std::error_code problem;
  const fs::file_status status = fs::status(output, problem);
  if (fs::is_directory(status)) {
    throw InputError(output.string(), "output is a directory", "give the name of a file with -o");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw InputError(output.string(), "output is not a regular file and cannot be replaced", kChooseAnother);
  }
  if (fs::exists(status) && fs::equivalent(output, input, problem)) {
    throw InputError(output.string(), "output is the input file", kChooseAnother);
  }
  check_can_write(output);
}

void make_output_directory(const fs::path& output) {
  std::error_code problem;
  const fs::file_status status = fs::status(output, problem);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw InputError(output.string(), "output exists and is not a directory", kChooseAnother);
  }
  // "pictures/" and "pictures" are the same folder, and the same folder is above them.
  const fs::path folder = output.has_filename() ? output : output.parent_path();
  if (folder.has_parent_path() && !fs::exists(folder.parent_path(), problem))
    throw OutputError(fmt::format("{}: {}\n  {}", output.string(), missing_folder(folder), kCreateFolder));
  if (!fs::exists(status)) fs::create_directory(folder, problem);
  if (!fs::is_directory(folder)) {
    throw OutputError(output.string() + ": cannot create the directory: " + problem.message() + "\n  " +
                      kChooseAnother);
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
