// Variance and cost of the densities that luminaires are sampled with, over shapes and distances: which of
// them gives the least error in a given time.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/luminaire_densities_page.h"
#include "bench/program_options.h"
#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/shapes/cylinder_sampler.h"
#include "solver/sampling/shapes/disk_sampler.h"
#include "solver/sampling/shapes/plane_maps.h"
#include "solver/sampling/shapes/rectangle_sampler.h"
#include "solver/sampling/shapes/sphere_sampler.h"
#include "solver/trace/ray_tracer.h"

namespace {

using namespace reemit;
using namespace reemit::bench;

/// A place to be lit, and the plane through it past which the luminaire is hidden.
struct Place {
  Vec3 x, n, shadow;
};

/// Uniform numbers in [0,1) with 53 bits.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : rng_(seed, RngPurpose::kProbe) {}
  std::array<double, 2> pair() {
    const auto b = rng_.bits4(index_++, 0, 0);
    const auto unit = [](std::uint32_t high, std::uint32_t low) {
      return static_cast<double>(((std::uint64_t{high} << 32) | low) >> 11) * 0x1p-53;
    };
    return {unit(b[0], b[1]), unit(b[2], b[3])};
  }
  Vec3 direction() {
    const auto u = pair();
    return unit_cap(u[0], u[1], 2);
  }

 private:
  CounterRng rng_;
  std::uint64_t index_ = 0;
};

double now_ns() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Places at the given distance from random points of the shape, cosine-distributed about its normal there,
/// that look towards the point or up to some 60 degrees past it. `make(x, n, density)`.
template <class Make>
std::vector<Place> places_around(const Make& make, double distance, int count) {
  Numbers numbers(17);
  std::vector<Place> places;
  while (static_cast<int>(places.size()) < count) {
    // A sampler by area for some place: its points and normals do not depend on the place.
    const Vec3 anywhere = 3 * numbers.direction();
    const auto shape = make(anywhere, -anywhere.normalized(), Density::kArea);
    const auto u = numbers.pair();
    const Vec3 spread = numbers.direction();
    const Vec3 tilt = numbers.direction();
    const Vec3 across = numbers.direction();
    if (!shape.lights()) continue;
    const ShapePoint p = shape.sample(u[0], u[1]);
    const Vec3 away = (p.normal + 0.999 * spread).normalized();
    const Place place{p.point + distance * away, (-away + 0.85 * tilt).normalized(),
                      away.cross(across).normalized()};
    if (make(place.x, place.n, Density::kCosine).lights()) places.push_back(place);
  }
  return places;
}

/// Variances of one sample relative to the square of its mean, over all places: with nothing in the way, and
/// in the penumbra of an edge.
template <class Make>
void measure_variance(const Make& make, const std::vector<Place>& places, int samples, Row& row) {
  double variance = 0;
  double penumbra = 0;
  double squares = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Place& place = places[k];
    const auto sampler = make(place.x, place.n, kDensities[row.density]);
    Numbers numbers(100 + k);
    std::array<double, 2> sum{};
    std::array<double, 2> sum2{};
    for (int i = 0; i < samples; ++i) {
      const auto u = numbers.pair();
      const ShapePoint s = sampler.sample(u[0], u[1]);
      const bool seen = place.shadow.dot(s.point - place.x) > 0;
      const std::array<double, 2> v{s.irradiance, seen ? s.irradiance : 0.0};
      for (std::size_t j = 0; j < 2; ++j) {
        sum[j] += v[j];
        sum2[j] += v[j] * v[j];
      }
    }
    const double n = samples;
    const auto spread = [&](std::size_t j) {
      return std::max(0.0, (sum2[j] - sum[j] * sum[j] / n) / (n - 1));
    };
    variance += spread(0);
    penumbra += spread(1);
    squares += sum[0] * sum[0] / (n * n);
  }
  row.variance = variance / squares;
  row.in_penumbra = penumbra / squares;
}

/// Shortest times of a sample over the repeats: with a sampler of its own, and with one for many. Returns the
/// sum of what was drawn, so that drawing cannot be left out.
template <class Make>
double measure_time(const Make& make, const std::vector<Place>& places, int repeats, Row& row) {
  std::vector<std::array<double, 2>> numbers;
  Numbers source(5);
  for (int i = 0; i < 1024; ++i) numbers.push_back(source.pair());
  double sink = 0;
  row.ns_one = row.ns_many = std::numeric_limits<double>::infinity();
  for (int r = 0; r < repeats; ++r) {
    for (const int per_place : {1, kReuse}) {
      const int rounds = 20'000 / per_place / static_cast<int>(places.size()) + 1;
      const double start = now_ns();
      std::size_t next = 0;
      for (int round = 0; round < rounds; ++round)
        for (const Place& place : places) {
          const auto sampler = make(place.x, place.n, kDensities[row.density]);
          for (int i = 0; i < per_place; ++i) {
            const auto& u = numbers[next++ % numbers.size()];
            sink += sampler.sample(u[0], u[1]).irradiance;
          }
        }
      double& best = per_place == 1 ? row.ns_one : row.ns_many;
      best = std::min(best, (now_ns() - start) / static_cast<double>(next));
    }
  }
  return sink;
}

template <class Make>
void measure_shape(const std::string& name, const Make& make, const Options& options,
                   std::vector<Row>& rows) {
  for (const double distance : kDistances) {
    const std::vector<Place> places = places_around(make, distance, options.places);
    for (std::size_t d = 0; d < kDensities.size(); ++d) {
      Row row;
      row.shape = name;
      row.distance = distance;
      row.density = d;
      measure_variance(make, places, options.samples, row);
      if (!std::isfinite(measure_time(make, places, options.repeats, row)))
        throw std::runtime_error(name + ": a sample is not finite");
      rows.push_back(row);
    }
  }
}

/// Nanoseconds of a shadow ray from a random point of the Cornell box to its luminaire.
double shadow_ray_ns(int repeats) {
  const Scene scene = read_scene(REEMIT_SOURCE_DIR "/scenes/library/cornell_box.json");
  const MeshResult built = build_mesh(scene);
  const RayTracer rays(built.mesh);
  TriangleId lamp;
  for (std::size_t t = 0; t < built.mesh.triangle_count(); ++t) {
    const Surface& surface = scene.surfaces[built.mesh.base().triangles[t].surface.index()];
    if (scene.material_of(surface).emitted_radiance.maxCoeff() > 0) lamp = TriangleId(t);
  }
  if (!lamp.valid()) throw std::runtime_error("the Cornell box has no luminaire");
  Numbers numbers(3);
  std::vector<std::array<Vec3f, 2>> ends;
  const auto start_on = [&](TriangleId t) {
    const auto u = numbers.pair();
    const double s = std::sqrt(u[0]);
    return rays.ray_origin(t, static_cast<float>(s * (1 - u[1])), static_cast<float>(s * u[1]), true);
  };
  while (ends.size() < 20'000) {
    const auto u = numbers.pair();
    const auto t =
        TriangleId(static_cast<std::size_t>(u[0] * static_cast<double>(built.mesh.triangle_count())));
    if (t.index() != lamp.index()) ends.push_back({start_on(t), start_on(lamp)});
  }
  double best = std::numeric_limits<double>::infinity();
  std::size_t seen = 0;
  for (int r = 0; r < repeats; ++r) {
    const double start = now_ns();
    for (const auto& [from, to] : ends) seen += rays.visible(from, to) ? 1 : 0;
    best = std::min(best, (now_ns() - start) / static_cast<double>(ends.size()));
  }
  if (seen == 0) throw std::runtime_error("no shadow ray arrives");
  return best;
}

std::vector<Row> measure(const Options& options) {
  std::vector<Row> rows;
  const auto sphere = [](const Vec3& x, const Vec3& n, Density d) {
    return SphereSampler({{0, 0, 0}, 0.5}, x, n, d);
  };
  const auto disk = [](const Vec3& x, const Vec3& n, Density d) {
    return DiskSampler({{0, 0, 0}, {0, 0, 1}, 0.5}, x, n, d);
  };
  const auto tube = [](const Vec3& x, const Vec3& n, Density d) {
    return CylinderSampler({{0, 0, -0.5}, {0, 0, 0.5}, 0.0125}, x, n, d);
  };
  const auto drum = [](const Vec3& x, const Vec3& n, Density d) {
    return CylinderSampler({{0, 0, -0.5}, {0, 0, 0.5}, 0.5}, x, n, d);
  };
  const auto square = [](const Vec3& x, const Vec3& n, Density d) {
    return RectangleSampler({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, x, n, d);
  };
  const auto strip = [](const Vec3& x, const Vec3& n, Density d) {
    return RectangleSampler({-0.5, -0.05, 0}, {1, 0, 0}, {0, 0.1, 0}, {0, 0, 1}, x, n, d);
  };
  const auto triangle = [](const Vec3& x, const Vec3& n, Density d) {
    return TriangleSampler({Vec3(-0.5, -0.3, 0), Vec3(0.5, -0.3, 0), Vec3(0, 0.55, 0)}, {0, 0, 1}, x, n, d);
  };
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    const double phi = 2 * std::numbers::pi * i / 8;
    corners.push_back({0.5 * std::cos(phi), 0.5 * std::sin(phi), 0});
  }
  const auto octagon = [&](const Vec3& x, const Vec3& n, Density d) {
    return ConvexPolygonSampler(corners, {0, 0, 1}, x, n, d);
  };
  measure_shape("sphere", sphere, options, rows);
  measure_shape("disk", disk, options, rows);
  measure_shape("cylinder 40:1", tube, options, rows);
  measure_shape("cylinder 1:1", drum, options, rows);
  measure_shape("square", square, options, rows);
  measure_shape("rectangle 10:1", strip, options, rows);
  measure_shape("triangle", triangle, options, rows);
  measure_shape("octagon", octagon, options, rows);
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  ProgramOptions app("Variance and cost of the densities that luminaires are sampled with");
  Options options;
  app.add_option("--write", options.folder, "Folder for luminaire_densities.md and .csv").required();
  app.add_option("--places", options.places, "Places per distance").show_default().in_range(1, 10'000);
  app.add_option("--samples", options.samples, "Samples per place and density")
      .show_default()
      .in_range(16, 1'000'000);
  app.add_option("--repeats", options.repeats, "Timings, of which the best counts")
      .show_default()
      .in_range(1, 1000);
  app.add_option("--shadow-ray-ns", options.ray_ns,
                 "Cost of a shadow ray; measured in the Cornell box if not given")
      .in_range(1.0, 1e6);
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    const std::filesystem::path out(options.folder);
    std::filesystem::create_directories(out);
    const double ray = options.ray_ns > 0 ? options.ray_ns : shadow_ray_ns(options.repeats);
    const std::vector<Row> rows = measure(options);
    write_csv(rows, ray, out / "luminaire_densities.csv");
    write_page(rows, ray, options, out / "luminaire_densities.md");
    for (std::size_t i = 0; i < rows.size(); i += kDensities.size())
      fmt::print("{:16} at {:5g} sizes: {} (1 sample per place), {} ({})\n", rows[i].shape, rows[i].distance,
                 kNames[best_of(rows, i, ray, false)], kNames[best_of(rows, i, ray, true)], kReuse);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}
