#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/convergence/measurement.h"
#include "bench/convergence/reference.h"
#include "scenes/model/camera.h"
#include "scenes/model/scene.h"
#include "scenes/model/stopwatch.h"

namespace reemit::bench {

struct Options {
  int threads = 2;
  int seeds = 3;
  /// Leave the longest level of every method out and make references with a quarter of the work.
  bool quick = false;
  std::filesystem::path rooms;  ///< Folder below which rooms that are not ours are looked for; may be empty.
  std::filesystem::path reference_cache;  ///< Empty: references are made anew.
};

/// A room and how much of it is measured.
struct StudiedRoom {
  std::string name;
  Scene scene;
  Camera camera;
  int picture_size = 128;         ///< Width and height of stills [px].
  int tile_stride = 4;            ///< Every so manyeth tile of a still is compared with the reference.
  int reference_samples = 4096;   ///< Path-traced camera rays per pixel of the reference.
  std::vector<int> path_samples;  ///< Camera rays per pixel of path-traced stills, one per level.
  double vertex_zone_area = 0;    ///< Largest zone area of the mesh whose vertices are wanted [m2].
  int vertex_stride = 7;          ///< Every so manyeth vertex is compared with the reference.
  bool stills_only = false;
  bool longer_stills = false;  ///< Smoothed ones go a level further.
};

/// The rooms that are there; what is missing is noted in `table`.
std::vector<StudiedRoom> find_rooms(const Options& options, Table& table);

/// Zone solution by walks and by shooting, random and quasi-random: error over time. Adds rows and notes.
void measure_zones(const StudiedRoom& room, const Options& options, const ReferenceCache& cache,
                   Table& table);

/// Vertex values by averaging zones and by gathering, solve included. Adds rows and notes.
void measure_vertices(const StudiedRoom& room, const Options& options, const ReferenceCache& cache,
                      Table& table);

/// Stills by the three integrators, solve included where a zone solution is read. Adds rows and notes.
void measure_stills(const StudiedRoom& room, const Options& options, const ReferenceCache& cache,
                    Table& table);

/// Adds the row and prints it to stderr.
void report(const Measurement& row, Table& table);

/// Wall time of a call [s].
template <class Call>
double seconds_of(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return seconds_since(start);
}

/// Seed of everything that goes into references; measured runs use 1, 2, ...
inline constexpr std::uint64_t kReferenceSeed = 1'000'000;

}  // namespace reemit::bench
