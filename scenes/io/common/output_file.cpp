#include "scenes/io/common/output_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scenes/model/error.h"

namespace reemit {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

std::error_code last_error() {
  return {errno, std::generic_category()};
}

std::string advice_for(std::error_code code) {
  if (code == std::errc::no_space_on_device) return "Free some space or write to another disk.";
  if (code == std::errc::permission_denied || code == std::errc::read_only_file_system)
    return "Choose a folder that you may write to.";
  if (code == std::errc::file_too_large)
    return "Raise the limit on file sizes (ulimit -f) or write elsewhere.";
  return "Check the disk, or write elsewhere.";
}

[[noreturn]] void raise(const fs::path& target, std::string_view what, std::error_code code) {
  throw ResourceError(target.string(), fmt::format("{}: {}", what, code.message()), advice_for(code));
}

// Where the bytes must end up: rename would replace a symbolic link instead of the file it names.
fs::path follow_links(const fs::path& target) {
  std::error_code code;
  fs::path resolved = target;
  constexpr int kLongestChain = 40;
  for (int i = 0; i < kLongestChain; ++i) {
    if (!fs::is_symlink(fs::symlink_status(resolved, code))) return resolved;
    const fs::path next = fs::read_symlink(resolved, code);
    if (code) raise(target, "cannot follow the link", code);
    resolved = next.is_absolute() ? next : resolved.parent_path() / next;
  }
  raise(target, "cannot follow the link", std::make_error_code(std::errc::too_many_symbolic_link_levels));
}

// A name in the folder of the target, so that the rename stays on one file system. The number of the process
// keeps two programs that write the same file apart; `attempt` keeps two files of one program apart.
fs::path partial_name(const fs::path& resolved, int attempt) {
  const std::string tail = attempt == 0 ? "" : fmt::format(".{}", attempt);
  return resolved.parent_path() /
         fmt::format("{}.{}{}.partial", resolved.filename().string(), getpid(), tail);
}

bool is_partial_of(const std::string& target_name, std::string_view name) {
  constexpr std::string_view kEnd = ".partial";
  if (!name.starts_with(target_name + ".") || !name.ends_with(kEnd)) return false;
  name.remove_prefix(target_name.size() + 1);
  name.remove_suffix(std::min(name.size(), kEnd.size()));
  return !name.empty() && name.find_first_not_of("0123456789.") == std::string_view::npos;
}

// Who writes a partial file holds its lock until the end of OutputFile or of the process, whichever machine
// or container it runs on. False also where a file system has no locks.
bool nobody_writes(int descriptor) {
  return flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

// What cannot be removed stays: it is in nobody's way.
void remove_what_killed_runs_left(const fs::path& resolved) {
  const fs::path folder = resolved.has_parent_path() ? resolved.parent_path() : fs::path(".");
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    const fs::path& file = entry->path();
    if (!is_partial_of(resolved.filename().string(), file.filename().string())) continue;
    const int descriptor = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    struct stat status {};
    if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
        nobody_writes(descriptor))
      unlink(file.c_str());
    close(descriptor);
  }
}

// Between creation and lock another process may have taken the new file for one that a killed run left.
bool lock_new_file(int descriptor) {
  struct stat status {};
  return (flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) &&
         fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

// No file can be created there, though nobody forbids it.
[[noreturn]] void refuse_folder(const fs::path& target, const fs::path& resolved) {
  const fs::path folder = resolved.has_parent_path() ? resolved.parent_path() : fs::path(".");
  std::error_code code;
  // Such as /proc.
  if (fs::is_directory(folder, code))
    throw ResourceError(target.string(), fmt::format("no file can be created in '{}'", folder.string()),
                        "Choose a folder that you may write to.");
  throw ResourceError(target.string(), missing_folder(resolved), kCreateFolder);
}

}  // namespace

OutputFile::OutputFile(const fs::path& target) : target_(target), resolved_(follow_links(target)) {
  if (!resolved_.has_filename())
    throw ResourceError(target_.string(), "is not the name of a file", "Add a file name.");
  struct stat previous {};
  const bool replaces = stat(resolved_.c_str(), &previous) == 0;
  if (replaces && S_ISDIR(previous.st_mode))
    throw ResourceError(target_.string(), "is a folder", "Give the name of a file in it.");
  if (replaces && !S_ISREG(previous.st_mode))
    throw ResourceError(target_.string(), "is not a regular file", "Give the name of a new file.");
  if (replaces && access(resolved_.c_str(), W_OK) != 0)
    raise(target_, "cannot replace the file", last_error());

  remove_what_killed_runs_left(resolved_);
  constexpr int kAttempts = 1000;
  for (int attempt = 0; attempt < kAttempts && descriptor_ < 0; ++attempt) {
    partial_ = partial_name(resolved_, attempt);
    descriptor_ = open(partial_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno == ENOENT) refuse_folder(target_, resolved_);
    if (descriptor_ < 0 && errno != EEXIST) raise(target_, "cannot create the file", last_error());
    if (descriptor_ >= 0 && !lock_new_file(descriptor_)) {
      close(descriptor_);
      descriptor_ = -1;
    }
  }
  if (descriptor_ < 0) raise(target_, "cannot create the file", last_error());
  if (replaces)
    fchmod(descriptor_, previous.st_mode & 07777);  // a failure only costs the mode of the old file
}

OutputFile::~OutputFile() {
  if (!committed_) unlink(partial_.c_str());
  if (descriptor_ >= 0) close(descriptor_);
}

void OutputFile::put(std::uint64_t offset, const void* bytes, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t written = pwrite(descriptor_, static_cast<const char*>(bytes) + done, size - done,
                                   static_cast<off_t>(offset + done));
    if (written < 0 && errno != EINTR) raise(target_, "cannot write the file", last_error());
    if (written > 0) done += static_cast<std::size_t>(written);
  }
}

void OutputFile::flush() {
  put(end_, buffer_.data(), buffer_.size());
  end_ += buffer_.size();
  buffer_.clear();
}

void OutputFile::write(const void* bytes, std::size_t size) {
  if (buffer_.size() + size > kBufferBytes) flush();
  if (size <= kBufferBytes) {
    buffer_.append(static_cast<const char*>(bytes), size);
    return;
  }
  put(end_, bytes, size);
  end_ += size;
}

void OutputFile::write_at(std::uint64_t offset, const void* bytes, std::size_t size) {
  flush();
  put(offset, bytes, size);
}

void OutputFile::commit() {
  flush();
  // Without this a crash of the machine after the rename could leave an empty file under the good name.
  if (fsync(descriptor_) != 0) raise(target_, "cannot write the file", last_error());
  // Renamed while it is locked: unlocked under its old name it would look left over.
  if (std::rename(partial_.c_str(), resolved_.c_str()) != 0)
    raise(target_, "cannot replace the file", last_error());
  committed_ = true;
  close(descriptor_);
  descriptor_ = -1;
  const fs::path folder = resolved_.has_parent_path() ? resolved_.parent_path() : fs::path(".");
  const int folder_descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_descriptor >= 0) {
    fsync(folder_descriptor);  // makes the new name durable; some file systems do not offer it
    close(folder_descriptor);
  }
}

std::string missing_folder(const fs::path& target) {
  return fmt::format("there is no folder '{}'", target.parent_path().string());
}

void check_writable(const fs::path& target) {
  const OutputFile probe(target);
}

}  // namespace reemit
