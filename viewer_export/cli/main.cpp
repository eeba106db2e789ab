#include <csignal>

#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/interrupt.h"
#include "viewer_export/cli/messages.h"

int main(int argc, char** argv) {
  reemit::cli::claim_standard_streams();
  reemit::cli::end_on_signals();
  // A reader of a pipe that leaves ends no run; what it does not get is noticed at the end.
  std::signal(SIGPIPE, SIG_IGN);
  // Beyond a file size limit, a write shall fail with a message like on a full disk, not kill the program.
  std::signal(SIGXFSZ, SIG_IGN);
  return static_cast<int>(reemit::cli::run_program(argc, argv));
}
