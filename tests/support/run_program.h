#pragma once
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temp_folder.h"

namespace reemit::test {

/// How one run of the built program ended.
struct ProgramRun {
  int exit_code = -1;  ///< Or minus the number of the signal that killed it.
  std::string out;
  std::string err;
};

struct RunOptions {
  std::optional<std::uint64_t> largest_file;  ///< No file may grow beyond this [bytes], as on a full disk.
  std::optional<std::uint64_t> most_memory;   ///< Address space [bytes]; not with the address sanitizer.
  std::string stdout_path;                    ///< Where standard output goes instead of into ProgramRun::out.
  /// Of the test: where standard error goes instead of into ProgramRun::err; -1: it is closed.
  std::optional<int> stderr_descriptor;
  std::filesystem::path working_folder;  ///< Empty: the one of the test.
  unsigned time_limit_s = 120;           ///< Then the run is killed, so that a hang fails a test.
};

/// A run of the built program that goes on beside the test.
class RunningProgram {
 public:
  explicit RunningProgram(const std::vector<std::string>& arguments, const RunOptions& options = {}) {
    const std::string out = options.stdout_path.empty() ? (streams_ / "out").string() : options.stdout_path;
    const std::string err = (streams_ / "err").string();
    std::vector<std::string> words{REEMIT_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    process_ = ::fork();
    if (process_ != 0) return;
    if (!options.working_folder.empty() && ::chdir(options.working_folder.c_str()) != 0) ::_exit(126);
    if (options.largest_file) {
      const rlimit limit{*options.largest_file, *options.largest_file};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (options.most_memory) {
      const rlimit limit{*options.most_memory, *options.most_memory};
      ::setrlimit(RLIMIT_AS, &limit);
    }
    ::alarm(options.time_limit_s);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    if (options.stderr_descriptor && ::dup2(*options.stderr_descriptor, STDERR_FILENO) < 0)
      ::close(STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~RunningProgram() {
    if (!finished_) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal) const { ::kill(process_, signal); }

  /// What it has printed to standard error so far.
  std::string errors_so_far() const { return read_bytes(streams_ / "err"); }

  ProgramRun wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    finished_ = true;
    ProgramRun run;
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    run.out = read_bytes(streams_ / "out");
    run.err = errors_so_far();
    return run;
  }

 private:
  TempFolder streams_;
  pid_t process_ = -1;
  bool finished_ = false;
};

/// Runs the built program to its end.
inline ProgramRun run_reemit(const std::vector<std::string>& arguments, const RunOptions& options = {}) {
  return RunningProgram(arguments, options).wait();
}

}  // namespace reemit::test
