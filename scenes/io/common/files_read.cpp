#include "scenes/io/common/files_read.h"

#include <algorithm>
#include <utility>

namespace reemit {
namespace {

// Of the thread: the functions that read have nothing else in common.
thread_local FilesRead* innermost = nullptr;

}  // namespace

FilesRead::FilesRead() : outer_(std::exchange(innermost, this)) {}

FilesRead::~FilesRead() {
  innermost = outer_;
}

void FilesRead::add(const std::filesystem::path& file) {
  // Some files are read a million times; what is asked of the file system is asked once.
  if (innermost == nullptr || !innermost->given_.insert(file.native()).second) return;
  std::string name = std::filesystem::absolute(file).lexically_normal().string();
  std::vector<std::string>& files = innermost->files_;
  if (std::find(files.begin(), files.end(), name) == files.end()) files.push_back(std::move(name));
}

}  // namespace reemit
