#pragma once
#include <filesystem>
#include <string>
#include <unordered_set>
#include <vector>

namespace reemit {

/// Collects the files that this thread looks into while it lives: a room is made of more files than its
/// readers tell each other of, and none of them may be overwritten by what becomes of it. One may live inside
/// another, which then misses what the inner one collects.
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;

  /// Absolute, each once, in the order in which they were first read.
  std::vector<std::string> list() const { return files_; }

  /// Adds a file to those of the innermost one, if there is any.
  static void add(const std::filesystem::path& file);

 private:
  FilesRead* outer_;
  std::unordered_set<std::string> given_;  // as they were given
  std::vector<std::string> files_;
};

}  // namespace reemit
