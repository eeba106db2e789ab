#include "viewer_export/points/points_csv.h"

#include <iterator>
#include <string>

#include <fmt/format.h>

#include "scenes/io/common/output_file.h"
#include "viewer_export/formats/csv_text.h"

namespace reemit {
namespace {

std::string units_of(const MeasuredLight& light) {
  std::string units =
      "lengths in m, irradiance in W/m2 within its band, illuminance in lx; stderr is the standard error";
  if (light.outside > 0)
    units += fmt::format(", daylight factor in % of {:.6g} lx of the sky outside", light.outside);
  return units;
}

std::string heading(const MeasuredLight& light) {
  std::string names = "point,set,x,y,z,nx,ny,nz,illuminance,stderr_illuminance,direct_illuminance";
  if (light.outside > 0) names += ",daylight_factor_percent";
  for (const std::string& band : light.bands.names())
    names += fmt::format(",irradiance_{0},stderr_{0},direct_{0}", band);
  return names + '\n';
}

}  // namespace

void write_points_csv(const MeasuredLight& light, const std::filesystem::path& file) {
  OutputFile output(file);
  write_csv_comments(light.info, light.bands, units_of(light), output);
  output.write(heading(light));
  const auto append = [](fmt::memory_buffer& row, const Irradiance& value) {
    fmt::format_to(std::back_inserter(row), ",{},{},{}", value.all, value.standard_error, value.direct);
  };
  const std::size_t bands = light.bands.count();
  std::size_t point = 0;
  fmt::memory_buffer row;
  for (const PointSet& set : light.sets) {
    const std::string name = csv_cell(one_line(set.name));
    for (std::size_t i = 0; i < set.size(); ++i, ++point) {
      const Vec3& p = set.places[i];
      const Vec3& n = set.normals[i];
      row.clear();
      fmt::format_to(std::back_inserter(row), "{},{},{},{},{},{},{},{}", point, name, p.x(), p.y(), p.z(),
                     n.x(), n.y(), n.z());
      append(row, light.illuminance[point]);
      if (light.outside > 0)
        fmt::format_to(
            std::back_inserter(row), ",{}",
            static_cast<float>(100 * static_cast<double>(light.illuminance[point].all) / light.outside));
      for (std::size_t b = 0; b < bands; ++b) append(row, light.irradiance[point * bands + b]);
      row.push_back('\n');
      output.write({row.data(), row.size()});
    }
  }
  output.commit();
}

}  // namespace reemit
