#include "bench/validation/code_room.h"

#include <numbers>

#include "mesh/shapes/room_shapes.h"

namespace reemit::validation {

CodeRoom::CodeRoom(BandSet bands) {
  scene_.name = "validation room";
  scene_.source = scene_.name;
  scene_.bands = std::move(bands);
}

MaterialId CodeRoom::paint(const Spectrum& reflectance, const Spectrum& exitance) {
  Material& m = scene_.materials.emplace_back();
  m.name = "paint " + std::to_string(scene_.materials.size());
  m.reflectance = reflectance;
  m.emitted_radiance = exitance / std::numbers::pi;
  m.two_sided = false;
  return MaterialId(scene_.materials.size() - 1);
}

MaterialId CodeRoom::paint(double reflectance, double exitance) {
  const auto bands = static_cast<Eigen::Index>(scene_.bands.count());
  return paint(Spectrum(Spectrum::Constant(bands, reflectance)),
               Spectrum(Spectrum::Constant(bands, exitance)));
}

MaterialId CodeRoom::mirror(double reflectance) {
  const MaterialId id = paint(0);
  scene_.materials.back().non_diffuse.specular_reflectance =
      Spectrum::Constant(static_cast<Eigen::Index>(scene_.bands.count()), reflectance);
  return id;
}

MaterialId CodeRoom::opal(double reflectance, double transmittance) {
  const MaterialId id = paint(reflectance);
  scene_.materials.back().two_sided = true;
  scene_.materials.back().non_diffuse.diffuse_transmittance =
      Spectrum::Constant(static_cast<Eigen::Index>(scene_.bands.count()), transmittance);
  return id;
}

MaterialId CodeRoom::pane(double index_of_refraction, double once) {
  return glass(index_of_refraction, once, false);
}

MaterialId CodeRoom::glass_body(double index_of_refraction) {
  return glass(index_of_refraction, 1, true);
}

MaterialId CodeRoom::glass(double index_of_refraction, double transmittance, bool is_solid) {
  const MaterialId id = paint(0);
  Material& m = scene_.materials.back();
  m.two_sided = true;
  m.non_diffuse.angle_law = AngleLaw::kDielectric;
  m.non_diffuse.index_of_refraction = index_of_refraction;
  m.non_diffuse.specular_transmittance =
      Spectrum::Constant(static_cast<Eigen::Index>(scene_.bands.count()), transmittance);
  m.non_diffuse.is_solid = is_solid;
  return id;
}

SurfaceId CodeRoom::add(const std::string& name, MaterialId material, const Body& body) {
  Surface& s = scene_.surfaces.emplace_back();
  s.name = name;
  s.material = material;
  const SurfaceId id(scene_.surfaces.size() - 1);
  if (const auto* shape = std::get_if<CurvedShape>(&body)) {
    s.shapes.push_back(*shape);
    return id;
  }
  for (const Polygon& p : std::get<std::vector<Polygon>>(body)) {
    Face& face = s.faces.emplace_back();
    for (const Vec3& corner : p) {
      face.outer.push_back(static_cast<std::uint32_t>(s.positions.size()));
      s.positions.push_back(corner);
    }
  }
  return id;
}

MeshResult CodeRoom::exact_zones(std::uint32_t divisions) const {
  BaseMesh base;
  RoomShapes shapes;
  for (std::size_t s = 0; s < scene_.surfaces.size(); ++s) {
    const Surface& surface = scene_.surfaces[s];
    const auto first = static_cast<std::uint32_t>(base.vertices.size());
    base.vertices.insert(base.vertices.end(), surface.positions.begin(), surface.positions.end());
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const std::vector<std::uint32_t>& outer = surface.faces[f].outer;
      for (std::size_t i = 2; i < outer.size(); ++i) {
        BaseTriangle& t = base.triangles.emplace_back();
        t.vertex = {first + outer[0], first + outer[i - 1], first + outer[i]};
        t.surface = SurfaceId(s);
        t.face = static_cast<std::uint32_t>(f);
        t.divisions = divisions;
        t.two_sided = scene_.material_of(surface).two_sided;
      }
    }
    for (std::size_t i = 0; i < surface.shapes.size(); ++i) {
      shapes.exact.push_back(surface.shapes[i]);
      shapes.surface.emplace_back(s);
      shapes.index.push_back(static_cast<std::uint32_t>(i));
    }
  }
  MeshReport report;
  report.surfaces.resize(scene_.surfaces.size());
  append_patches(scene_, shapes, base, report);
  for (BaseTriangle& t : base.triangles)
    if (t.is_curved()) t.divisions = divisions;
  return {ZoneMesh(std::move(base)), std::move(report)};
}

MeshResult CodeRoom::meshed(double zone_area) const {
  MeshSettings settings;
  settings.zone_area = zone_area;
  return build_mesh(scene_, settings);
}

}  // namespace reemit::validation
