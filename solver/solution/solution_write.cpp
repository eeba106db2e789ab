#include <algorithm>
#include <functional>
#include <new>
#include <stdexcept>

#include <tbb/task_arena.h>

#include "scenes/io/common/output_file.h"
#include "scenes/model/error.h"
#include "solver/solution/audit_group.h"
#include "solver/solution/file_seal.h"
#include "solver/solution/gather_plan_group.h"
#include "solver/solution/hdf5_columns.h"
#include "solver/solution/hdf5_group.h"
#include "solver/solution/hdf5_memory_file.h"
#include "solver/solution/shape_rows.h"
#include "solver/solution/solution_file.h"
#include "solver/solution/solution_layout.h"
#include "solver/solution/texture_group.h"
#include "solver/solution/thread_count.h"

namespace reemit {
namespace {

// The writing side of solution_layout.h.
struct AttributeWriter {
  const Hdf5Group& group;

  void attribute(const char* name, bool value) {
    group.write_attribute(name, static_cast<std::uint8_t>(value));
  }
  void attribute(const char* name, int value) { group.write_attribute(name, std::int32_t{value}); }
  void attribute(const char* name, std::uint64_t value) { group.write_attribute(name, value); }
  void attribute(const char* name, double value) { group.write_attribute(name, value); }
  void attribute(const char* name, const std::optional<double>& value) {
    if (value) group.write_attribute(name, *value);
  }
  void attribute(const char* name, const std::string& value) {
    if (!value.empty()) group.write_attribute(name, value);
  }
  void attribute(const char* name, const std::optional<ZoneBias>& value) {
    if (!value) return;
    group.write_attribute(name, value->rms);
    group.write_attribute(std::string(name) + "_bound", value->bound);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void attribute(const char* name, Enum value) { group.write_attribute(name, to_string(value)); }
};

void check_consistent(const Solution& solution) {
  const auto require = [](bool condition, const char* problem) {
    if (!condition) throw std::invalid_argument(std::string("solution: ") + problem);
  };
  const std::size_t bands = solution.bands.count();
  const std::size_t surfaces = solution.surface_names.size();
  require(solution.surface_materials.size() == surfaces,
          "surfaces without materials; keep_surfaces was not called");
  for (const MaterialId m : solution.surface_materials)
    require(m.index() < solution.materials.size(), "surface with a material out of range");
  for (const Material& m : solution.materials)
    require(static_cast<std::size_t>(m.reflectance.size()) == bands &&
                static_cast<std::size_t>(m.emitted_radiance.size()) == bands,
            "material with another number of bands");
  for (const BaseTriangle& t : solution.mesh.base().triangles)
    require(t.surface.index() < surfaces, "triangle with a surface out of range");
  for (const SurfaceFace& back : solution.mesh.base().backs)
    require(!back.surface.valid() || back.surface.index() < surfaces, "back with a surface out of range");
  require(solution.mesh_report.surfaces.size() == surfaces,
          "one row of the mesh report per surface expected");
  const std::size_t means_of_textures =
      solution.zone_reflectances.empty() ? 0 : solution.mesh.zone_count() * bands;
  for (const std::vector<double>* means : {&solution.zone_reflectances, &solution.zone_exitances})
    require(means->size() == means_of_textures, "one mean of textures per zone and band expected");
  const ZoneSums& sums = solution.sums;
  const std::size_t channels = sums.channels.count();
  require(sums.channels.bands() == bands, "sums of another number of bands");
  require(sums.channels.groups() == 1, "sums of several light groups, which the file does not tell apart");
  for (const std::vector<double>* values : sums.columns())
    require(values->size() == solution.mesh.zone_count() * channels, "one sum per zone and channel expected");
  require(sums.group_total.size() == ZoneSums::kGroups * solution.mesh.zone_count() * channels,
          "one sum per group, zone and channel expected");
  const std::size_t gathered = solution.gathered.zones.size() * channels;
  require(solution.gathered.sums.size() == gathered * sums.columns().size() &&
              solution.gathered.group_total.size() == gathered * ZoneSums::kGroups,
          "one row per gathered zone expected");
  require(
      solution.gather_plan.uneven.empty() || solution.gather_plan.uneven.size() == solution.mesh.zone_count(),
      "one mark per zone expected in the plan of gathers");
  require(solution.audit.bands.size() == channels, "one audit per channel expected");
  for (const BandAudit& audit : solution.audit.bands)
    require(audit.absorbed.size() == surfaces && audit.absorbed_on_backs.size() == surfaces,
            "one absorbed power per surface expected");
}

template <class T>
void put(const Hdf5Group& group, const char* name, const std::vector<T>& values, std::size_t columns,
         const char* unit, const char* description) {
  Hdf5Shape shape{values.size() / columns};
  if (columns > 1) shape.push_back(columns);
  group.write<T>(name, values, shape, unit, description);
}

// Rows of bands or channels keep their second dimension when there is only one.
template <class T>
void put_rows(const Hdf5Group& group, const char* name, const std::vector<T>& values, std::size_t columns,
              const char* unit, const char* description) {
  group.write<T>(name, values, {values.size() / columns, columns}, unit, description);
}

void write_settings(const Hdf5Group& root, const Solution& solution) {
  const Hdf5Group settings = root.create_group("settings");
  const Hdf5Group read = settings.create_group("read");
  const Hdf5Group mesh = settings.create_group("mesh");
  const Hdf5Group solve = settings.create_group("solve");
  const Hdf5Group record = root.create_group("record");
  AttributeWriter to_read{read};
  AttributeWriter to_mesh{mesh};
  AttributeWriter to_solve{solve};
  AttributeWriter to_record{record};
  transfer_read_options(to_read, solution.read_options);
  transfer_mesh_settings(to_mesh, solution.mesh_settings);
  transfer_solver_settings(to_solve, solution.settings);
  transfer_record(to_record, solution.record);
}

void write_bands(const Hdf5Group& root, const BandSet& bands) {
  const Hdf5Group group = root.create_group("bands");
  group.write_attribute("kind", to_string(bands.kind()));
  group.write_attribute("luminance", bands.efficacy_statement());
  group.write("name", bands.names(), "name of each band");
  if (bands.kind() == BandKind::kSpectral)
    put(group, "centre", bands.centres_nm(), 1, "nm", "wavelength at the centre of each band");
  const Spectrum& efficacy = bands.efficacy_lm_per_w();
  put(group, "efficacy", std::vector<double>(efficacy.begin(), efficacy.end()), 1, "lm/W",
      "luminous efficacy of each band");
}

void write_surfaces(const Hdf5Group& root, const Solution& solution) {
  const Hdf5Group surfaces = root.create_group("surfaces");
  surfaces.write("name", solution.surface_names, "name of each surface of the room");
  put(surfaces, "material",
      column<std::uint32_t>(solution.surface_materials, [](MaterialId m) { return m.index(); }), 1, "",
      "row of /materials");
  const std::vector<SurfaceAreas>& areas = solution.mesh_report.surfaces;
  put(surfaces, "area_input", column<double>(areas, std::mem_fn(&SurfaceAreas::input)), 1, "m2",
      "area as read, one side");
  put(surfaces, "area_meshed", column<double>(areas, std::mem_fn(&SurfaceAreas::meshed)), 1, "m2",
      "area of the base triangles, one side");
  put(surfaces, "area_removed", column<double>(areas, std::mem_fn(&SurfaceAreas::removed)), 1, "m2",
      "area of duplicates and of parts covered by a coplanar face");

  const Hdf5Group materials = root.create_group("materials");
  const std::size_t bands = solution.bands.count();
  materials.write("name", column<std::string>(solution.materials, std::mem_fn(&Material::name)),
                  "name of each material");
  put_rows(materials, "reflectance",
           flattened<double>(solution.materials,
                             [](const Material& m) -> const Spectrum& { return m.reflectance; }),
           bands, "1", "diffuse reflectance");
  if (std::any_of(solution.materials.begin(), solution.materials.end(),
                  [](const Material& m) { return m.back_reflectance.size() > 0; }))
    put_rows(materials, "back_reflectance",
             flattened<double>(solution.materials,
                               [](const Material& m) -> const Spectrum& { return m.reflectance_of(false); }),
             bands, "1", "diffuse reflectance of the back");
  if (std::any_of(solution.materials.begin(), solution.materials.end(),
                  [](const Material& m) { return m.non_diffuse.transmits_diffusely(); })) {
    std::vector<double> through;
    for (const Material& m : solution.materials)
      for (std::size_t b = 0; b < bands; ++b) through.push_back(m.diffuse_transmittance(b));
    put_rows(materials, "diffuse_transmittance", through, bands, "1",
             "share of the light on one side that leaves the other in all directions");
  }
  put_rows(materials, "emitted_radiance",
           flattened<double>(solution.materials,
                             [](const Material& m) -> const Spectrum& { return m.emitted_radiance; }),
           bands, "W/(m2 sr)", "radiance emitted by itself");
  put(materials, "emission_exponent",
      column<double>(solution.materials, std::mem_fn(&Material::emission_exponent)), 1, "1",
      "e: the emitted radiance falls as cos^e from the normal; 0 = the same in all directions");
  put(materials, "two_sided", column<std::uint8_t>(solution.materials, std::mem_fn(&Material::two_sided)), 1,
      "", "1 if the back reflects like the front, else it absorbs");
  put(materials, "emits_both_sides",
      column<std::uint8_t>(solution.materials, std::mem_fn(&Material::emits_both_sides)), 1, "",
      "1 if the back emits like the front");
}

void write_mesh(const Hdf5Group& root, const Solution& solution) {
  const BaseMesh& base = solution.mesh.base();
  const auto& triangles = base.triangles;
  const Hdf5Group mesh = root.create_group("mesh");
  const auto coordinates = [](const Vec3& v) -> const Vec3& { return v; };
  put(mesh, "vertices", flattened<double>(base.vertices, coordinates), 3, "m",
      "corners of the base triangles");
  put(mesh, "normals", flattened<double>(base.normals, coordinates), 3, "1", "shading normals, unit");
  put(mesh, "triangles", flattened<std::uint32_t>(triangles, std::mem_fn(&BaseTriangle::vertex)), 3, "",
      "rows of vertices, counter-clockwise from the front");
  put(mesh, "triangle_normals", flattened<std::uint32_t>(triangles, std::mem_fn(&BaseTriangle::normal)), 3,
      "", "rows of normals; 4294967295 = geometric normal");
  put(mesh, "triangle_surface",
      column<std::uint32_t>(triangles, [](const auto& t) { return t.surface.index(); }), 1, "",
      "row of /surfaces");
  put(mesh, "triangle_face", column<std::uint32_t>(triangles, std::mem_fn(&BaseTriangle::face)), 1, "",
      "polygon of the surface the triangle was cut from");
  if (!base.backs.empty()) {
    put(mesh, "triangle_back_surface",
        column<std::uint32_t>(base.backs, [](const auto& b) { return b.surface.index(); }), 1, "",
        "row of /surfaces whose front the back is, where two faces lie back to back; 4294967295 = none");
    put(mesh, "triangle_back_face", column<std::uint32_t>(base.backs, std::mem_fn(&SurfaceFace::face)), 1, "",
        "polygon of that surface");
  }
  put(mesh, "triangle_divisions", column<std::uint32_t>(triangles, std::mem_fn(&BaseTriangle::divisions)), 1,
      "", "n: the triangle has n*n cells on each side that has zones");
  const ZoneGroups& groups = solution.mesh.groups();
  put(mesh, "side_group", groups.of_side, 1, "",
      "group of each side, row 2t the front of triangle t, 2t+1 its back, that share one zone, numbered "
      "after all others; 4294967295 = has its own; empty = there are no groups");
  mesh.write_attribute("sealed_groups", groups.sealed);
  const CellSplits& splits = solution.mesh.splits();
  put(mesh, "split_sides", column<std::uint32_t>(splits.sides, std::mem_fn(&SideId::index)), 1, "",
      "sides, numbered as the rows of side_group, whose cells are cut further");
  put(mesh, "cell_cuts", splits.cuts, 1, "",
      "for each cell of these sides in order: 0 = not cut, or 1, 2, 3 = the corner it is cut from, and then "
      "the same of its two halves");
  put(mesh, "triangle_two_sided", column<std::uint8_t>(triangles, std::mem_fn(&BaseTriangle::two_sided)), 1,
      "", "1 if the back has zones, numbered after those of the front");
  put(mesh, "shapes", flattened<double>(base.shapes, [](const CurvedShape& s) { return row_of(s); }),
      kShapeRow, "m", "curved shapes: kind, centre or base, normal or top, radii, inward");
  put(mesh, "triangle_shape", column<std::uint32_t>(triangles, std::mem_fn(&BaseTriangle::shape)), 1, "",
      "row of shapes that the triangle is a patch of; 4294967295 = flat");
  AttributeWriter counts{mesh};
  transfer_mesh_counts(counts, solution.mesh_report);
  mesh.write("warnings", solution.mesh_report.warnings, "what meshing warned about");
}

// One column of zone values, computed zone by zone so that only one is in memory at a time.
template <class Function>
void put_zone_bands(const Hdf5Group& zones, const Solution& solution, const char* name,
                    const char* description, Function&& value_of) {
  const std::size_t bands = solution.bands.count();
  std::vector<float> values;
  values.reserve(solution.mesh.zone_count() * bands);
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    for (std::size_t band = 0; band < bands; ++band)
      values.push_back(static_cast<float>(value_of(ZoneId(z), band)));
  put_rows(zones, name, values, bands, "W/m2", description);
}

void write_zone_geometry(const Hdf5Group& zones, const ZoneMesh& mesh) {
  std::vector<std::uint32_t> triangle;
  std::vector<std::uint32_t> surface;
  std::vector<std::uint8_t> front;
  std::vector<float> corners;
  std::vector<float> area;
  std::vector<float> normal;
  std::vector<float> centroid;
  for (std::size_t i = 0; i < mesh.zone_count(); ++i) {
    const ZoneId z(i);
    triangle.push_back(static_cast<std::uint32_t>(mesh.zone_triangle(z).index()));
    surface.push_back(static_cast<std::uint32_t>(mesh.zone_surface(z).index()));
    front.push_back(mesh.zone_is_front(z) ? 1 : 0);
    const auto of_zone = mesh.is_group(z) ? std::array<Barycentric, 3>{} : mesh.zone_barycentrics(z);
    for (const auto& [u, v] : of_zone)
      corners.insert(corners.end(), {static_cast<float>(u), static_cast<float>(v)});
    area.push_back(static_cast<float>(mesh.zone_area(z)));
    for (const double x : mesh.zone_normal(z)) normal.push_back(static_cast<float>(x));
    for (const double x : mesh.zone_centroid(z)) centroid.push_back(static_cast<float>(x));
  }
  put(zones, "triangle", triangle, 1, "", "row of /mesh/triangles");
  put(zones, "surface", surface, 1, "", "row of /surfaces");
  put(zones, "front", front, 1, "", "1 on the front of the triangle, 0 on its back");
  put(zones, "corners", corners, 6, "1",
      "barycentric u, v of its three corners in the triangle; 0 of a group");
  put(zones, "area", area, 1, "m2", "area of one zone");
  put(zones, "normal", normal, 3, "1", "unit normal, away from the side of the zone");
  put(zones, "centroid", centroid, 3, "m", "centre of the zone");
}

void write_zone_values(const Hdf5Group& zones, const Solution& s) {
  put_zone_bands(zones, s, "radiosity", "emitted + direct + indirect + caustic",
                 [&](ZoneId z, std::size_t b) { return s.radiosity(z, b).mean; });
  put_zone_bands(zones, s, "radiosity_stderr", "standard error of radiosity",
                 [&](ZoneId z, std::size_t b) { return s.radiosity(z, b).stderr_of_mean; });
  put_zone_bands(zones, s, "emitted", "part of radiosity that the zone emits by itself",
                 [&](ZoneId z, std::size_t b) { return s.emitted_radiosity(z, b); });
  put_zone_bands(
      zones, s, "direct", "part of radiosity that came straight from a luminaire, also across panes",
      [&](ZoneId z, std::size_t b) { return s.scattered(z, b, &Solution::direct_irradiance).mean; });
  put_zone_bands(
      zones, s, "indirect", "part of radiosity that was scattered before",
      [&](ZoneId z, std::size_t b) { return s.scattered(z, b, &Solution::indirect_irradiance).mean; });
  put_zone_bands(
      zones, s, "caustic", "part of radiosity that came from a luminaire over mirrors, glass and gloss",
      [&](ZoneId z, std::size_t b) { return s.scattered(z, b, &Solution::caustic_irradiance).mean; });
  put_zone_bands(zones, s, "irradiance", "incident power per area",
                 [&](ZoneId z, std::size_t b) { return s.irradiance(z, b).mean; });
  put_zone_bands(zones, s, "irradiance_stderr", "standard error of irradiance",
                 [&](ZoneId z, std::size_t b) { return s.irradiance(z, b).stderr_of_mean; });
  put_zone_bands(zones, s, "irradiance_direct_stderr",
                 "standard error of the irradiance straight from luminaires",
                 [&](ZoneId z, std::size_t b) { return s.direct_irradiance(z, b).stderr_of_mean; });
  put_zone_bands(zones, s, "irradiance_indirect_stderr", "standard error of the irradiance scattered before",
                 [&](ZoneId z, std::size_t b) { return s.indirect_irradiance(z, b).stderr_of_mean; });
  put_zone_bands(zones, s, "irradiance_caustic_stderr",
                 "standard error of the irradiance over mirrors, glass and gloss",
                 [&](ZoneId z, std::size_t b) { return s.caustic_irradiance(z, b).stderr_of_mean; });
}

void write_sums(const Hdf5Group& root, const Solution& solution) {
  const Hdf5Group group = root.create_group("sums");
  const ZoneSums& sums = solution.sums;
  const std::size_t channels = solution.sums.channels.count();
  group.write_attribute("batches", sums.batches);
  group.write_attribute("weight_squared", sums.weight_squared);
  group.write<std::int64_t>("group_weight", {sums.group_weight.begin(), sums.group_weight.end()},
                            {ZoneSums::kGroups}, "1",
                            "sum over the batches of each group of their weights w");
  put_rows(group, "direct", sums.direct, channels, "W/m2",
           "sum over batches of w times the direct irradiance");
  put_rows(group, "direct_cross", sums.direct_cross, channels, "W/m2",
           "sum of w^2 times the direct irradiance");
  put_rows(group, "direct_squared", sums.direct_squared, channels, "W2/m4",
           "sum of the squares of w times the direct irradiance");
  put_rows(group, "indirect", sums.indirect, channels, "W/m2",
           "sum over batches of w times the indirect irradiance");
  put_rows(group, "indirect_cross", sums.indirect_cross, channels, "W/m2",
           "sum of w^2 times the indirect irradiance");
  put_rows(group, "indirect_squared", sums.indirect_squared, channels, "W2/m4",
           "sum of the squares of w times the indirect irradiance");
  put_rows(group, "total_squared", sums.total_squared, channels, "W2/m4",
           "sum of the squares of w times the irradiance, direct + indirect + caustic");
  if (sums.has_caustics()) {
    put_rows(group, "caustic", sums.caustic, channels, "W/m2",
             "sum over batches of w times the caustic irradiance");
    put_rows(group, "caustic_cross", sums.caustic_cross, channels, "W/m2",
             "sum of w^2 times the caustic irradiance");
    put_rows(group, "caustic_squared", sums.caustic_squared, channels, "W2/m4",
             "sum of the squares of w times the caustic irradiance");
  }
  group.write<float>("group_total", sums.group_total,
                     {ZoneSums::kGroups, sums.direct.size() / channels, channels}, "W/m2",
                     "sum of w times the irradiance over batches k, k + 16, k + 32 ... for k = 0 ... 15");
}

void write_gathered(const Hdf5Group& root, const Solution& solution) {
  const Hdf5Group group = root.create_group("gathered");
  const GatheredZones& gathered = solution.gathered;
  const std::size_t zones = gathered.zones.size();
  const std::size_t channels = solution.sums.channels.count();
  group.write_attribute("rays", gathered.rays);
  put(group, "zone", column<std::uint32_t>(gathered.zones, std::mem_fn(&ZoneId::index)), 1, "",
      "rows of /zones whose light was gathered after the last batch");
  group.write<double>("sums", gathered.sums, {zones, channels, solution.sums.columns().size()}, "",
                      "what packets brought there: direct, indirect, direct_cross, indirect_cross, "
                      "direct_squared, indirect_squared, total_squared and, where they are, caustic, "
                      "caustic_cross and caustic_squared as in /sums");
  group.write<float>("group_total", gathered.group_total, {ZoneSums::kGroups, zones, channels}, "W/m2",
                     "the same of group_total");
}

void write_all(const Hdf5Group& root, const Solution& solution) {
  root.write_attribute("format", std::string(kSolutionFormat));
  root.write_attribute("format_version", kSolutionFormatVersion);
  root.write_attribute("program_version", solution.program_version);
  root.write_attribute(
      "units", std::string("lengths in m, areas in m2, power in W; every band holds the power within it"));
  root.write_attribute("room_path", solution.room_path);
  for (std::size_t i = 0; i < solution.more_room_paths.size(); ++i)
    root.write_attribute(room_path_attribute(i), solution.more_room_paths[i]);
  root.write_attribute("room_hash", solution.room_hash);
  write_settings(root, solution);
  write_bands(root, solution.bands);
  write_surfaces(root, solution);
  write_mesh(root, solution);
  const Hdf5Group zones = root.create_group("zones");
  write_zone_geometry(zones, solution.mesh);
  write_zone_values(zones, solution);
  write_textures(root, solution);
  write_sums(root, solution);
  write_gathered(root, solution);
  write_gather_plan(root, solution);
  write_audit(root, solution);
}

}  // namespace

void save_solution(const Solution& solution, const std::filesystem::path& file, const Packing& packing) {
  check_consistent(solution);
  const Hdf5Quiet quiet;
  OutputFile output(file);
  try {
    Hdf5MemoryFile memory;
    tbb::task_arena arena(thread_count(solution.settings.threads));
    arena.execute([&] { write_all(memory.root(&packing), solution); });
    const std::string_view bytes = memory.close();
    output.write(bytes);
    output.write(seal_of(bytes));
  } catch (const Hdf5Error& error) {
    throw ResourceError(file.string(), error.what(),
                        "The previous file, if any, is unchanged. Check the free memory.");
  } catch (const std::bad_alloc&) {
    throw ResourceError(file.string(), "out of memory while saving",
                        "The previous file, if any, is unchanged. Close other programs or use larger zones.");
  }
  output.commit();
}

}  // namespace reemit
