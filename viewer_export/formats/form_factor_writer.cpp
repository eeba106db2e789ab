#include "viewer_export/formats/form_factor_writer.h"

#include <iterator>

#include <fmt/format.h>

#include "scenes/model/error.h"
#include "solver/solution/hdf5_memory_file.h"
#include "viewer_export/output/file_extension.h"

namespace reemit {
namespace {

void write_triplets(const FormFactorData& data, OutputFile& file) {
  for (const auto& [name, value] : data.notes) file.write(fmt::format("# {}: {}\n", name, value));
  file.write("zone_from,zone_to,factor,standard_error\n");
  const FormFactors& factors = data.factors;
  fmt::memory_buffer rows;
  for (std::size_t i = 0; i < factors.zones(); ++i) {
    rows.clear();
    for (std::size_t j = 0; j < factors.zones(); ++j) {
      const double factor = factors.factor(i, j);
      const double error = factors.factor_error(i, j);
      if (factor > 0 || error > 0)
        fmt::format_to(std::back_inserter(rows), "{},{},{},{}\n", i, j, factor, error);
    }
    file.write({rows.data(), rows.size()});
  }
}

/// Values of all pairs in row-major order.
template <class Value>
std::vector<double> dense(std::size_t zones, const Value& value) {
  std::vector<double> all(zones * zones);
  for (std::size_t i = 0; i < zones; ++i)
    for (std::size_t j = 0; j < zones; ++j) all[i * zones + j] = value(i, j);
  return all;
}

void write_zones(const FormFactorData& data, const Hdf5Group& root) {
  const std::size_t zones = data.factors.zones();
  std::vector<double> areas;
  std::vector<std::uint32_t> surfaces;
  std::vector<double> centroids;
  std::vector<double> normals;
  for (std::size_t z = 0; z < zones; ++z) {
    const ZoneId zone(z);
    areas.push_back(data.factors.zone_area(z));
    surfaces.push_back(static_cast<std::uint32_t>(data.mesh.zone_surface(zone).index()));
    const Vec3 centroid = data.mesh.zone_centroid(zone);
    const Vec3 normal = data.mesh.zone_normal(zone);
    centroids.insert(centroids.end(), centroid.begin(), centroid.end());
    normals.insert(normals.end(), normal.begin(), normal.end());
  }
  root.write<double>("zone_area", areas, {zones}, "m2", "area of each zone");
  root.write<std::uint32_t>("zone_surface", surfaces, {zones}, "",
                            "surface of each zone, into surface_names");
  root.write<double>("zone_centroid", centroids, {zones, 3}, "m", "middle of each zone");
  root.write<double>("zone_normal", normals, {zones, 3}, "", "unit normal of each zone, away from its side");
  root.write("surface_names", data.surface_names, "names of the surfaces of the room");
}

void write_hdf5(const FormFactorData& data, OutputFile& file) {
  const Hdf5Quiet quiet;
  try {
    Hdf5MemoryFile memory;
    {
      const Hdf5Group root = memory.root();
      root.write_attribute("format", std::string("reemit form factors"));
      root.write_attribute("format_version", std::uint32_t{1});
      for (const auto& [name, value] : data.notes) root.write_attribute(name, value);
      const FormFactors& factors = data.factors;
      const std::size_t zones = factors.zones();
      root.write<double>("form_factors", dense(zones, [&](auto i, auto j) { return factors.factor(i, j); }),
                         {zones, zones}, "1",
                         "[from, to]: share of the power of one zone that reaches the other");
      root.write<double>("standard_error",
                         dense(zones, [&](auto i, auto j) { return factors.factor_error(i, j); }),
                         {zones, zones}, "1", "standard error of each form factor");
      write_zones(data, root);
    }
    file.write(memory.close());
  } catch (const Hdf5Error& problem) {
    throw ResourceError("form factors", problem.what(),
                        "Use larger zones (solve --zone-area) or write .csv.");
  }
}

constexpr FormFactorFormat kFormFactorFormats[] = {
    {".csv", "triplets, one row per pair that exchanges light", write_triplets},
    {".h5", "dense matrix in HDF5, with the zones", write_hdf5},
};

}  // namespace

std::span<const FormFactorFormat> form_factor_formats() {
  return kFormFactorFormats;
}

const FormFactorFormat& form_factor_format_of(const std::filesystem::path& file) {
  return format_by_extension(form_factor_formats(), file);
}

void write_form_factors(const FormFactorData& data, const std::filesystem::path& file) {
  const FormFactorFormat& format = form_factor_format_of(file);
  OutputFile output(file);
  format.write(data, output);
  output.commit();
}

}  // namespace reemit
