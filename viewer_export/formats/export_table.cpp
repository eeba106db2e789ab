#include "viewer_export/formats/export_table.h"

#include "scenes/model/error.h"
#include "viewer_export/formats/csv_writer.h"
#include "viewer_export/formats/glb_writer.h"
#include "viewer_export/formats/ply_writer.h"
#include "viewer_export/output/file_extension.h"

namespace reemit {
namespace {

constexpr ExportFormat kExportFormats[] = {
    {".ply", "polygons with all radiometric values (MeshLab, Blender, CloudCompare)", true, write_ply},
    {".glb", "binary glTF 2.0, ready to view (Blender, three.js, any glTF viewer)", true, write_glb},
    {".csv", "a table, one row per vertex (spreadsheets, pandas, R)", false, write_csv},
};

}  // namespace

std::span<const ExportFormat> export_formats() {
  return kExportFormats;
}

const ExportFormat& export_format_of(const std::filesystem::path& file) {
  return format_by_extension(export_formats(), file);
}

void check_photometric(const std::filesystem::path& file) {
  if (export_format_of(file).write == write_csv) return;
  throw InputError(file.string(), "--units lx is for .csv: viewers read colours and radiance",
                   "Write .csv, or leave --units out: `quality` in .ply is luminance [cd/m2].");
}

void write_photometric_data(const VertexData& data, const std::filesystem::path& file) {
  check_photometric(file);
  check_consistent(data);
  OutputFile output(file);
  write_photometric_csv(data, output);
  output.commit();
}

std::optional<ToneMap> write_vertex_data(const VertexData& data, const std::filesystem::path& file) {
  const ExportFormat& format = export_format_of(file);
  check_consistent(data);
  OutputFile output(file);
  std::optional<ToneMap> tone_map = format.write(data, output);
  output.commit();
  return tone_map;
}

}  // namespace reemit
