#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace reemit {

/// A file that replaces its predecessor only when it is complete. Bytes go to `NAME.<process id>.partial`
/// beside the target; commit() flushes them to the disk and renames. Without commit() the destructor removes
/// the partial file, so a failed or interrupted write never costs the previous file and never leaves half of
/// a new one. A symbolic link is followed: the file it points to is replaced, not the link. Not copyable, not
/// for several threads.
class OutputFile {
 public:
  /// Creates the empty partial file. Throws ResourceError if that is not possible.
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// For libraries that open files by name: they must write into this existing file, and close it before
  /// commit().
  const std::filesystem::path& partial_path() const { return partial_; }

  /// Appends to the partial file (buffered). Throws ResourceError when the disk is full or fails.
  void write(const void* bytes, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Writes into the partial file at a byte offset, for formats that fill in tables afterwards. Bytes
  /// appended by write() before are in place by then. Throws ResourceError as write() does.
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);

  /// Makes the file appear under its name. Throws ResourceError; the previous file is then unchanged.
  void commit();

  /// The error of a failed write in words, for libraries that report through error codes: names the target.
  [[noreturn]] void fail(std::string_view what, std::error_code code) const;

 private:
  void flush();

  std::filesystem::path target_;    // as given, for messages
  std::filesystem::path resolved_;  // links followed
  std::filesystem::path partial_;
  std::string buffer_;
  int descriptor_ = -1;
  bool committed_ = false;
};

/// Throws ResourceError unless a file of this name can be written: to be called before long work starts.
/// Creates and removes an empty file beside the target; the target itself is not touched.
void check_writable(const std::filesystem::path& target);

}  // namespace reemit
