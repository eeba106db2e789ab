#include "bench/luminaire_densities_page.h"

#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "bench/processor_name.h"

namespace reemit::bench {
namespace {

constexpr double kTime = 1e6;  // [ns] that errors are stated for

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

}  // namespace

void write_csv(const std::vector<Row>& rows, double ray, const std::filesystem::path& file) {
  std::ofstream out(file);
  fmt::print(out, "# {}, shadow ray {:.0f} ns\n", processor_name(), ray);
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

std::size_t best_of(const std::vector<Row>& rows, std::size_t first, double ray, bool many) {
  std::size_t best = first;
  const auto error = [&](std::size_t i) {
    return rows[i].error_after(kTime, ray, many ? rows[i].ns_many : rows[i].ns_one);
  };
  for (std::size_t i = first; i < first + kDensities.size(); ++i)
    if (error(i) < error(best)) best = i;
  return best - first;
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
      processor_name(), options.places, options.samples, kReuse, ray,
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

}  // namespace reemit::bench
