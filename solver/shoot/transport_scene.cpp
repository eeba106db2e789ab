#include "solver/shoot/transport_scene.h"

#include "solver/emit/light_places.h"

namespace reemit {

TransportScene::TransportScene(const Scene& scene, const ZoneMesh& mesh, const RayScene& rays)
    : scene_(&scene),
      mesh_(&mesh),
      rays_(&rays),
      bands_(scene.bands.count()),
      lights_(lights_before_faces(scene, rays)) {
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
                        mesh.triangle(t).two_sided, rays.is_foot(t), rays.edge_share(t),
                        mesh.first_zone(t, true).index()});
  }
}

void TransportScene::start_from(ZoneId z, float u0, float u1, const Vec3f& local, Ray16& rays,
                                int lane) const {
  const TriangleId t = mesh_->zone_triangle(z);
  const bool front = mesh_->zone_is_front(z);
  const auto corners = mesh_->zone_barycentrics(z);
  const auto [a, b] = sample_triangle(u0, u1);
  const auto inside = [&, a = a, b = b](double Barycentric::*k) {
    return static_cast<float>((1 - a - b) * corners[0].*k + a * corners[1].*k + b * corners[2].*k);
  };
  start_at(t, inside(&Barycentric::u), inside(&Barycentric::v), front, local, rays, lane);
}

void TransportScene::start_at(TriangleId t, float u, float v, bool front, const Vec3f& local, Ray16& rays,
                              int lane) const {
  const Vec3f origin = rays_->ray_origin(t, u, v, front);
  const Vec3f normal = rays_->normal(t, u, v);
  const Vec3f direction = Frame(front ? normal : Vec3f(-normal)).to_world(local);
  rays.set(lane, origin, direction);
}

void TransportScene::start_curved(const ZoneLanes& lanes, const UniformLanes& numbers, Ray16& rays) const {
  for (int lane = 0; lane < 16; ++lane) {
    if ((lanes.curved >> lane & 1U) == 0) continue;
    const Vec3f local = sample_cosine_hemisphere(numbers.u[2][lane], numbers.u[3][lane]);
    if ((lanes.points >> lane & 1U) != 0)
      start_at(TriangleId(lanes.zone[lane]), lanes.corner[0][lane], lanes.corner[1][lane],
               lanes.corner[2][lane] > 0, local, rays, lane);
    else
      start_from(ZoneId(lanes.zone[lane]), numbers.u[0][lane], numbers.u[1][lane], local, rays, lane);
  }
}

void TransportScene::start_at_feet(const ZoneLanes& lanes, Ray16& rays) const {
  for (int lane = 0; lane < 16; ++lane) {
    if ((lanes.feet >> lane & 1U) == 0) continue;
    const Vec3f start = rays_->clear_of_shapes(TriangleId(lanes.zone[lane]), rays.origin(lane));
    rays.set(lane, start, rays.direction(lane));
  }
}

}  // namespace reemit
