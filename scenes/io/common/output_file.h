#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace reemit {

/// A file that replaces its predecessor only when it is complete. Bytes go to `NAME.<process id>.partial`
/// beside the target; commit() flushes them to the disk and renames. Without commit() the destructor removes
/// the partial file, so a failed or interrupted write never costs the previous file and never leaves half of
/// a new one. A killed process cannot do so; its partial files are removed by the next OutputFile of the same
/// target, which knows them by their name and by the lock that died with their process. A symbolic link is
/// followed: the file it points to is replaced, not the link. Not copyable, not for several threads.
class OutputFile {
 public:
  /// Creates the empty partial file. Throws ResourceError if that is not possible.
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends to the partial file (buffered). Throws ResourceError when the disk is full or fails.
  void write(const void* bytes, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Writes into the partial file at a byte offset, for formats that fill in tables afterwards. Bytes
  /// appended by write() before are in place by then. Throws ResourceError as write() does.
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);

  /// Makes the file appear under its name. Throws ResourceError; the previous file is then unchanged.
  void commit();

 private:
  void put(std::uint64_t offset, const void* bytes, std::size_t size);
  void flush();

  std::filesystem::path target_;    // as given, for messages
  std::filesystem::path resolved_;  // links followed
  std::filesystem::path partial_;
  std::string buffer_;     // appended, but not yet in the file
  std::uint64_t end_ = 0;  // bytes appended that are in the file
  int descriptor_ = -1;
  bool committed_ = false;
};

/// What to say, and what to do, where the folder of an output is not there.
std::string missing_folder(const std::filesystem::path& target);
inline constexpr const char* kCreateFolder = "Create it first, or check the spelling.";

/// Throws ResourceError unless a file of this name can be written: to be called before long work starts.
/// Creates and removes an empty file beside the target; the target itself is not touched.
void check_writable(const std::filesystem::path& target);

}  // namespace reemit
