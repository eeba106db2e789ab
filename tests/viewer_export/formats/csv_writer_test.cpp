#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "tests/support/small_disk.h"
#include "tests/support/temp_folder.h"
#include "tests/viewer_export/formats/sample_vertices.h"
#include "viewer_export/formats/export_table.h"

namespace reemit {
namespace {

using test::read_bytes;
using test::sample_vertices;
using test::TempFolder;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(CsvWriter, HasCommentsThenHeaderThenOneRowPerVertex) {
  const TempFolder folder;
  EXPECT_FALSE(write_vertex_data(sample_vertices(BandSet::grey()), folder / "a.csv").has_value());
  const auto lines = lines_of(read_bytes(folder / "a.csv"));
  std::size_t comments = 0;
  while (comments < lines.size() && lines[comments].starts_with("# ")) ++comments;
  EXPECT_THAT(lines, testing::IsSupersetOf(
                         {std::string("# seed: 77"), std::string("# relative error by noise: 0.0125"),
                          std::string("# room: kitchen north.json"), std::string("# gather rays: 256")}));
  ASSERT_EQ(lines.size(), comments + 8);
  EXPECT_EQ(lines[comments],
            "vertex,x,y,z,nx,ny,nz,surface,material,radiance_grey,irradiance_grey,stderr_grey,direct_grey");
  EXPECT_EQ(lines[comments + 1],
            "0,0,0,0,0,0,1,\"floor, \"\"old\"\"\",oak,0.33333334,3.3333333,0.0033333334,0.14285715");
  EXPECT_THAT(lines[comments + 2], testing::StartsWith("1,0,0,2,0,0.6,0.8,wall,plaster,"));
}

TEST(CsvWriter, GroupsColumnsByBand) {
  const TempFolder folder;
  write_vertex_data(sample_vertices(BandSet::spectral({450, 600})), folder / "a.csv");
  EXPECT_THAT(
      read_bytes(folder / "a.csv"),
      HasSubstr("material,radiance_450,irradiance_450,stderr_450,direct_450,radiance_600,irradiance_600,"
                "stderr_600,direct_600\n"));
}

TEST(CsvWriter, NumbersReadBackExactly) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::rgb(), Vec3(1e5, 1.0 / 3, -2e-9));
  write_vertex_data(data, folder / "a.csv");
  const auto lines = lines_of(read_bytes(folder / "a.csv"));
  std::istringstream row(lines.back());
  std::vector<double> numbers;
  for (std::string cell; std::getline(row, cell, ',');)
    numbers.push_back(cell.find_first_not_of("0123456789+-.e") == std::string::npos ? std::stod(cell) : 0);
  const std::size_t last = data.vertex_count() - 1;
  // The name of the last vertex's surface holds one comma.
  ASSERT_EQ(numbers.size(), 9U + 1 + 15);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(numbers[1 + i], data.positions[last][static_cast<Eigen::Index>(i)]);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_EQ(static_cast<float>(numbers[10 + 5 * b]), data.radiance[3 * last + b]);
    EXPECT_EQ(static_cast<float>(numbers[13 + 5 * b]), data.direct_radiance[3 * last + b]);
    EXPECT_EQ(static_cast<float>(numbers[14 + 5 * b]), data.caustic_radiance[3 * last + b]);
  }
}

TEST(ExportTable, RefusesUnknownExtensionsAndListsTheKnown) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::grey());
  for (const char* name : {"a.stl", "a", "a.csv.bak"})
    EXPECT_THAT([&] { write_vertex_data(data, folder / name); },
                ThrowsMessage<InputError>(HasSubstr(".ply, .glb, .csv")));
  EXPECT_TRUE(folder.listing().empty());
  EXPECT_EQ(export_format_of("A.PLY").extension, ".ply");
}

TEST(ExportTable, RefusesInconsistentData) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::grey());
  data.triangles.push_back({0, 1, 7});
  EXPECT_THROW(write_vertex_data(data, folder / "a.ply"), std::invalid_argument);
  data = sample_vertices(BandSet::grey());
  data.irradiance.pop_back();
  EXPECT_THROW(write_vertex_data(data, folder / "a.csv"), std::invalid_argument);
}

TEST(ExportTable, FullDiskKeepsThePreviousFile) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::rgb());
  for (const ExportFormat& format : export_formats()) {
    const auto file = folder / ("a" + std::string(format.extension));
    test::write_bytes(file, "old");
    {
      const test::SmallDisk disk(200);
      EXPECT_THROW(write_vertex_data(data, file), ResourceError) << format.extension;
    }
    EXPECT_EQ(read_bytes(file), "old");
  }
  EXPECT_EQ(folder.listing().size(), export_formats().size());
}

TEST(ExportTable, SameDataGivesSameBytes) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::rgb());
  for (const ExportFormat& format : export_formats()) {
    const std::string extension(format.extension);
    write_vertex_data(data, folder / ("a" + extension));
    write_vertex_data(data, folder / ("b" + extension));
    EXPECT_EQ(read_bytes(folder / ("a" + extension)), read_bytes(folder / ("b" + extension))) << extension;
  }
}

}  // namespace
}  // namespace reemit
