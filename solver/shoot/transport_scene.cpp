#include "solver/shoot/transport_scene.h"

namespace reemit {

TransportScene::TransportScene(const Scene& scene, const ZoneMesh& mesh, const RayScene& rays)
    : scene_(&scene), mesh_(&mesh), rays_(&rays), bands_(scene.bands.count()) {
  for (const Surface& s : scene.surfaces) {
    const Spectrum& rho = scene.material_of(s).reflectance;
    reflectance_.insert(reflectance_.end(), rho.begin(), rho.end());
    largest_reflectance_.push_back(rho.maxCoeff());
  }
}

TransportScene::ZonePatch TransportScene::zone_patch(ZoneId z) const {
  const TriangleId t = mesh_->zone_triangle(z);
  const Vec3f p0 = rays_->corner(t, 0);
  const Vec3f e1 = rays_->corner(t, 1) - p0;
  const Vec3f e2 = rays_->corner(t, 2) - p0;
  const auto c = mesh_->zone_barycentrics(z);
  const auto at = [&](const Barycentric& b) {
    return Vec3f(p0 + static_cast<float>(b.u) * e1 + static_cast<float>(b.v) * e2);
  };
  const Vec3f corner = at(c[0]);
  const Vec3f& n = rays_->normal(t);
  return {corner, at(c[1]) - corner, at(c[2]) - corner, p0 + (e1 + e2) / 3.0F,
          Frame(mesh_->zone_is_front(z) ? n : Vec3f(-n))};
}

void TransportScene::start_ray(const ZonePatch& patch, float u0, float u1, float u2, float u3, Ray16& rays,
                               int lane) {
  const auto [a, b] = sample_triangle(u0, u1);
  const Vec3f on_zone = patch.corner + a * patch.edge1 + b * patch.edge2;
  const Vec3f origin = RayScene::lifted(on_zone, patch.frame.normal, patch.towards_middle);
  const Vec3f direction = patch.frame.to_world(sample_cosine_hemisphere(u2, u3));
  rays.ox[lane] = origin.x();
  rays.oy[lane] = origin.y();
  rays.oz[lane] = origin.z();
  rays.dx[lane] = direction.x();
  rays.dy[lane] = direction.y();
  rays.dz[lane] = direction.z();
}

}  // namespace reemit
