#include "viewer_export/formats/csv_writer.h"

#include <iterator>

#include <fmt/format.h>

#include "viewer_export/formats/csv_text.h"

namespace reemit {
namespace {

/// The lines above the rows; `values` are the columns behind those that every table has.
void write_header(const VertexData& data, const std::string& units, const std::string& values,
                  OutputFile& file) {
  write_csv_comments(data.info, data.bands, units, file);
  file.write("vertex,x,y,z,nx,ny,nz,surface,material" + values + "\n");
}

/// `append_values` adds the columns of a vertex to its row.
template <class Append>
void write_rows(const VertexData& data, OutputFile& file, Append&& append_values) {
  std::vector<std::string> surfaces;
  std::vector<std::string> materials;
  for (const std::string& name : data.surface_names) surfaces.push_back(csv_cell(one_line(name)));
  for (const std::string& name : data.material_names) materials.push_back(csv_cell(one_line(name)));

  fmt::memory_buffer row;
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    row.clear();
    const Vec3& p = data.positions[v];
    const Vec3& n = data.normals[v];
    fmt::format_to(std::back_inserter(row), "{},{},{},{},{},{},{},{},{}", v, p.x(), p.y(), p.z(), n.x(),
                   n.y(), n.z(), surfaces[data.surfaces[v].index()], materials[data.materials[v].index()]);
    append_values(v, row);
    row.push_back('\n');
    file.write({row.data(), row.size()});
  }
}

}  // namespace

std::optional<ToneMap> write_csv(const VertexData& data, OutputFile& file) {
  std::string values;
  const bool caustics = !data.caustic_radiance.empty();
  for (const std::string& band : data.bands.names()) {
    values += fmt::format(",radiance_{0},irradiance_{0},stderr_{0},direct_{0}", band);
    if (caustics) values += ",caustic_" + band;
  }
  write_header(data, "", values, file);
  const std::size_t bands = data.bands.count();
  write_rows(data, file, [&](std::size_t v, fmt::memory_buffer& row) {
    for (std::size_t i = v * bands; i < (v + 1) * bands; ++i) {
      fmt::format_to(std::back_inserter(row), ",{},{},{},{}", data.radiance[i], data.irradiance[i],
                     data.radiance_stderr[i], data.direct_radiance[i]);
      if (caustics) fmt::format_to(std::back_inserter(row), ",{}", data.caustic_radiance[i]);
    }
  });
  return std::nullopt;
}

std::optional<ToneMap> write_photometric_csv(const VertexData& data, OutputFile& file) {
  std::vector columns{&data.radiance, &data.irradiance, &data.radiance_stderr, &data.direct_radiance};
  std::string names = ",luminance,illuminance,stderr_luminance,direct_luminance";
  if (!data.caustic_radiance.empty()) {
    columns.push_back(&data.caustic_radiance);
    names += ",caustic_luminance";
  }
  const Spectrum& efficacy = data.bands.efficacy_lm_per_w();
  const double outside = data.outside.size() > 0 ? (efficacy * data.outside).sum() : 0;
  if (outside > 0) names += ",daylight_factor_percent";
  write_header(data,
               outside > 0
                   ? fmt::format("lengths in m, luminance in cd/m2, illuminance in lx, daylight factor in "
                                 "% of {:.6g} lx of the sky outside",
                                 outside)
                   : "lengths in m, luminance in cd/m2, illuminance in lx",
               names, file);
  const auto bands = static_cast<std::size_t>(efficacy.size());
  write_rows(data, file, [&](std::size_t v, fmt::memory_buffer& row) {
    double illuminance = 0;
    for (const auto* values : columns) {
      double sum = 0;
      for (std::size_t b = 0; b < bands; ++b)
        sum += efficacy[static_cast<Eigen::Index>(b)] * static_cast<double>((*values)[v * bands + b]);
      fmt::format_to(std::back_inserter(row), ",{}", static_cast<float>(sum));
      if (values == &data.irradiance) illuminance = sum;
    }
    if (outside > 0)
      fmt::format_to(std::back_inserter(row), ",{}", static_cast<float>(100 * illuminance / outside));
  });
  return std::nullopt;
}

}  // namespace reemit
