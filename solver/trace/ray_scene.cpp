#include "solver/trace/ray_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <limits>
#include <string>

#include "scenes/model/error.h"
#include "solver/trace/shape_hit.h"

namespace reemit {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

void intersect1(RTCScene scene, RTCRayHit& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
#endif
}

void intersect16(const int* valid, RTCScene scene, RTCRayHit16& rays) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect16(valid, scene, &rays);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect16(valid, scene, &context, &rays);
#endif
}

void occluded1(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

RTCRay make_ray(const Vec3f& origin, const Vec3f& direction, float near, float far) {
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = near;
  ray.tfar = far;
  ray.mask = 0xffffffffU;
  return ray;
}

constexpr unsigned kTriangles = 0;  // geometry numbers
constexpr unsigned kShapes = 1;

void shape_bounds_callback(const RTCBoundsFunctionArguments* args) {
  const ShapeTarget& shape = static_cast<const ShapeTarget*>(args->geometryUserPtr)[args->primID];
  const auto below = [](double x) { return std::nextafter(static_cast<float>(x), -kInfinity); };
  const auto above = [](double x) { return std::nextafter(static_cast<float>(x), kInfinity); };
  RTCBounds& box = *args->bounds_o;
  box.lower_x = below(shape.low().x());
  box.lower_y = below(shape.low().y());
  box.lower_z = below(shape.low().z());
  box.upper_x = above(shape.high().x());
  box.upper_y = above(shape.high().y());
  box.upper_z = above(shape.high().z());
}

/// Nearest hit of ray i of a packet of n, as a float inside the ray's range; infinity if there is none.
float nearest_hit(const ShapeTarget& shape, RTCRayN* rays, unsigned n, unsigned i) {
  const Vec3 origin(RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i));
  const Vec3 direction(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i));
  const float near = RTCRayN_tnear(rays, n, i);
  const float far = RTCRayN_tfar(rays, n, i);
  const auto t = static_cast<float>(shape.nearest(origin, direction, near, far));
  return t > near && t < far ? t : kInfinity;
}

void intersect_shape(const RTCIntersectFunctionNArguments* args) {
  const ShapeTarget& shape = static_cast<const ShapeTarget*>(args->geometryUserPtr)[args->primID];
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const float t = nearest_hit(shape, rays, args->N, i);
    if (t == kInfinity) continue;
    RTCRayN_tfar(rays, args->N, i) = t;
    RTCHitN_geomID(hits, args->N, i) = args->geomID;
    RTCHitN_primID(hits, args->N, i) = args->primID;
    RTCHitN_instID(hits, args->N, i, 0) = RTC_INVALID_GEOMETRY_ID;
  }
}

void occlude_shape(const RTCOccludedFunctionNArguments* args) {
  const ShapeTarget& shape = static_cast<const ShapeTarget*>(args->geometryUserPtr)[args->primID];
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] != 0 && nearest_hit(shape, args->ray, args->N, i) < kInfinity)
      RTCRayN_tfar(args->ray, args->N, i) = -kInfinity;
}

}  // namespace

struct RayScene::EmbreeScene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<ShapeTarget> targets;  // Embree keeps a pointer to them

  EmbreeScene() : device(rtcNewDevice(nullptr)) {
    if (device == nullptr)
      throw ResourceError("ray tracing",
                          "Embree could not be started (error " +
                              std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))) + ")",
                          "Check that this processor supports SSE2 and that memory is available.");
    scene = rtcNewScene(device);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayScene::RayScene(const ZoneMesh& mesh) : mesh_(&mesh), embree_(std::make_unique<EmbreeScene>()) {
  const BaseMesh& base = mesh.base();
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max());
  Vec3 high = -low;
  for (const Vec3& p : base.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (const CurvedShape& shape : base.shapes) {
    const auto [shape_low, shape_high] = shape_bounds(shape);
    low = low.cwiseMin(shape_low);
    high = high.cwiseMax(shape_high);
  }
  if (!base.vertices.empty()) {
    centre_ = 0.5 * (low + high);
    const double half = 0.5 * (high - low).maxCoeff();
    if (half > 0) metres_per_unit_ = half;
  }

  flat_count_ = mesh.flat_count();
  add_triangles();
  if (!base.shapes.empty()) add_shapes();
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(embree_->scene);
  const RTCError error = rtcGetDeviceError(embree_->device);
  if (error != RTC_ERROR_NONE)
    throw ResourceError(
        "ray tracing",
        "Embree could not build its tree (error " + std::to_string(static_cast<int>(error)) + ")",
        "Free memory or use a coarser room.");
}

void RayScene::add_triangles() {
  const BaseMesh& base = mesh_->base();
  corners_.reserve(3 * base.triangles.size());
  normals_.reserve(base.triangles.size());
  for (std::size_t t = 0; t < base.triangles.size(); ++t) {
    for (const std::uint32_t v : base.triangles[t].vertex) corners_.push_back(normalised(base.vertices[v]));
    normals_.push_back(mesh_->triangle_normal(TriangleId(t)).cast<float>());
  }

  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), base.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), flat_count_));
  if ((vertices == nullptr && !base.vertices.empty()) || (indices == nullptr && flat_count_ > 0)) {
    rtcReleaseGeometry(geometry);
    throw ResourceError("ray tracing", "out of memory for " + std::to_string(flat_count_) + " triangles",
                        "Free memory or use a coarser room.");
  }
  for (std::size_t i = 0; i < base.vertices.size(); ++i) {
    const Vec3f p = normalised(base.vertices[i]);
    for (int k = 0; k < 3; ++k) vertices[3 * i + static_cast<std::size_t>(k)] = p[k];
  }
  for (std::size_t t = 0; t < flat_count_; ++t)
    for (std::size_t k = 0; k < 3; ++k) indices[3 * t + k] = base.triangles[t].vertex[k];
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(embree_->scene, geometry, kTriangles);
  rtcReleaseGeometry(geometry);
}

void RayScene::add_shapes() {
  const double scale = 1 / metres_per_unit_;
  Eigen::Affine3d to_normalised = Eigen::Affine3d::Identity();
  to_normalised.scale(scale).translate(-centre_);
  for (const CurvedShape& shape : mesh_->base().shapes) {
    const CurvedShape normalised_shape = transformed(shape, to_normalised);
    shapes_.emplace_back(normalised_shape);
    embree_->targets.emplace_back(normalised_shape);
  }
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(shapes_.size()));
  rtcSetGeometryUserData(geometry, embree_->targets.data());
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* args) { shape_bounds_callback(args); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_shape);
  rtcSetGeometryOccludedFunction(geometry, occlude_shape);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(embree_->scene, geometry, kShapes);
  rtcReleaseGeometry(geometry);
}

Vec3 RayScene::curved_point(TriangleId t, float u, float v) const {
  const BaseTriangle& patch = mesh_->triangle(t);
  return shapes_[patch.shape].point(patch.patch, u, v);
}

Vec3f RayScene::curved_normal(TriangleId t, float u, float v) const {
  const BaseTriangle& patch = mesh_->triangle(t);
  return shapes_[patch.shape].normal(patch.patch, u, v).cast<float>();
}

void RayScene::read_hit(std::uint32_t geometry, std::uint32_t primitive, float u, float v, float distance,
                        const Vec3f& origin, const Vec3f& direction, Hit& hit) const {
  hit.distance = distance;
  if (geometry == kTriangles) {
    hit.triangle = TriangleId(primitive);
    hit.u = u;
    hit.v = v;
    hit.front = normals_[primitive].dot(direction) < 0;
    return;
  }
  const Vec3 d = direction.cast<double>();
  const Vec3 point = origin.cast<double>() + static_cast<double>(distance) * d;
  const CurvedPatches& patches = shapes_[primitive];
  const CurvedPatches::Place place = patches.place_of(point);
  hit.triangle = TriangleId(mesh_->first_patch(primitive).index() + place.patch);
  hit.u = static_cast<float>(place.at.u);
  hit.v = static_cast<float>(place.at.v);
  hit.front = patches.normal_at(point).dot(d) < 0;
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

Vec3f RayScene::lifted(const Vec3f& point, const Vec3f& side_normal, const Vec3f& middle) {
  const Vec3f inward = middle - point;
  return point + kLift * side_normal + inset_share(inward.norm()) * inward;
}

Vec3f RayScene::ray_origin(TriangleId t, float u, float v, bool front) const {
  if (is_curved(t)) {
    // Drawn inwards along the shape, so that the start stays on its side of faces that the shape stands on.
    constexpr float kMiddle = 1.0F / 3;
    const float inset = inset_share((curved_point(t, kMiddle, kMiddle) - curved_point(t, u, v)).norm());
    const float s = u + inset * (kMiddle - u);
    const float r = v + inset * (kMiddle - v);
    const Vec3 n = curved_normal(t, s, r).cast<double>();
    return (curved_point(t, s, r) + (front ? kLift : -kLift) * n).cast<float>();
  }
  const Vec3f& n = normal(t);
  return lifted(point(t, u, v), front ? n : Vec3f(-n), (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0F);
}

bool RayScene::closest(const Vec3f& origin, const Vec3f& direction, Hit& hit) const {
  const auto trace = [&](const Vec3f& d) {
    RTCRayHit query{};
    query.ray = make_ray(origin, d, 0, kInfinity);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect1(embree_->scene, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    read_hit(query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar, origin, d, hit);
    return true;
  };
  return trace(direction) || trace(nudged(direction));
}

bool RayScene::closest_for_camera(const Vec3f& origin, const Vec3f& direction, Hit& hit) const {
  float near = 0;
  for (;;) {
    RTCRayHit query{};
    query.ray = make_ray(origin, direction, near, kInfinity);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect1(embree_->scene, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    read_hit(query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar, origin, direction,
             hit);
    if (hit.front || mesh_->triangle(hit.triangle).two_sided) return true;
    near = std::max(query.ray.tfar * (1 + 1e-6F), std::nextafter(query.ray.tfar, kInfinity));
  }
}

void RayScene::closest16(const Ray16& rays, int count, Hit16& hits) const {
  alignas(64) int valid[16];
  alignas(64) RTCRayHit16 query;
  for (int i = 0; i < 16; ++i) {
    valid[i] = i < count ? -1 : 0;
    query.ray.org_x[i] = rays.ox[i];
    query.ray.org_y[i] = rays.oy[i];
    query.ray.org_z[i] = rays.oz[i];
    query.ray.dir_x[i] = rays.dx[i];
    query.ray.dir_y[i] = rays.dy[i];
    query.ray.dir_z[i] = rays.dz[i];
    query.ray.tnear[i] = 0;
    query.ray.tfar[i] = kInfinity;
    query.ray.time[i] = 0;
    query.ray.mask[i] = 0xffffffffU;
    query.ray.id[i] = 0;
    query.ray.flags[i] = 0;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.primID[i] = kMiss;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  intersect16(valid, embree_->scene, query);
  for (int i = 0; i < count; ++i) {
    const std::uint32_t t = query.hit.primID[i];
    hits.triangle[i] = t;
    if (t == kMiss) continue;
    if (query.hit.geomID[i] != kTriangles) {
      Hit hit;
      read_hit(query.hit.geomID[i], t, 0, 0, query.ray.tfar[i], {rays.ox[i], rays.oy[i], rays.oz[i]},
               {rays.dx[i], rays.dy[i], rays.dz[i]}, hit);
      hits.triangle[i] = static_cast<std::uint32_t>(hit.triangle.index());
      hits.u[i] = hit.u;
      hits.v[i] = hit.v;
      hits.distance[i] = hit.distance;
      hits.front[i] = hit.front;
      continue;
    }
    const Vec3f& n = normals_[t];
    hits.u[i] = query.hit.u[i];
    hits.v[i] = query.hit.v[i];
    hits.distance[i] = query.ray.tfar[i];
    hits.front[i] = n.x() * rays.dx[i] + n.y() * rays.dy[i] + n.z() * rays.dz[i] < 0;
  }
}

Vec3f RayScene::nudged(const Vec3f& direction) {
  constexpr float kTurn = 3e-6F;
  const Vec3f& d = direction;
  return Vec3f(d.x() + kTurn * d.y(), d.y() + kTurn * d.z(), d.z() - kTurn * d.x()).normalized();
}

void RayScene::look_again16(const Ray16& rays, int count, Hit16& hits) const {
  Ray16 missed;
  int lanes[16];
  int missed_count = 0;
  for (int i = 0; i < count; ++i) {
    if (hits.triangle[i] != kMiss) continue;
    missed.ox[missed_count] = rays.ox[i];
    missed.oy[missed_count] = rays.oy[i];
    missed.oz[missed_count] = rays.oz[i];
    const Vec3f d = nudged({rays.dx[i], rays.dy[i], rays.dz[i]});
    missed.dx[missed_count] = d.x();
    missed.dy[missed_count] = d.y();
    missed.dz[missed_count] = d.z();
    lanes[missed_count++] = i;
  }
  if (missed_count == 0) return;
  Hit16 again;
  closest16(missed, missed_count, again);
  for (int k = 0; k < missed_count; ++k) {
    const int i = lanes[k];
    hits.triangle[i] = again.triangle[k];
    hits.u[i] = again.u[k];
    hits.v[i] = again.v[k];
    hits.distance[i] = again.distance[k];
    hits.front[i] = again.front[k];
  }
}

bool RayScene::visible(const Vec3f& from, const Vec3f& to) const {
  const Vec3f d = to - from;
  const float distance = d.norm();
  if (!(distance > 0)) return true;
  RTCRay ray = make_ray(from, d / distance, 0, distance * (1 - 1e-6F));
  occluded1(embree_->scene, ray);
  return ray.tfar >= 0;
}

bool RayScene::escapes(const Vec3f& origin, const Vec3f& direction) const {
  RTCRay ray = make_ray(origin, direction, 0, kInfinity);
  occluded1(embree_->scene, ray);
  if (ray.tfar < 0) return false;
  ray = make_ray(origin, nudged(direction), 0, kInfinity);
  occluded1(embree_->scene, ray);
  return ray.tfar >= 0;
}

}  // namespace reemit
