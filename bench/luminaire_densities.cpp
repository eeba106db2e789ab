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

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ostream.h>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/shapes/cylinder_sampler.h"
#include "solver/sampling/shapes/disk_sampler.h"
#include "solver/sampling/shapes/plane_maps.h"
#include "solver/sampling/shapes/rectangle_sampler.h"
#include "solver/sampling/shapes/sphere_sampler.h"
#include "solver/trace/ray_scene.h"

namespace {

using namespace reemit;

constexpr std::array<Density, 4> kDensities{Density::kArea, Density::kVisibleArea, Density::kSolidAngle,
                                            Density::kCosine};
constexpr std::array<const char*, 4> kNames{"area", "visible area", "solid angle", "cosine"};
constexpr std::array<double, 6> kDistances{0.05, 0.3, 1, 3, 10, 100};
constexpr int kReuse = 16;  // samples per sampler in the second timing

struct Options {
  int places = 64;
  int samples = 4096;
  int repeats = 5;
  double ray_ns = 0;  // of a shadow ray; 0: measure it
  std::string folder;
};

/// A place to be lit, and the plane through it past which the luminaire is hidden.
struct Place {
  Vec3 x, n, shadow;
};

struct Row {
  std::string shape;
  double distance = 0;
  std::size_t density = 0;
  double variance = 0;     // of one sample over the squared mean, places pooled
  double in_penumbra = 0;  // the same with the luminaire cut by the plane
  double ns_one = 0;       // per sample, one sample per place
  double ns_many = 0;      // per sample, kReuse samples per place

  /// Relative error after `ns` nanoseconds, half of the places lit in full and half in penumbra.
  double error_after(double ns, double ray, double own) const {
    return std::sqrt(0.5 * (variance + in_penumbra) * (own + ray) / ns);
  }
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
      double variance = 0;
      double penumbra = 0;
      double squares = 0;
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Place& place = places[k];
        const auto sampler = make(place.x, place.n, kDensities[d]);
        Numbers numbers(100 + k);
        std::array<double, 2> sum{};
        std::array<double, 2> sum2{};
        for (int i = 0; i < options.samples; ++i) {
          const auto u = numbers.pair();
          const ShapePoint s = sampler.sample(u[0], u[1]);
          const bool seen = place.shadow.dot(s.point - place.x) > 0;
          const std::array<double, 2> v{s.irradiance, seen ? s.irradiance : 0.0};
          for (std::size_t j = 0; j < 2; ++j) {
            sum[j] += v[j];
            sum2[j] += v[j] * v[j];
          }
        }
        const double n = options.samples;
        const auto spread = [&](std::size_t j) {
          return std::max(0.0, (sum2[j] - sum[j] * sum[j] / n) / (n - 1));
        };
        variance += spread(0);
        penumbra += spread(1);
        squares += sum[0] * sum[0] / (n * n);
      }
      row.variance = variance / squares;
      row.in_penumbra = penumbra / squares;

      std::vector<std::array<double, 2>> numbers;
      Numbers source(5);
      for (int i = 0; i < 1024; ++i) numbers.push_back(source.pair());
      double sink = 0;
      row.ns_one = row.ns_many = std::numeric_limits<double>::infinity();
      for (int r = 0; r < options.repeats; ++r) {
        for (const int per_place : {1, kReuse}) {
          const int rounds = 20'000 / per_place / static_cast<int>(places.size()) + 1;
          const double start = now_ns();
          std::size_t next = 0;
          for (int round = 0; round < rounds; ++round)
            for (const Place& place : places) {
              const auto sampler = make(place.x, place.n, kDensities[d]);
              for (int i = 0; i < per_place; ++i) {
                const auto& u = numbers[next++ % numbers.size()];
                sink += sampler.sample(u[0], u[1]).irradiance;
              }
            }
          double& best = per_place == 1 ? row.ns_one : row.ns_many;
          best = std::min(best, (now_ns() - start) / static_cast<double>(next));
        }
      }
      if (!std::isfinite(sink)) throw std::runtime_error(name + ": a sample is not finite");
      rows.push_back(row);
    }
  }
}

/// Nanoseconds of a shadow ray from a random point of the Cornell box to its luminaire.
double shadow_ray_ns(int repeats) {
  const Scene scene = read_scene(REEMIT_SOURCE_DIR "/scenes/library/cornell_box.json");
  const MeshResult built = build_mesh(scene);
  const RayScene rays(built.mesh);
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

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

constexpr double kTime = 1e6;  // [ns] that errors are stated for

void write_csv(const std::vector<Row>& rows, double ray, const std::filesystem::path& file) {
  std::ofstream out(file);
  fmt::print(out, "# {}, shadow ray {:.0f} ns\n", processor(), ray);
  fmt::print(out,
             "shape,distance_sizes,density,relative_variance,relative_variance_penumbra,ns_one_sample,"
             "ns_of_{}_samples,error_1ms_one,error_1ms_one_with_ray,error_1ms_many_with_ray\n",
             kReuse);
  for (const Row& r : rows)
    fmt::print(out, "{},{},{},{:.4g},{:.4g},{:.1f},{:.1f},{:.4g},{:.4g},{:.4g}\n", r.shape, r.distance,
               kNames[r.density], r.variance, r.in_penumbra, r.ns_one, r.ns_many,
               r.error_after(kTime, 0, r.ns_one), r.error_after(kTime, ray, r.ns_one),
               r.error_after(kTime, ray, r.ns_many));
  if (!out.flush()) throw std::runtime_error(fmt::format("{} cannot be written", file.string()));
}

/// Density with the least error of the four rows from `first`, one sample or kReuse of them per place.
std::size_t best_of(const std::vector<Row>& rows, std::size_t first, double ray, bool many) {
  std::size_t best = first;
  const auto error = [&](std::size_t i) {
    return rows[i].error_after(kTime, ray, many ? rows[i].ns_many : rows[i].ns_one);
  };
  for (std::size_t i = first; i < first + kDensities.size(); ++i)
    if (error(i) < error(best)) best = i;
  return best - first;
}

const Row& row_at(const std::vector<Row>& rows, std::size_t shape, double distance, Density density) {
  for (std::size_t i = shape; i < shape + kDistances.size() * kDensities.size(); ++i)
    if (rows[i].distance == distance && kDensities[rows[i].density] == density) return rows[i];
  throw std::logic_error("a distance that was not measured");
}

void write_solid_angle_against_area(const std::vector<Row>& rows, double ray, std::ostream& out) {
  fmt::print(
      out,
      "\n## Solid angle against area\n\nClose to a luminaire solid angles take the variance of area "
      "samples down by far more than a factor of 4. Far from it they cost time:\n\n"
      "| shape | variance of area over solid angle at 0.05 | at 0.3 | time of solid angle over area at "
      "100, with a shadow ray | variance there: area | solid angle |\n|---|---|---|---|---|---|\n");
  const std::size_t per_shape = kDistances.size() * kDensities.size();
  for (std::size_t s = 0; s < rows.size(); s += per_shape) {
    const auto gain = [&](double d) {
      return row_at(rows, s, d, Density::kArea).variance / row_at(rows, s, d, Density::kSolidAngle).variance;
    };
    const Row& area = row_at(rows, s, 100, Density::kArea);
    const Row& angle = row_at(rows, s, 100, Density::kSolidAngle);
    fmt::print(out, "| {} | {:.0f} | {:.0f} | {:.2f} | {:.2g} | {:.2g} |\n", rows[s].shape, gain(0.05),
               gain(0.3), (ray + angle.ns_one) / (ray + area.ns_one), area.variance, angle.variance);
  }
  fmt::print(
      out,
      "\nFlat shapes lose more than 20 % there, because the square roots and arc functions of a solid "
      "angle cost as much as a shadow ray while area needs none, and there is next to no variance left "
      "to remove. That is why the solver draws from the area of flat shapes when they are far. Spheres "
      "and cylinders turn away from the point at their rims at any distance, so for them area stays "
      "noisy and the angle pays.\n\n"
      "What the solver draws from (`solver/emit/default_density.h`), the distance being that to the "
      "middle over the diameter of the sphere around the luminaire: spheres cosine; polygons and disks "
      "cosine below 0.6, solid angle below 2, area beyond; cylinders cosine below 0.6, solid angle "
      "beyond; rings and cones area.\n");
}

void write_page(const std::vector<Row>& rows, double ray, const Options& options,
                const std::filesystem::path& file) {
  std::ofstream out(file);
  fmt::print(out,
             "# Densities of luminaires\n\nWritten by\n\n```\nbuild/release/bench/bench_luminaire_densities "
             "--write docs\n```\n\n");
  fmt::print(
      out,
      "on {}, one thread; all numbers are in [luminaire_densities.csv](luminaire_densities.csv). A luminaire "
      "of size 1 is looked at\nfrom {} random places per distance, which is measured from a random "
      "point of it; {} samples per place give the variance.\n\n- **variance**: of one sample over the "
      "squared mean, places pooled, nothing in the way.\n- **penumbra**: the same with a plane through "
      "the place that hides what is on one side of it, over the same squared mean.\n- **ns**: per "
      "sample, making the sampler included, one sample per place and {} per place.\n- **error**: "
      "relative, after 1 ms of samples at such places, half of them in penumbra; without and with the "
      "{:.0f} ns\n  of a shadow ray{} added to every sample (one sample per "
      "place).\n\n",
      processor(), options.places, options.samples, kReuse, ray,
      options.ray_ns > 0 ? " (assumed)" : " in the Cornell box");
  fmt::print(out, "## Least error in a given time, with a shadow ray\n\n| shape |");
  for (const double d : kDistances) fmt::print(out, " {:g} |", d);
  fmt::print(out, "\n|---|");
  for (std::size_t i = 0; i < kDistances.size(); ++i) fmt::print(out, "---|");
  fmt::print(out, "\n");
  const std::size_t per_shape = kDistances.size() * kDensities.size();
  for (std::size_t s = 0; s < rows.size(); s += per_shape)
    for (const bool many : {false, true}) {
      fmt::print(out, "| {}, {} |", rows[s].shape, many ? fmt::format("{} samples", kReuse) : "1 sample");
      for (std::size_t i = 0; i < kDistances.size(); ++i)
        fmt::print(out, " {} |", kNames[best_of(rows, s + i * kDensities.size(), ray, many)]);
      fmt::print(out, "\n");
    }
  write_solid_angle_against_area(rows, ray, out);
  for (std::size_t s = 0; s < rows.size(); s += per_shape) {
    fmt::print(out,
               "\n## {}\n\n| distance | density | variance | penumbra | ns, 1 | ns, {} | error | with ray |\n"
               "|---|---|---|---|---|---|---|---|\n",
               rows[s].shape, kReuse);
    for (std::size_t i = s; i < s + per_shape; ++i) {
      const Row& r = rows[i];
      fmt::print(out, "| {:g} | {} | {:.2g} | {:.2g} | {:.0f} | {:.0f} | {:.2g} % | {:.2g} % |\n", r.distance,
                 kNames[r.density], r.variance, r.in_penumbra, r.ns_one, r.ns_many,
                 100 * r.error_after(kTime, 0, r.ns_one), 100 * r.error_after(kTime, ray, r.ns_one));
    }
  }
  if (!out.flush()) throw std::runtime_error(fmt::format("{} cannot be written", file.string()));
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
  CLI::App app("Variance and cost of the densities that luminaires are sampled with");
  Options options;
  app.add_option("--write", options.folder, "Folder for luminaire_densities.md and .csv")->required();
  app.add_option("--places", options.places, "Places per distance")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  app.add_option("--samples", options.samples, "Samples per place and density")
      ->capture_default_str()
      ->check(CLI::Range(16, 1'000'000));
  app.add_option("--repeats", options.repeats, "Timings, of which the best counts")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--shadow-ray-ns", options.ray_ns,
                 "Cost of a shadow ray; measured in the Cornell box if not given")
      ->check(CLI::Range(1.0, 1e6));
  CLI11_PARSE(app, argc, argv);
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
