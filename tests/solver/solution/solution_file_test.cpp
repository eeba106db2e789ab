#include "solver/solution/solution_file.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include "scenes/model/error.h"
#include "solver/solution/file_seal.h"
#include "solver/solution/hdf5_group.h"
#include "tests/solver/solution/sample_solution.h"
#include "tests/support/same_light.h"
#include "tests/support/small_disk.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using test::expect_same_light;
using test::expect_same_plan;
using test::read_bytes;
using test::sample_solution;
using test::SmallDisk;
using test::TempFolder;
using test::write_bytes;
using testing::HasSubstr;
using testing::ThrowsMessage;

void expect_same_settings(const Solution& a, const Solution& b) {
  EXPECT_EQ(a.program_version, b.program_version);
  EXPECT_EQ(a.room_path, b.room_path);
  EXPECT_EQ(a.more_room_paths, b.more_room_paths);
  EXPECT_EQ(a.room_hash, b.room_hash);
  EXPECT_EQ(a.read_options, b.read_options);
  EXPECT_EQ(a.mesh_settings.zone_area, b.mesh_settings.zone_area);
  EXPECT_EQ(a.mesh_settings.default_zone_count, b.mesh_settings.default_zone_count);
  EXPECT_EQ(a.mesh_settings.smallest_angle_deg, b.mesh_settings.smallest_angle_deg);
  EXPECT_EQ(a.mesh_settings.crease_angle_deg, b.mesh_settings.crease_angle_deg);
  EXPECT_EQ(a.mesh_settings.exact_shapes, b.mesh_settings.exact_shapes);
  EXPECT_EQ(a.settings.method, b.settings.method);
  EXPECT_EQ(a.settings.sampling, b.settings.sampling);
  EXPECT_EQ(a.settings.direct, b.settings.direct);
  EXPECT_EQ(a.settings.error_target, b.settings.error_target);
  EXPECT_EQ(a.settings.time_limit_s, b.settings.time_limit_s);
  EXPECT_EQ(a.settings.packets, b.settings.packets);
  EXPECT_EQ(a.settings.batch_packets, b.settings.batch_packets);
  EXPECT_EQ(a.settings.smallest_batch_count, b.settings.smallest_batch_count);
  EXPECT_EQ(a.settings.stop_share, b.settings.stop_share);
  EXPECT_EQ(a.settings.gather_small_zones, b.settings.gather_small_zones);
  EXPECT_EQ(a.settings.seed, b.settings.seed);
  EXPECT_EQ(a.settings.threads, b.settings.threads);
  EXPECT_EQ(a.record.stopped, b.record.stopped);
  EXPECT_EQ(a.record.packets, b.record.packets);
  EXPECT_EQ(a.record.rays, b.record.rays);
  EXPECT_EQ(a.record.seconds, b.record.seconds);
  EXPECT_EQ(a.record.error, b.record.error);
  EXPECT_EQ(a.record.error_95th_percentile, b.record.error_95th_percentile);
  EXPECT_EQ(a.record.unreached_zones, b.record.unreached_zones);
  EXPECT_EQ(a.record.gathered_zones, b.record.gathered_zones);
  EXPECT_EQ(a.record.unit_packets, b.record.unit_packets);
  EXPECT_EQ(a.record.cut_off, b.record.cut_off);
  EXPECT_EQ(a.record.discretisation, b.record.discretisation);
  ASSERT_EQ(a.record.gather_bias.has_value(), b.record.gather_bias.has_value());
  if (!a.record.gather_bias) return;
  EXPECT_EQ(a.record.gather_bias->rms, b.record.gather_bias->rms);
  EXPECT_EQ(a.record.gather_bias->bound, b.record.gather_bias->bound);
}

void expect_same_room(const Solution& a, const Solution& b) {
  EXPECT_EQ(a.bands, b.bands);
  EXPECT_EQ(a.surface_names, b.surface_names);
  EXPECT_EQ(a.surface_materials, b.surface_materials);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t m = 0; m < a.materials.size(); ++m) {
    EXPECT_EQ(a.materials[m].name, b.materials[m].name);
    EXPECT_TRUE((a.materials[m].reflectance == b.materials[m].reflectance).all());
    EXPECT_TRUE((a.materials[m].emitted_radiance == b.materials[m].emitted_radiance).all());
    EXPECT_EQ(a.materials[m].two_sided, b.materials[m].two_sided);
    EXPECT_EQ(a.materials[m].emits_both_sides, b.materials[m].emits_both_sides);
  }
  EXPECT_EQ(a.mesh.base().vertices, b.mesh.base().vertices);
  EXPECT_EQ(a.mesh.base().normals, b.mesh.base().normals);
  ASSERT_EQ(a.mesh.triangle_count(), b.mesh.triangle_count());
  for (std::size_t t = 0; t < a.mesh.triangle_count(); ++t) {
    const BaseTriangle& x = a.mesh.triangle(TriangleId(t));
    const BaseTriangle& y = b.mesh.triangle(TriangleId(t));
    EXPECT_EQ(std::tie(x.vertex, x.normal, x.surface, x.face, x.divisions, x.two_sided),
              std::tie(y.vertex, y.normal, y.surface, y.face, y.divisions, y.two_sided));
  }
  ASSERT_EQ(a.mesh_report.surfaces.size(), b.mesh_report.surfaces.size());
  for (std::size_t s = 0; s < a.mesh_report.surfaces.size(); ++s) {
    EXPECT_EQ(a.mesh_report.surfaces[s].input, b.mesh_report.surfaces[s].input);
    EXPECT_EQ(a.mesh_report.surfaces[s].meshed, b.mesh_report.surfaces[s].meshed);
    EXPECT_EQ(a.mesh_report.surfaces[s].removed, b.mesh_report.surfaces[s].removed);
  }
  EXPECT_EQ(a.mesh_report.degenerate_faces, b.mesh_report.degenerate_faces);
  EXPECT_EQ(a.mesh_report.duplicate_faces, b.mesh_report.duplicate_faces);
  EXPECT_EQ(a.mesh_report.overlapping_faces, b.mesh_report.overlapping_faces);
  EXPECT_EQ(a.mesh_report.flipped_faces, b.mesh_report.flipped_faces);
  EXPECT_EQ(a.mesh_report.nonplanar_faces, b.mesh_report.nonplanar_faces);
  EXPECT_EQ(a.mesh_report.cut_faces, b.mesh_report.cut_faces);
  EXPECT_EQ(a.mesh_report.warnings, b.mesh_report.warnings);
  EXPECT_EQ(a.light_warnings, b.light_warnings);
}

class SolutionFile : public testing::Test {
 protected:
  // Changes one thing in a saved file through the HDF5 library itself, and makes it look unchanged.
  void edit(const std::function<void(hid_t)>& change) {
    const hid_t id = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(id, 0);
    change(id);
    ASSERT_GE(H5Fclose(id), 0);
    const std::string bytes = read_bytes(file_);
    write_bytes(file_, bytes + seal_of(bytes));
  }
  static void overwrite(hid_t id, const char* dataset, hid_t type, const void* values) {
    const hid_t data = H5Dopen2(id, dataset, H5P_DEFAULT);
    ASSERT_GE(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0);
    H5Dclose(data);
  }

  TempFolder folder_;
  std::filesystem::path file_ = folder_ / "room.solution";
};

TEST_F(SolutionFile, KeepsEverythingForEveryKindOfBands) {
  for (const BandSet& bands : {BandSet::grey(), BandSet::rgb(), BandSet::spectral({450, 550.5, 610, 700})}) {
    const Solution saved = sample_solution(bands);
    save_solution(saved, file_);
    const Solution loaded = load_solution(file_);
    expect_same_settings(saved, loaded);
    expect_same_room(saved, loaded);
    expect_same_light(saved, loaded);
    expect_same_plan(saved.gather_plan, loaded.gather_plan);
  }
}

TEST_F(SolutionFile, KeepsUnsetZoneAreaEmptyRoomAndUnknownError) {
  Solution saved;
  saved.record.error = std::numeric_limits<double>::infinity();
  saved.audit.bands.resize(1);
  save_solution(saved, file_);
  const Solution loaded = load_solution(file_);
  EXPECT_FALSE(loaded.mesh_settings.zone_area.has_value());
  EXPECT_EQ(loaded.mesh.zone_count(), 0U);
  EXPECT_EQ(loaded.record.error, saved.record.error);
}

TEST_F(SolutionFile, WhoIsInAHurryGetsTheSameUnpacked) {
  Solution saved = sample_solution(BandSet::rgb());
  saved.light_warnings.assign(20'000, std::string(20, 'x'));  // texts are written last
  std::atomic<bool> hurry = false;
  const Packing packing(&hurry, std::chrono::seconds(0));
  save_solution(saved, file_, packing);
  const auto packed = std::filesystem::file_size(file_);
  save_solution(saved, file_);
  EXPECT_EQ(std::filesystem::file_size(file_), packed);
  hurry = true;
  save_solution(saved, file_, packing);
  EXPECT_GT(std::filesystem::file_size(file_), packed);
  const Solution loaded = load_solution(file_);
  expect_same_settings(saved, loaded);
  expect_same_room(saved, loaded);
  expect_same_light(saved, loaded);
}

// Books of ordinary runs fit into 63 bits and are stored as one number each.
TEST_F(SolutionFile, KeepsBooksOfVeryLongRuns) {
  Solution saved = sample_solution(BandSet::rgb());
  const auto has_high = [&](const char* name) {
    const Hdf5Id file(H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "cannot open it");
    const Hdf5Group root(Hdf5Id(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose, "no root group"), "/");
    return root.open_group("audit").has_dataset(name);
  };
  save_solution(saved, file_);
  EXPECT_FALSE(has_high("emitted_high"));
  BandAudit& band = saved.audit.bands[1];
  band.emitted = (RunQuanta{5} << 80) + 3;
  band.unshot = -(RunQuanta{1} << 70) - 9;
  band.absorbed[0] = (RunQuanta{1} << 63) - 1;  // the largest that fits
  save_solution(saved, file_);
  EXPECT_TRUE(has_high("emitted_high"));
  EXPECT_FALSE(has_high("absorbed_high"));
  expect_same_light(saved, load_solution(file_));
}

TEST_F(SolutionFile, KeepsDiffuseTransmittance) {
  Solution solution = sample_solution(BandSet::rgb());
  solution.materials[0].non_diffuse.diffuse_transmittance = Eigen::Array3d(0.2, 0.1, 0.05);
  save_solution(solution, file_);
  const Solution read = load_solution(file_);
  EXPECT_EQ(read.materials[0].diffuse_transmittance(1), 0.1);
  EXPECT_EQ(read.materials[1].diffuse_transmittance(1), 0);
  EXPECT_EQ(read.radiosity(ZoneId(0), 1).mean, solution.radiosity(ZoneId(0), 1).mean);
}

TEST_F(SolutionFile, SavingTwiceGivesTheSameBytes) {
  const Solution solution = sample_solution(BandSet::rgb());
  save_solution(solution, file_);
  save_solution(solution, folder_ / "again");
  EXPECT_EQ(read_bytes(file_), read_bytes(folder_ / "again"));
}

TEST_F(SolutionFile, HoldsNoTimes) {
  save_solution(sample_solution(BandSet::rgb()), file_);
  const hid_t id = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(id, 0);
  const auto look = [](hid_t /*root*/, const char* name, const H5O_info_t* info, void* count) -> herr_t {
    EXPECT_TRUE(info->atime == 0 && info->mtime == 0 && info->ctime == 0 && info->btime == 0) << name;
    ++*static_cast<int*>(count);
    return 0;
  };
  int objects = 0;
  EXPECT_GE(H5Ovisit2(id, H5_INDEX_NAME, H5_ITER_NATIVE, look, &objects, H5O_INFO_TIME), 0);
  EXPECT_GT(objects, 60);
  H5Fclose(id);
}

TEST_F(SolutionFile, HoldsZoneValuesWithUnits) {
  const Solution solution = sample_solution(BandSet::rgb());
  save_solution(solution, file_);
  const hid_t id = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(id, 0);
  const std::size_t zones = solution.mesh.zone_count();
  const auto read = [&](const char* name) {
    std::vector<float> values(3 * zones);
    const hid_t data = H5Dopen2(id, name, H5P_DEFAULT);
    EXPECT_GE(H5Dread(data, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Dclose(data);
    return values;
  };
  const auto radiosity = read("/zones/radiosity");
  const auto emitted = read("/zones/emitted");
  const auto direct = read("/zones/direct");
  const auto indirect = read("/zones/indirect");
  const auto caustic = read("/zones/caustic");
  const auto error = read("/zones/radiosity_stderr");
  for (std::size_t z = 0; z < zones; ++z)
    for (std::size_t b = 0; b < 3; ++b) {
      const std::size_t i = 3 * z + b;
      EXPECT_FLOAT_EQ(radiosity[i], static_cast<float>(solution.radiosity(ZoneId(z), b).mean));
      EXPECT_FLOAT_EQ(radiosity[i], emitted[i] + direct[i] + indirect[i] + caustic[i]);
      EXPECT_FLOAT_EQ(error[i], static_cast<float>(solution.radiosity(ZoneId(z), b).stderr_of_mean));
    }
  const hid_t unit = H5Aopen_by_name(id, "/zones/radiosity", "unit", H5P_DEFAULT, H5P_DEFAULT);
  char text[16] = {};
  const hid_t type = H5Aget_type(unit);
  ASSERT_LT(H5Tget_size(type), sizeof text);
  H5Aread(unit, type, text);
  EXPECT_STREQ(text, "W/m2");
  H5Tclose(type);
  H5Aclose(unit);
  H5Fclose(id);
}

TEST_F(SolutionFile, RefusesOtherFiles) {
  EXPECT_THAT([&] { load_solution(file_); }, ThrowsMessage<InputError>(HasSubstr("no such file")));
  EXPECT_THAT([&] { load_solution(folder_.path()); }, ThrowsMessage<InputError>(HasSubstr("it is a folder")));
  write_bytes(file_, "");
  EXPECT_THAT([&] { load_solution(file_); }, ThrowsMessage<InputError>(HasSubstr("the file is empty")));
  write_bytes(file_, std::string(5000, 'x'));
  EXPECT_THAT([&] { load_solution(file_); }, ThrowsMessage<InputError>(HasSubstr("no HDF5")));
  EXPECT_FALSE(is_solution_file(file_));
  EXPECT_FALSE(is_solution_file(folder_.path()));
  H5Fclose(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_THAT([&] { load_solution(file_); },
              ThrowsMessage<InputError>(HasSubstr("not a complete reemit solution")));
  EXPECT_TRUE(is_solution_file(file_));
}

TEST_F(SolutionFile, RefusesOtherVersions) {
  save_solution(sample_solution(BandSet::grey()), file_);
  edit([](hid_t id) {
    const std::uint32_t version = 99;
    const hid_t attribute = H5Aopen(id, "format_version", H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_UINT32, &version);
    H5Aclose(attribute);
  });
  EXPECT_THAT([&] { load_solution(file_); }, ThrowsMessage<InputError>(HasSubstr("Use a newer reemit")));
}

TEST_F(SolutionFile, RefusesIndicesOutOfRangeAndAbsurdCounts) {
  Solution solution = sample_solution(BandSet::rgb());
  // Of a run so long that its books have high parts.
  BandAudit& books = solution.audit.bands[0];
  books.emitted = books.absorbed[0] = books.absorbed_on_backs[0] = books.escaped[0] = RunQuanta{1} << 70;
  const std::uint32_t bad_index[] = {77, 77, 77, 77, 77, 77};
  const std::uint32_t bad_divisions[] = {50000, 50000};
  const std::uint32_t zero_divisions[] = {0, 3};
  const std::uint64_t bad_sizes[] = {2, 1};
  const std::uint8_t bad_marks[64] = {2};
  const double not_a_number[64] = {std::numeric_limits<double>::quiet_NaN()};
  std::int64_t most_quanta[64];
  std::ranges::fill(most_quanta, std::numeric_limits<std::int64_t>::max());
  const struct {
    const char* dataset;
    hid_t type;
    const void* values;
  } cases[] = {{"/mesh/triangles", H5T_NATIVE_UINT32, bad_index},
               {"/mesh/triangle_normals", H5T_NATIVE_UINT32, bad_index},
               {"/mesh/triangle_surface", H5T_NATIVE_UINT32, bad_index},
               {"/mesh/triangle_divisions", H5T_NATIVE_UINT32, bad_divisions},
               {"/mesh/triangle_divisions", H5T_NATIVE_UINT32, zero_divisions},
               {"/mesh/vertices", H5T_NATIVE_DOUBLE, not_a_number},
               {"/surfaces/material", H5T_NATIVE_UINT32, bad_index},
               {"/materials/reflectance", H5T_NATIVE_DOUBLE, not_a_number},
               {"/sums/direct", H5T_NATIVE_DOUBLE, not_a_number},
               {"/gather_plan/uneven", H5T_NATIVE_UINT8, bad_marks},
               {"/gather_plan/caustic_part_bytes", H5T_NATIVE_UINT64, bad_sizes},
               {"/audit/watts_per_quantum", H5T_NATIVE_DOUBLE, not_a_number},
               {"/audit/emitted_high", H5T_NATIVE_INT64, most_quanta},
               {"/audit/absorbed_high", H5T_NATIVE_INT64, most_quanta},
               {"/audit/absorbed_on_backs_high", H5T_NATIVE_INT64, most_quanta},
               {"/audit/escaped_high", H5T_NATIVE_INT64, most_quanta}};
  for (const auto& c : cases) {
    save_solution(solution, file_);
    edit([&](hid_t id) { overwrite(id, c.dataset, c.type, c.values); });
    EXPECT_THAT([&] { load_solution(file_); }, ThrowsMessage<InputError>(HasSubstr("is damaged")))
        << c.dataset;
  }
}

TEST_F(SolutionFile, RefusesADatasetThatClaimsMoreThanTheFileHolds) {
  save_solution(sample_solution(BandSet::grey()), file_);
  edit([](hid_t id) {
    H5Ldelete(id, "/mesh/vertices", H5P_DEFAULT);
    const hsize_t dims[2] = {hsize_t{1} << 40, 3};
    const hsize_t chunk[2] = {1024, 3};
    const hid_t space = H5Screate_simple(2, dims, nullptr);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, 2, chunk);
    H5Dclose(H5Dcreate2(id, "/mesh/vertices", H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
    H5Pclose(properties);
    H5Sclose(space);
  });
  EXPECT_THAT([&] { load_solution(file_); }, ThrowsMessage<InputError>(HasSubstr("claims more values")));
}

TEST_F(SolutionFile, RefusesEveryTruncatedFile) {
  save_solution(sample_solution(BandSet::rgb()), file_);
  const std::string bytes = read_bytes(file_);
  for (std::size_t parts = 0; parts < 200; ++parts) {
    write_bytes(file_, std::string_view(bytes).substr(0, bytes.size() * parts / 200));
    EXPECT_THROW(load_solution(file_), InputError) << parts;
  }
  write_bytes(file_, std::string_view(bytes).substr(0, bytes.size() - 1));
  EXPECT_THROW(load_solution(file_), InputError);
}

TEST_F(SolutionFile, RefusesASolutionThatDoesNotSayWhereDirectLightIsFrom) {
  Solution saved = sample_solution(BandSet::grey());
  saved.settings.direct = DirectSource::kBest;
  save_solution(saved, file_);
  EXPECT_EQ(load_solution(file_).settings.direct, DirectSource::kBest);
  edit([](hid_t id) { H5Adelete_by_name(id, "settings/solve", "direct", H5P_DEFAULT); });
  EXPECT_THAT([&] { load_solution(file_); }, ThrowsMessage<InputError>(HasSubstr("damaged or incomplete")));
}

TEST_F(SolutionFile, RefusesOtherHdf5FilesWithASeal) {
  save_solution(sample_solution(BandSet::grey()), file_);
  edit([](hid_t id) { H5Adelete(id, "format"); });
  EXPECT_THAT([&] { load_solution(file_); }, ThrowsMessage<InputError>(HasSubstr("no reemit solution")));
}

TEST_F(SolutionFile, FindsEveryDamagedBit) {
  save_solution(sample_solution(BandSet::rgb()), file_);
  const std::string bytes = read_bytes(file_);
  constexpr std::size_t kTrials = 700;
  for (std::size_t trial = 0; trial < kTrials; ++trial) {
    std::string damaged = bytes;
    const std::size_t at = bytes.size() * trial / kTrials;
    damaged[at] = static_cast<char>(damaged[at] ^ static_cast<char>(1U << (trial % 8)));
    write_bytes(file_, damaged);
    EXPECT_THROW(load_solution(file_), InputError) << at;
  }
}

TEST_F(SolutionFile, FullDiskKeepsThePreviousFile) {
  const Solution solution = sample_solution(BandSet::grey());
  save_solution(solution, file_);
  const std::string before = read_bytes(file_);
  for (const std::size_t limit : {std::size_t{0}, std::size_t{2048}, before.size() / 2, before.size() - 1}) {
    const SmallDisk disk(limit);
    EXPECT_THROW(save_solution(solution, file_), ResourceError) << limit;
    EXPECT_EQ(folder_.listing().size(), 1U);
  }
  EXPECT_EQ(read_bytes(file_), before);
  save_solution(solution, file_);
  EXPECT_EQ(read_bytes(file_), before);
}

TEST_F(SolutionFile, RefusesToSaveWhatDoesNotFitTogether) {
  Solution solution = sample_solution(BandSet::grey());
  solution.sums.direct.pop_back();
  EXPECT_THROW(save_solution(solution, file_), std::invalid_argument);
  solution = sample_solution(BandSet::grey());
  solution.surface_materials.clear();
  EXPECT_THROW(save_solution(solution, file_), std::invalid_argument);
  solution = sample_solution(BandSet::grey());
  solution.gather_plan.uneven.pop_back();
  EXPECT_THROW(save_solution(solution, file_), std::invalid_argument);
  EXPECT_EQ(folder_.listing().size(), 0U);
}

}  // namespace
}  // namespace reemit
