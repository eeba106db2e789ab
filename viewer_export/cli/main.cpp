#include <csignal>

#include "viewer_export/cli/commands.h"

int main(int argc, char** argv) {
  // Beyond a file size limit, a write shall fail with a message like on a full disk, not kill the program.
  std::signal(SIGXFSZ, SIG_IGN);
  return static_cast<int>(reemit::cli::run_program(argc, argv));
}
