#include "viewer_export/cli/messages.h"

#include <csignal>
#include <cstdio>
#include <iostream>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <unistd.h>

namespace reemit::cli {
namespace {

bool reader_has_left(int descriptor) {
  pollfd state{descriptor, 0, 0};
  return ::poll(&state, 1, 0) == 1 && (state.revents & POLLERR) != 0;
}

}  // namespace

void claim_standard_streams() {
  // open() takes the lowest free number. What is written to stdout shall fail, so that it is noticed.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    if (::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY) != stream) return;
  }
}

void print_error_text(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void print_warnings(const std::vector<std::string>& warnings) {
  std::set<std::string> seen;
  for (const std::string& warning : warnings) {
    if (seen.insert(warning).second) print_error_text(fmt::format("reemit: warning: {}\n", warning));
  }
}

void print_note(const std::string& note) {
  print_error_text(fmt::format("reemit: {}\n", note));
}

void print_result(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void print_json(const nlohmann::ordered_json& document) {
  print_result(document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
}

bool results_arrived() {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return true;
  if (reader_has_left(STDOUT_FILENO)) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  return false;
}

}  // namespace reemit::cli
