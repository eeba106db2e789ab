// How loading and meshing grow with a room: time, memory and triangles of furnished halls.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/mesh_scaling/furnished_hall.h"
#include "bench/program_options.h"
#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"

namespace {

using namespace reemit;

struct Measured {
  double triangles = 0;       // in the file
  double base_triangles = 0;  // in the mesh
  double load_s = 0;          // processor time
  double mesh_s = 0;          // processor time
  double load_mb = 0;         // largest resident set after loading
  double mesh_mb = 0;         // and after meshing
};

rusage usage() {
  rusage now{};
  getrusage(RUSAGE_SELF, &now);
  return now;
}

double seconds(const rusage& r) {
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return of(r.ru_utime) + of(r.ru_stime);
}

double megabytes(const rusage& r) {
  return static_cast<double>(r.ru_maxrss) / 1024;
}

Measured measure_here(const std::filesystem::path& room) {
  Measured m;
  const rusage start = usage();
  const Scene scene = read_scene(room);
  const rusage loaded = usage();
  const MeshResult meshed = build_mesh(scene);
  const rusage done = usage();
  m.base_triangles = static_cast<double>(meshed.mesh.triangle_count());
  m.load_s = seconds(loaded) - seconds(start);
  m.mesh_s = seconds(done) - seconds(loaded);
  m.load_mb = megabytes(loaded);
  m.mesh_mb = megabytes(done);
  return m;
}

/// In a process of its own: the largest resident set is that of a process, and never falls.
Measured measure(const std::filesystem::path& room) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    Measured m;
    try {
      m = measure_here(room);
    } catch (const std::exception& problem) {
      fmt::print(stderr, "{}\n", problem.what());
      _exit(1);
    }
    _exit(write(ends[1], &m, sizeof m) == static_cast<ssize_t>(sizeof m) ? 0 : 1);
  }
  close(ends[1]);
  Measured m;
  const bool complete = read(ends[0], &m, sizeof m) == static_cast<ssize_t>(sizeof m);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!complete) throw std::runtime_error("the room was not meshed");
  return m;
}

/// Slope of the straight line fitted to the logarithms.
double exponent(const std::vector<Measured>& rows, double Measured::*value) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Measured& r : rows) {
    const double x = std::log(r.triangles);
    const double y = std::log(r.*value);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const auto n = static_cast<double>(rows.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void run(const std::vector<std::size_t>& sizes, bench::Growth growth, const std::filesystem::path& folder) {
  fmt::print(
      "{}\n\n| triangles read | base triangles | load [s] | mesh [s] | peak after load [MB] | peak after "
      "meshing [MB] |\n"
      "|---|---|---|---|---|---|\n",
      growth == bench::Growth::kHall ? "Ever larger halls:" : "Ever finer furniture in one hall:");
  std::vector<Measured> rows;
  for (const std::size_t wanted : sizes) {
    const std::filesystem::path room = folder / "hall.obj";
    const std::size_t triangles = bench::write_furnished_hall(room, wanted, growth, 1);
    Measured m = measure(room);
    m.triangles = static_cast<double>(triangles);
    rows.push_back(m);
    fmt::print("| {:.0f} | {:.0f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} |\n", m.triangles, m.base_triangles,
               m.load_s, m.mesh_s, m.load_mb, m.mesh_mb);
    std::fflush(stdout);
  }
  if (rows.size() < 2) return;
  fmt::print("| exponent | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n\n",
             exponent(rows, &Measured::base_triangles), exponent(rows, &Measured::load_s),
             exponent(rows, &Measured::mesh_s), exponent(rows, &Measured::load_mb),
             exponent(rows, &Measured::mesh_mb));
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::size_t> sizes{100'000, 300'000, 1'000'000};
  std::string write;
  bool detail = false;
  bench::ProgramOptions app(
      "Loading and meshing of furnished halls: processor time, memory and their exponents");
  app.add_option("--triangles", sizes, "Sizes of the rooms");
  app.add_option("--write", write, "Only write the first room to this OBJ file");
  app.add_flag("--detail", detail, "With --write: the room that grows in detail");
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    if (!write.empty()) {
      const auto growth = detail ? bench::Growth::kDetail : bench::Growth::kHall;
      fmt::print("{} triangles\n", bench::write_furnished_hall(write, sizes[0], growth, 1));
      return 0;
    }
    std::string pattern = (std::filesystem::temp_directory_path() / "reemit-mesh-scaling-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no folder for the rooms");
    const std::filesystem::path folder(pattern);
    for (const auto growth : {bench::Growth::kHall, bench::Growth::kDetail}) run(sizes, growth, folder);
    std::filesystem::remove_all(folder);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "{}\n", problem.what());
    return 1;
  }
  return 0;
}
