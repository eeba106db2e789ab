#include "viewer_export/cli/output_file.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "scenes/model/error.h"
#include "viewer_export/cli/interrupt.h"

namespace reemit::cli {
namespace fs = std::filesystem;
namespace {

constexpr const char* kChooseAnother = "choose another output with -o";

/// Creates and removes a file: permissions alone do not tell (read-only file systems, /proc, the superuser).
void check_can_create_in(const fs::path& directory, const std::string& where) {
  std::error_code problem;
  if (!fs::is_directory(directory, problem)) {
    throw InputError(where, fmt::format("directory '{}' does not exist", directory.string()),
                     "create it, or " + std::string(kChooseAnother));
  }
  const std::string probe = (directory / fmt::format(".reemit-{}.probe", ::getpid())).string();
  const int file = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) {
    throw InputError(where, fmt::format("cannot write into '{}': {}", directory.string(), std::strerror(errno)),
                     kChooseAnother);
  }
  ::close(file);
  ::unlink(probe.c_str());
}

fs::path parent_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

void check_output_file(const fs::path& output, const fs::path& input) {
  const std::string where = output.string();
  std::error_code problem;
  const fs::file_status status = fs::status(output, problem);
  if (fs::exists(status)) {
    if (fs::is_directory(status)) {
      throw InputError(where, "output is a directory", "give the name of a file with -o");
    }
    if (!fs::is_regular_file(status)) {
      throw InputError(where, "output is not a regular file and cannot be replaced", kChooseAnother);
    }
    if (fs::equivalent(output, input, problem)) {
      throw InputError(where, "output is the input file", kChooseAnother);
    }
    if (::access(output.c_str(), W_OK) != 0) {
      throw InputError(where, fmt::format("cannot write: {}", std::strerror(errno)), kChooseAnother);
    }
  }
  check_can_create_in(parent_of(output), where);
}

void check_output_directory(const fs::path& output) {
  const fs::path clean = output.has_filename() ? output : output.parent_path();
  std::error_code problem;
  if (fs::is_directory(clean, problem)) {
    check_can_create_in(clean, output.string());
  } else if (fs::exists(clean, problem)) {
    throw InputError(output.string(), "output exists and is not a directory", kChooseAnother);
  } else {
    check_can_create_in(parent_of(clean), output.string());
  }
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
