#pragma once
#include <string>
#include <vector>

#include "bench/validation/shapes.h"
#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit::validation {

/// A room made in code: one surface per named set of polygons, one-sided.
class CodeRoom {
 public:
  explicit CodeRoom(BandSet bands = BandSet::grey());

  /// Reflectance [1] and exitance pi L [W/m2], one number per band, or the same in all.
  MaterialId paint(const Spectrum& reflectance, const Spectrum& exitance);
  MaterialId paint(double reflectance, double exitance = 0);
  /// A mirror of this reflectance at every angle, else black; its back absorbs.
  MaterialId mirror(double reflectance);
  /// A sheet that reflects and lets through so much on either side, into all directions.
  MaterialId opal(double reflectance, double transmittance);
  /// A clear thin pane by Fresnel's equations; `once`: left by one pass across it at normal incidence.
  MaterialId pane(double index_of_refraction, double once = 1);
  /// The surface of a body of clear glass that lies behind its faces.
  MaterialId glass_body(double index_of_refraction);

  /// Adds a surface of convex polygons or of one round shape.
  SurfaceId add(const std::string& name, MaterialId material, const Body& body);
  SurfaceId add(const std::string& name, MaterialId material, const Polygon& polygon) {
    return add(name, material, std::vector<Polygon>{polygon});
  }

  Scene& scene() { return scene_; }
  const Scene& scene() const { return scene_; }

  /// Every polygon as a fan of triangles around its first corner, each of divisions x divisions zones, as are
  /// the patches of round shapes: no repair, no splitting, so that zones are exactly what a reference means.
  MeshResult exact_zones(std::uint32_t divisions = 1) const;
  /// As the program meshes a room, with zones of at most `zone_area` [m2].
  MeshResult meshed(double zone_area) const;

 private:
  MaterialId glass(double index_of_refraction, double transmittance, bool is_solid);

  Scene scene_;
};

}  // namespace reemit::validation
