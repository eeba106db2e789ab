#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "scenes/io/common/text_file.h"
#include "scenes/model/error.h"
#include "solver/solution/audit_group.h"
#include "solver/solution/file_damage.h"
#include "solver/solution/file_seal.h"
#include "solver/solution/gather_plan_group.h"
#include "solver/solution/hdf5_columns.h"
#include "solver/solution/hdf5_group.h"
#include "solver/solution/shape_rows.h"
#include "solver/solution/solution_file.h"
#include "solver/solution/solution_layout.h"
#include "solver/solution/texture_group.h"

namespace reemit {
namespace {

template <class Enum>
Enum enum_from(const std::string& text, std::span<const Enum> values) {
  for (const Enum value : values)
    if (to_string(value) == text) return value;
  throw FileDamage("unknown word '" + text + "'");
}

// The reading side of solution_layout.h.
struct AttributeReader {
  const Hdf5Group& group;

  void attribute(const char* name, bool& value) { value = group.read_attribute<std::uint8_t>(name) != 0; }
  void attribute(const char* name, int& value) { value = group.read_attribute<std::int32_t>(name); }
  void attribute(const char* name, std::uint64_t& value) {
    value = group.read_attribute<std::uint64_t>(name);
  }
  void attribute(const char* name, double& value) { value = group.read_attribute<double>(name); }
  void attribute(const char* name, std::optional<double>& value) {
    if (group.has_attribute(name)) value = group.read_attribute<double>(name);
  }
  /// Empty where there is none.
  void attribute(const char* name, std::string& value) {
    if (group.has_attribute(name)) value = group.read_text_attribute(name);
  }
  void attribute(const char* name, std::optional<ZoneBias>& value) {
    if (group.has_attribute(name))
      value = ZoneBias{group.read_attribute<double>(name),
                       group.read_attribute<double>(std::string(name) + "_bound")};
  }
  void attribute(const char* name, EmissiveUnits& value) {
    parse<EmissiveUnits>(name, value, kAllEmissiveUnits);
  }
  void attribute(const char* name, SolveMethod& value) { parse<SolveMethod>(name, value, kAllSolveMethods); }
  void attribute(const char* name, SamplingKind& value) {
    parse<SamplingKind>(name, value, kAllSamplingKinds);
  }
  void attribute(const char* name, Reemission& value) { parse<Reemission>(name, value, kAllReemissions); }
  void attribute(const char* name, DirectSource& value) {
    parse<DirectSource>(name, value, kAllDirectSources);
  }
  void attribute(const char* name, StopReason& value) { parse<StopReason>(name, value, kAllStopReasons); }

 private:
  template <class Enum>
  void parse(const char* name, Enum& value, std::span<const Enum> values) {
    value = enum_from(group.read_text_attribute(name), values);
  }
};

void read_settings(const Hdf5Group& root, Solution& solution) {
  const Hdf5Group settings = root.open_group("settings");
  const Hdf5Group read = settings.open_group("read");
  const Hdf5Group mesh = settings.open_group("mesh");
  const Hdf5Group solve = settings.open_group("solve");
  const Hdf5Group record = root.open_group("record");
  AttributeReader from_read{read};
  AttributeReader from_mesh{mesh};
  AttributeReader from_solve{solve};
  AttributeReader from_record{record};
  transfer_read_options(from_read, solution.read_options);
  const SpectralBands& bands = solution.read_options.bands;
  require_intact(!bands.given() || bands.problem().empty(), "bands that no room can have");
  transfer_mesh_settings(from_mesh, solution.mesh_settings);
  transfer_solver_settings(from_solve, solution.settings);
  transfer_record(from_record, solution.record);
}

BandSet read_bands(const Hdf5Group& root) {
  const Hdf5Group group = root.open_group("bands");
  switch (enum_from<BandKind>(group.read_text_attribute("kind"), kAllBandKinds)) {
    case BandKind::kGrey:
      return BandSet::grey();
    case BandKind::kRgb:
      return BandSet::rgb();
    case BandKind::kSpectral:
      break;
  }
  const Hdf5Shape shape = group.shape("centre");
  require_intact(shape.size() == 1, "bad list of wavelengths");
  return BandSet::spectral(group.read<double>("centre", shape));
}

std::uint64_t rows_of(const Hdf5Group& group, const char* name) {
  return group.shape(name).at(0);
}

void read_materials(const Hdf5Group& root, Solution& solution) {
  const Hdf5Group group = root.open_group("materials");
  const std::vector<std::string> names = group.read_texts("name");
  const std::uint64_t bands = solution.bands.count();
  const std::uint64_t count = names.size();
  const auto reflectance = group.read<double>("reflectance", {count, bands});
  const auto emitted = group.read<double>("emitted_radiance", {count, bands});
  const auto exponent = group.read<double>("emission_exponent", {count});
  const auto back = group.has_dataset("back_reflectance")
                        ? group.read<double>("back_reflectance", {count, bands})
                        : reflectance;
  const bool any_translucent = group.has_dataset("diffuse_transmittance");
  const auto through = any_translucent ? group.read<double>("diffuse_transmittance", {count, bands})
                                       : std::vector<double>(count * bands, 0.0);
  const auto two_sided = group.read<std::uint8_t>("two_sided", {count});
  const auto emits_both_sides = group.read<std::uint8_t>("emits_both_sides", {count});
  const auto in_range = [](double low, double high) {
    return [low, high](double x) { return x >= low && x <= high; };
  };
  require_intact(std::all_of(reflectance.begin(), reflectance.end(), in_range(0, 1)),
                 "reflectance outside [0,1]");
  require_intact(std::all_of(back.begin(), back.end(), in_range(0, 1)),
                 "reflectance of a back outside [0,1]");
  require_intact(std::all_of(through.begin(), through.end(), in_range(0, 1)),
                 "diffuse transmittance outside [0,1]");
  require_intact(std::all_of(emitted.begin(), emitted.end(), in_range(0, std::numeric_limits<double>::max())),
                 "negative or infinite emission");
  require_intact(std::all_of(exponent.begin(), exponent.end(), in_range(0, 1e4)),
                 "emission exponent out of range");
  const auto size = static_cast<Eigen::Index>(bands);
  for (std::size_t m = 0; m < count; ++m) {
    Material material;
    material.name = names[m];
    material.reflectance = Spectrum::Map(reflectance.data() + m * bands, size);
    const auto of_back = Spectrum::Map(back.data() + m * bands, size);
    if ((of_back != material.reflectance).any()) material.back_reflectance = of_back;
    material.emitted_radiance = Spectrum::Map(emitted.data() + m * bands, size);
    material.emission_exponent = exponent[m];
    const auto row = Spectrum::Map(through.data() + m * bands, size);
    if ((row > 0).any()) material.non_diffuse.diffuse_transmittance = row;
    material.two_sided = two_sided[m] != 0;
    material.emits_both_sides = emits_both_sides[m] != 0;
    solution.materials.push_back(std::move(material));
  }
}

void read_surfaces(const Hdf5Group& root, Solution& solution) {
  const Hdf5Group group = root.open_group("surfaces");
  solution.surface_names = group.read_texts("name");
  const std::uint64_t count = solution.surface_names.size();
  for (const std::uint32_t material : group.read<std::uint32_t>("material", {count})) {
    require_intact(material < solution.materials.size(), "surface with a material out of range");
    solution.surface_materials.emplace_back(material);
  }
  const auto input = group.read<double>("area_input", {count});
  const auto meshed = group.read<double>("area_meshed", {count});
  const auto removed = group.read<double>("area_removed", {count});
  for (std::size_t s = 0; s < count; ++s)
    solution.mesh_report.surfaces.push_back({input[s], meshed[s], removed[s]});
}

std::vector<Vec3> read_vectors(const Hdf5Group& group, const char* name) {
  const std::uint64_t count = rows_of(group, name);
  const auto flat = group.read<double>(name, {count, 3});
  require_intact(all_finite(flat), std::string(name) + " that are not finite");
  std::vector<Vec3> vectors;
  vectors.reserve(count);
  for (std::size_t i = 0; i < flat.size(); i += 3) vectors.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  return vectors;
}

ZoneGroups read_groups(const Hdf5Group& mesh, std::uint64_t triangles) {
  ZoneGroups groups;
  const std::uint64_t rows = rows_of(mesh, "side_group");
  require_intact(rows == 0 || rows == 2 * triangles, "groups of another number of sides");
  groups.of_side = mesh.read<std::uint32_t>("side_group", {rows});
  for (const std::uint32_t g : groups.of_side) {
    if (g == ZoneGroups::kOwn) continue;
    require_intact(g < rows, "side with a group out of range");
    groups.count = std::max(groups.count, g + 1);
  }
  groups.sealed = mesh.read_attribute<std::uint32_t>("sealed_groups");
  return groups;
}

CellSplits read_splits(const Hdf5Group& mesh) {
  CellSplits splits;
  for (const std::uint32_t s : mesh.read<std::uint32_t>("split_sides", {rows_of(mesh, "split_sides")}))
    splits.sides.emplace_back(s);
  splits.cuts = mesh.read<std::uint8_t>("cell_cuts", {rows_of(mesh, "cell_cuts")});
  for (std::size_t i = 1; i < splits.sides.size(); ++i)
    require_intact(splits.sides[i - 1] < splits.sides[i], "sides with split cells out of order");
  return splits;
}

std::vector<SurfaceFace> read_backs(const Hdf5Group& mesh, const Solution& solution,
                                    const std::vector<BaseTriangle>& triangles) {
  std::vector<SurfaceFace> backs;
  if (!mesh.has_dataset("triangle_back_surface")) return backs;
  const std::uint64_t count = triangles.size();
  const auto surface = mesh.read<std::uint32_t>("triangle_back_surface", {count});
  const auto face = mesh.read<std::uint32_t>("triangle_back_face", {count});
  for (std::size_t t = 0; t < count; ++t) {
    const SurfaceId shown(surface[t]);
    require_intact(!shown.valid() || (shown.index() < solution.surface_names.size() &&
                                      triangles[t].two_sided && !triangles[t].is_curved()),
                   "back with a surface out of range, or that has no zones");
    backs.push_back({shown, face[t]});
  }
  return backs;
}

// `zone_count` comes from the size of the sums, which were compared with the size of the file: a damaged
// number of divisions must not make us allocate zones that are not there.
ZoneMesh read_mesh(const Hdf5Group& root, Solution& solution, std::uint64_t zone_count) {
  const Hdf5Group group = root.open_group("mesh");
  BaseMesh base;
  base.vertices = read_vectors(group, "vertices");
  base.normals = read_vectors(group, "normals");
  const std::uint64_t count = rows_of(group, "triangles");
  const auto vertex = group.read<std::uint32_t>("triangles", {count, 3});
  const auto normal = group.read<std::uint32_t>("triangle_normals", {count, 3});
  const auto surface = group.read<std::uint32_t>("triangle_surface", {count});
  const auto face = group.read<std::uint32_t>("triangle_face", {count});
  const auto divisions = group.read<std::uint32_t>("triangle_divisions", {count});
  const auto two_sided = group.read<std::uint8_t>("triangle_two_sided", {count});
  const auto shape = group.read<std::uint32_t>("triangle_shape", {count});
  const std::uint64_t shapes = rows_of(group, "shapes");
  const auto rows = group.read<double>("shapes", {shapes, kShapeRow});
  require_intact(all_finite(rows), "shapes that are not finite");
  for (std::size_t s = 0; s < shapes; ++s) base.shapes.push_back(shape_of(&rows[s * kShapeRow]));
  ZoneGroups groups = read_groups(group, count);
  CellSplits splits = read_splits(group);
  const auto counts_cells = [&](SideId side) {
    return (groups.of_side.empty() || groups.of_side[side.index()] == ZoneGroups::kOwn) &&
           !std::binary_search(splits.sides.begin(), splits.sides.end(), side);
  };
  std::uint64_t zones = groups.count + static_cast<std::uint64_t>(std::count(
                                           splits.cuts.begin(), splits.cuts.end(), CellSplits::kNotCut));
  for (std::size_t t = 0; t < count; ++t) {
    require_intact(surface[t] < solution.surface_names.size(), "triangle with a surface out of range");
    require_intact(divisions[t] > 0 && divisions[t] < 65536, "triangle with an impossible number of zones");
    const bool front_counts = counts_cells(side_of(TriangleId(t), true));
    const bool back_counts = two_sided[t] != 0 && counts_cells(side_of(TriangleId(t), false));
    zones +=
        std::uint64_t{divisions[t]} * divisions[t] * ((front_counts ? 1U : 0U) + (back_counts ? 1U : 0U));
    require_intact(zones <= zone_count, "more zones in the mesh than in the sums");
    BaseTriangle triangle;
    std::copy_n(vertex.begin() + static_cast<std::ptrdiff_t>(3 * t), 3, triangle.vertex.begin());
    std::copy_n(normal.begin() + static_cast<std::ptrdiff_t>(3 * t), 3, triangle.normal.begin());
    triangle.surface = SurfaceId(surface[t]);
    triangle.face = face[t];
    triangle.divisions = divisions[t];
    triangle.two_sided = two_sided[t] != 0;
    triangle.shape = shape[t];
    if (t > 0 && shape[t] == shape[t - 1] && triangle.is_curved())
      triangle.patch = base.triangles.back().patch + 1;
    base.triangles.push_back(triangle);
  }
  require_intact(zones == zone_count, "fewer zones in the mesh than in the sums");
  base.backs = read_backs(group, solution, base.triangles);
  AttributeReader counts{group};
  transfer_mesh_counts(counts, solution.mesh_report);
  solution.mesh_report.warnings = group.read_texts("warnings");
  return ZoneMesh(std::move(base), std::move(groups), std::move(splits));
}

/// No sum of sixteen of these overflows.
constexpr std::int64_t kMostGroupWeight = std::int64_t{1} << 53;

ZoneSums read_sums(const Hdf5Group& root, const Channels& channels) {
  const Hdf5Group group = root.open_group("sums");
  ZoneSums sums;
  sums.channels = channels;
  sums.batches = group.read_attribute<std::int64_t>("batches");
  require_intact(sums.batches >= 0, "a negative number of batches");
  sums.weight_squared = group.read_attribute<double>("weight_squared");
  const auto weights = group.read<std::int64_t>("group_weight", {ZoneSums::kGroups});
  std::copy(weights.begin(), weights.end(), sums.group_weight.begin());
  for (std::size_t g = 0; g < ZoneSums::kGroups; ++g)
    require_intact(weights[g] > 0
                       ? static_cast<std::int64_t>(g) < sums.batches && weights[g] <= kMostGroupWeight
                       : weights[g] == 0 && static_cast<std::int64_t>(g) >= sums.batches,
                   "weights of batch groups that do not go with the number of batches");
  const auto weight = static_cast<double>(sums.weight());
  require_intact(sums.weight_squared >= weight && (sums.batches < 2 || sums.weight_squared < weight * weight),
                 "squares of weights that do not go with the weights");
  const Hdf5Shape shape{rows_of(group, "direct"), channels.count()};
  std::vector<std::pair<const char*, std::vector<double>*>> columns{
      {"direct", &sums.direct},
      {"direct_cross", &sums.direct_cross},
      {"direct_squared", &sums.direct_squared},
      {"indirect", &sums.indirect},
      {"indirect_cross", &sums.indirect_cross},
      {"indirect_squared", &sums.indirect_squared},
      {"total_squared", &sums.total_squared}};
  if (group.has_dataset("caustic"))
    columns.insert(columns.end(), {{"caustic", &sums.caustic},
                                   {"caustic_cross", &sums.caustic_cross},
                                   {"caustic_squared", &sums.caustic_squared}});
  for (const auto& [name, values] : columns) {
    *values = group.read<double>(name, shape);
    require_intact(all_finite(*values), std::string("/sums/") + name + " holds a number that is not finite");
  }
  sums.group_total = group.read<float>("group_total", {ZoneSums::kGroups, shape[0], channels.count()});
  require_intact(all_finite(sums.group_total), "/sums/group_total holds a number that is not finite");
  return sums;
}

GatheredZones read_gathered(const Hdf5Group& root, const Solution& solution) {
  const Hdf5Group group = root.open_group("gathered");
  const std::uint64_t channels = solution.sums.channels.count();
  const std::uint64_t count = rows_of(group, "zone");
  GatheredZones gathered;
  gathered.rays = group.read_attribute<std::uint64_t>("rays");
  require_intact(gathered.rays <= solution.record.rays, "more gathered rays than rays");
  for (const std::uint32_t zone : group.read<std::uint32_t>("zone", {count})) {
    require_intact(zone < solution.mesh.zone_count(), "gathered zones out of range");
    gathered.zones.emplace_back(zone);
  }
  gathered.sums = group.read<double>("sums", {count, channels, solution.sums.columns().size()});
  gathered.group_total = group.read<float>("group_total", {ZoneSums::kGroups, count, channels});
  require_intact(all_finite(gathered.sums) && all_finite(gathered.group_total),
                 "/gathered holds a number that is not finite");
  return gathered;
}

Solution read_all(const Hdf5Group& root) {
  Solution solution;
  solution.program_version = root.read_text_attribute("program_version");
  solution.room_path = root.read_text_attribute("room_path");
  for (std::size_t i = 0; root.has_attribute(room_path_attribute(i)); ++i)
    solution.more_room_paths.push_back(root.read_text_attribute(room_path_attribute(i)));
  solution.room_hash = root.read_text_attribute("room_hash");
  read_settings(root, solution);
  solution.bands = read_bands(root);
  read_materials(root, solution);
  read_surfaces(root, solution);
  const Channels channels(solution.bands.count());
  solution.sums = read_sums(root, channels);
  solution.mesh = read_mesh(root, solution, solution.sums.direct.size() / channels.count());
  read_textures(root, solution);
  solution.gathered = read_gathered(root, solution);
  read_gather_plan(root, solution);
  read_audit(root, solution);
  return solution;
}

void check_format(const Hdf5Group& root, const std::string& file) {
  const char* advice = "Give the file that `reemit solve -o` wrote.";
  if (!root.has_attribute("format"))
    throw InputError(file, "is an HDF5 file, but no reemit solution", advice);
  const std::string format = root.read_text_attribute("format");
  if (format != kSolutionFormat)
    throw InputError(file, "holds '" + format + "', not a reemit solution", advice);
  const auto version = root.read_attribute<std::uint32_t>("format_version");
  if (version != kSolutionFormatVersion)
    throw InputError(file,
                     "is a solution of format version " + std::to_string(version) +
                         "; this program reads version " + std::to_string(kSolutionFormatVersion),
                     version > kSolutionFormatVersion ? "Use a newer reemit." : "Solve the room again.");
}

}  // namespace

bool is_solution_file(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code)) return false;
  const Hdf5Quiet quiet;
  return H5Fis_hdf5(file.c_str()) > 0;
}

Solution load_solution(const std::filesystem::path& file) {
  const std::string name = file.string();
  check_readable_file(file, std::numeric_limits<std::uintmax_t>::max());
  const Hdf5Quiet quiet;
  const char* damaged = "Restore a copy of the file or solve the room again.";
  try {
    const htri_t is_hdf5 = H5Fis_hdf5(file.c_str());
    if (is_hdf5 < 0) throw InputError(name, "cannot be read", "Check its permissions.");
    if (is_hdf5 == 0)
      throw InputError(name, "is not a solution file (no HDF5)",
                       "Give the file that `reemit solve -o` wrote.");
    const Seal seal = check_seal(file);
    if (seal == Seal::kMissing)
      throw InputError(
          name, "is an HDF5 file, but not a complete reemit solution",
          "Give the file that `reemit solve -o` wrote. If it is that, it was cut off or changed since: "
          "restore a copy or solve the room again.");
    if (seal == Seal::kBroken)
      throw InputError(name, "is damaged or was changed by another program: its checksum is wrong", damaged);
    const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "cannot make file properties");
    check_hdf5(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), "cannot set file properties");
    const Hdf5Id id(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose, "cannot open it");
    const Hdf5Group root(Hdf5Id(H5Gopen2(id.get(), "/", H5P_DEFAULT), H5Gclose, "no root group"), "/");
    check_format(root, name);
    return read_all(root);
  } catch (const Hdf5Error& error) {
    throw InputError(name, std::string("is damaged or incomplete: ") + error.what(), damaged);
  } catch (const FileDamage& error) {
    throw InputError(name, std::string("is damaged: ") + error.what(), damaged);
  } catch (const std::invalid_argument& error) {  // from the checks of the mesh and the bands
    throw InputError(name, std::string("is damaged: ") + error.what(), damaged);
  } catch (const std::bad_alloc&) {
    throw ResourceError(name, "does not fit into memory",
                        "Close other programs or use a machine with more memory.");
  }
}

}  // namespace reemit
