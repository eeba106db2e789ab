#pragma once
#include <filesystem>
#include <functional>
#include <stdexcept>

namespace reemit::cli {

/// An output could not be written; the program ends with exit code 2, as for one that cannot be opened.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws InputError unless a file can be created or replaced at `output`; call it before long work. Leaves nothing
/// behind and does not touch an existing file. `input` is refused as output: it would be lost.
void check_output_file(const std::filesystem::path& output, const std::filesystem::path& input);
/// The same for a directory that will hold several files; its parent must exist, it itself need not.
void check_output_directory(const std::filesystem::path& output);

/// Runs a writer such that signals wait for it, and turns its ResourceError (disk full, not writable) into an
/// OutputError.
void write_output(const std::function<void()>& writer);

}  // namespace reemit::cli
