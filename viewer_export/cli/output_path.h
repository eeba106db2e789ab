#pragma once
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "scenes/model/scene.h"

namespace reemit::cli {

/// An output cannot be written: the program ends with the exit code of bad input, not that of lacking memory.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws InputError or OutputError unless a file can be created or replaced at `output`; call it before long
/// work. Leaves nothing behind and does not touch an existing file. `input` is refused as output: it would be
/// lost. `option`: that names the output, for messages.
void check_output_file(const std::filesystem::path& output, const std::filesystem::path& input,
                       const std::string& option = "-o");

/// Throws InputError if the room was read from this file, among others.
void check_keeps_room(const std::filesystem::path& output, const Scene& scene,
                      const std::string& option = "-o");

/// check_output_file for a directory that will hold several files; it is created if it is missing, its parent
/// is not.
void make_output_directory(const std::filesystem::path& output);

/// Runs a writer such that signals wait for it, and turns its ResourceError (disk full, not writable) into an
/// OutputError.
void write_output(const std::function<void()>& writer);

}  // namespace reemit::cli
