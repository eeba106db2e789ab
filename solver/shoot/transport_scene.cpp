#include "solver/shoot/transport_scene.h"

namespace reemit {

TransportScene::TransportScene(const Scene& scene, const ZoneMesh& mesh, const RayScene& rays)
    : scene_(&scene), mesh_(&mesh), rays_(&rays), bands_(scene.bands.count()) {
  for (const Surface& s : scene.surfaces) {
    const Spectrum& rho = scene.material_of(s).reflectance;
    reflectance_.insert(reflectance_.end(), rho.begin(), rho.end());
    largest_reflectance_.push_back(rho.maxCoeff());
  }
  patches_.reserve(mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    const std::uint32_t n = mesh.triangle(t).divisions;
    const Vec3f p0 = rays.corner(t, 0);
    const Vec3f e1 = rays.corner(t, 1) - p0;
    const Vec3f e2 = rays.corner(t, 2) - p0;
    const auto scale = 1.0F / static_cast<float>(n);
    patches_.push_back({p0, scale * e1, scale * e2, p0 + (e1 + e2) / 3.0F, Frame(rays.normal(t)), n,
                        mesh.triangle(t).two_sided, mesh.first_zone(t, true).index()});
  }
}

}  // namespace reemit
