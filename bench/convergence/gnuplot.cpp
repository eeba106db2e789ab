#include "bench/convergence/gnuplot.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace reemit::bench {

bool gnuplot_runs() {
  return std::system("gnuplot --version > /dev/null 2>&1") == 0;
}

void run_gnuplot(const std::string& commands) {
  std::FILE* pipe = popen("gnuplot", "w");
  if (pipe == nullptr) throw std::runtime_error("gnuplot does not start");
  std::fputs(commands.c_str(), pipe);
  if (pclose(pipe) != 0) throw std::runtime_error("gnuplot ended with an error");
}

}  // namespace reemit::bench
