#include "bench/hit_paths/hit_path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <Eigen/Geometry>

#include "bench/hit_paths/path_step.h"
#include "bench/hit_paths/rough_ways.h"
#include "bench/hit_paths/surface_ways.h"

namespace reemit::hit_paths {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSafeBounces = 4;  ///< Before chance may end a path.

/// What a light that no path can hit sends to a point.
struct Arriving {
  Vec3 from;            // the light, or far away towards it
  Spectrum irradiance;  // [W/m2] on a plane across the way
};

struct Arrive {
  const Vec3& x;
  double far;

  Arriving operator()(const PointLight& l) const {
    return {l.position, l.intensity / (l.position - x).squaredNorm()};
  }
  Arriving operator()(const SpotLight& l) const {
    const Vec3 way = x - l.position;
    const double cosine = way.normalized().dot(l.direction);
    const double inner = std::cos(l.inner_angle);
    const double outer = std::cos(l.outer_angle);
    const double share = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    return {l.position, share * share * l.intensity / way.squaredNorm()};
  }
  Arriving operator()(const DirectionalLight& l) const { return {x - far * l.direction, l.irradiance}; }
  Arriving operator()(const PhotometricLight& l) const {  // apart from the others
    return {l.position, Spectrum::Zero(l.intensity_per_candela.size())};
  }
};

/// Light leaves openings that far off them, as a share of the room, so that one in the plane of a ceiling
/// shines out of it.
constexpr double kClearance = 1e-5;

/// The sizes of an opening are those of its file but for the scale of the room. A size of 0 may stand for the
/// diameter of what is round.
void check_size(const Vec3& opening, const Vec3& file) {
  const Vec3 stated = (file.array() > 0).select(opening, Vec3::Zero());
  constexpr double kRounding = 1e-9;
  if (stated.norm() > 0 && (stated.normalized() - file.normalized()).norm() > kRounding)
    throw std::invalid_argument("an opening is not as its IES file says");
}

/// Throws std::invalid_argument if a surface has an image or colours of vertices.
void check_plain(const Scene& scene) {
  for (const Surface& surface : scene.surfaces)
    if (scene.is_textured(surface))
      throw std::invalid_argument("the reference knows no images on surfaces, such as " + surface.name +
                                  " has (--flat leaves them out)");
}

}  // namespace

HitPathTracer::HitPathTracer(const Scene& scene, const Camera& camera, int width, int height,
                             const std::filesystem::path& photometry)
    : scene_(&scene),
      room_(scene),
      sky_(scene),
      clearance_(kClearance * bounds(scene).size().maxCoeff()),
      eye_(camera.eye) {
  check_plain(scene);
  std::map<const IntensityTable*, std::shared_ptr<const Photometry>> tables;
  std::shared_ptr<const Photometry> file;
  if (!photometry.empty()) file = std::make_shared<Photometry>(photometry);
  for (const PunctualLight& light : scene.lights) {
    const auto* measured = std::get_if<PhotometricLight>(&light);
    if (measured == nullptr) continue;
    if (file) check_size(measured->opening.size(), file->size());
    std::shared_ptr<const Photometry>& table = tables[measured->table.get()];
    if (!table) table = file ? file : std::make_shared<Photometry>(*measured->table);
    const OpeningHit opening(*measured, table, clearance_);
    (opening.can_be_hit() ? openings_ : lines_).push_back({opening, &measured->intensity_per_candela});
  }
  const Vec3 forward = (camera.look_at - camera.eye).normalized();
  const Vec3 right = forward.cross(camera.up).normalized();
  const double step = 2 * std::tan(camera.vertical_fov_deg * kPi / 360) / height;
  right_ = step * right;
  down_ = step * forward.cross(right);
  corner_ = forward - 0.5 * width * right_ - 0.5 * height * down_;
}

void HitPathTracer::add_emission(const RoomHit& hit, const Vec3& direction, const Spectrum& weight,
                                 double* sum) const {
  const Material& m = *hit.material;
  if (!m.emits() || !(hit.front || (m.two_sided && m.emits_both_sides))) return;
  const double cosine = -hit.normal.dot(direction);
  const double shape = m.emission_exponent > 0 ? std::pow(cosine, m.emission_exponent) : 1.0;
  for (Eigen::Index b = 0; b < weight.size(); ++b) sum[b] += weight[b] * shape * m.emitted_radiance[b];
}

void HitPathTracer::add_openings(const RayStart& start, const Vec3& direction, double far,
                                 const Spectrum& weight, double* sum) const {
  for (const Measured& m : openings_) {
    const double radiance = m.opening.radiance(start.point, direction, far);
    if (!(radiance > 0)) continue;
    for (Eigen::Index b = 0; b < weight.size(); ++b) sum[b] += weight[b] * radiance * (*m.per_candela)[b];
  }
}

void HitPathTracer::add_lights(const RoomHit& hit, const Vec3& direction, const Spectrum& weight,
                               Random& random, double* sum) const {
  const auto add = [&](const Arriving& arriving, double clearance) {
    const Vec3 way = arriving.from - hit.point;
    const double distance = way.norm();
    const double cosine = hit.normal.dot(way) / distance;
    Spectrum value = rough_value(hit, direction, way / distance);
    value += (cosine > 0 ? reflected_diffusely(*hit.material, hit.front) : let_through(*hit.material)) / kPi;
    if (!(arriving.irradiance * value > 0).any()) return;
    const double share = 1 - std::min(0.5, clearance / distance);
    const Spectrum left = left_between({hit.point, hit.part}, hit.point + share * way);
    for (Eigen::Index b = 0; b < weight.size(); ++b)
      sum[b] += weight[b] * value[b] * std::abs(cosine) * arriving.irradiance[b] * left[b];
  };
  for (const PunctualLight& light : scene_->lights)
    add(std::visit(Arrive{hit.point, 10 * room_.diagonal()}, light), 0);
  if (sky_.has_sun())
    add({hit.point + 10 * room_.diagonal() * sky_.towards_sun(random), sky_.sun_irradiance()}, 0);
  for (const Measured& m : lines_) {
    const Vec3 from = m.opening.random_point(random);
    add({from, m.opening.irradiance(from, hit.point) * *m.per_candela}, clearance_);
  }
}

Spectrum HitPathTracer::left_between(RayStart start, const Vec3& target) const {
  Spectrum left = Spectrum::Ones(static_cast<Eigen::Index>(scene_->bands.count()));
  double distance = (target - start.point).norm();
  const Vec3 direction = (target - start.point) / distance;
  const double rounding = 1e-9 * distance;
  while ((left > 0).any()) {
    const auto hit = room_.closest(start, direction, false);
    if (!hit || hit->distance > distance - rounding) return left;
    if (is_body(*hit->material) || is_rough_across(*hit->material)) break;
    left *= specular_shares(*hit->material, arrival_angle(*hit, direction), hit->front).crossing;
    start = {hit->point, hit->part};
    distance -= hit->distance;
  }
  return Spectrum::Zero(left.size());
}

void HitPathTracer::add_path(int x, int y, Random& random, double* sum) const {
  const double px = x + uniform(random);
  const double py = y + uniform(random);
  Vec3 direction = (corner_ + px * right_ + py * down_).normalized();
  RayStart start{eye_, RayStart::kFree};
  Spectrum weight = Spectrum::Ones(static_cast<Eigen::Index>(scene_->bands.count()));
  const Material* body = nullptr;  // of glass that the path has entered
  bool entered = false;            // from outside, or it was met from inside
  bool scattered = false;
  for (int bounce = 0;; ++bounce) {
    const auto hit = room_.closest(start, direction, bounce == 0);
    // What is not seen is not seen in mirrors either.
    if (scattered)
      add_openings(start, direction, hit ? hit->distance : std::numeric_limits<double>::infinity(), weight,
                   sum);
    if (!hit) {
      sky_.add_radiance(direction, weight, sum);
      return;
    }
    const bool comes_from_inside = !hit->front && is_body(*hit->material);
    if (body == nullptr && comes_from_inside) body = hit->material;
    if (body != nullptr) weight *= left_inside(*body, hit->distance);
    // Paths carry radiance as that outside of glass, into which light from inside is spread by n^2.
    const double n = entered ? body->non_diffuse.index_of_refraction : 1;
    add_emission(*hit, direction, weight / (n * n), sum);
    if (!hit->front && !hit->material->two_sided) return;
    add_lights(*hit, direction, weight / (n * n), random, sum);
    const auto step = next_step(*hit, direction, bounce >= kSafeBounces, random);
    if (!step) return;
    weight *= step->weight;
    if (!(weight > 0).any()) return;
    scattered = scattered || step->scatters;
    if (is_body(*hit->material)) {
      body = step->crosses == hit->front ? hit->material : nullptr;
      entered = body != nullptr;
    }
    start = {hit->point, hit->part};
    direction = step->direction;
  }
}

}  // namespace reemit::hit_paths
