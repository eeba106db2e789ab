#include "solver/trace/embree_tree.h"

#include <array>
#include <cmath>
#include <string>

#include "scenes/model/error.h"

namespace reemit {
namespace {

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

using Search = double (ShapeTarget::*)(const Vec3& origin, const Vec3& direction, double near,
                                       double far) const;

/// What a search finds of ray i of a packet of n, as a float inside the ray's range; infinity if nothing.
float hit_by(Search search, const ShapeTarget& shape, RTCRayN* rays, unsigned n, unsigned i) {
  const Vec3 origin(RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i));
  const Vec3 direction(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i));
  const float near = RTCRayN_tnear(rays, n, i);
  const float far = RTCRayN_tfar(rays, n, i);
  const auto t = static_cast<float>((shape.*search)(origin, direction, near, far));
  return t > near && t < far ? t : kInfinity;
}

void intersect_shape(const RTCIntersectFunctionNArguments* args) {
  const ShapeTarget& shape = static_cast<const ShapeTarget*>(args->geometryUserPtr)[args->primID];
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const float t = hit_by(&ShapeTarget::first, shape, rays, args->N, i);
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
    if (args->valid[i] != 0 && hit_by(&ShapeTarget::nearest, shape, args->ray, args->N, i) < kInfinity)
      RTCRayN_tfar(args->ray, args->N, i) = -kInfinity;
}

/// Lets rays pass that the cut-out does not stop: those whose number lies at or above its opacity there.
void pass_cut_out(const RTCFilterFunctionNArguments* args) {
  const auto& textures = *static_cast<const RoomTextures*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const std::uint32_t triangle = textures.cut_outs()[RTCHitN_primID(args->hit, args->N, i)];
    const float opacity = textures.opacity(TriangleId(triangle), RTCHitN_u(args->hit, args->N, i),
                                           RTCHitN_v(args->hit, args->N, i));
    const std::uint32_t bits = mixed_bits(RTCRayN_id(args->ray, args->N, i) ^ mixed_bits(triangle + 1));
    if (static_cast<float>(bits >> 8) * 0x1p-24F >= opacity) args->valid[i] = 0;
  }
}

}  // namespace

EmbreeTree::EmbreeTree() : device_(rtcNewDevice(nullptr)) {
  if (device_ == nullptr)
    throw ResourceError("ray tracing",
                        "Embree could not be started (error " +
                            std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))) + ")",
                        "Check that this processor supports SSE2 and that memory is available.");
  scene_ = rtcNewScene(device_);
}

EmbreeTree::~EmbreeTree() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  if (device_ != nullptr) rtcReleaseDevice(device_);
}

void EmbreeTree::add(const std::vector<Vec3f>& vertices,
                     const std::vector<std::array<std::uint32_t, 3>>& indices, unsigned number,
                     RTCFilterFunctionN filter, const void* of_filter) {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
  auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), indices.size()));
  if ((vertex == nullptr && !vertices.empty()) || (index == nullptr && !indices.empty())) {
    rtcReleaseGeometry(geometry);
    throw ResourceError("ray tracing", "out of memory for " + std::to_string(indices.size()) + " triangles",
                        "Free memory or use a coarser room.");
  }
  for (const Vec3f& p : vertices)
    for (int k = 0; k < 3; ++k) *vertex++ = p[k];
  for (const auto& corners : indices) index = std::copy(corners.begin(), corners.end(), index);
  if (filter != nullptr) {
    rtcSetGeometryUserData(geometry, const_cast<void*>(of_filter));
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, number);
  rtcReleaseGeometry(geometry);
}

void EmbreeTree::add_triangles(const std::vector<Vec3f>& vertices, std::span<const BaseTriangle> triangles,
                               const std::vector<std::uint32_t>& feet, const RoomTextures* textures) {
  std::vector<std::array<std::uint32_t, 3>> indices;
  indices.reserve(triangles.size());
  for (const BaseTriangle& t : triangles) indices.push_back(t.vertex);
  struct Apart {
    std::vector<Vec3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> indices;
  };
  const auto set_apart = [&](const std::vector<std::uint32_t>& apart) {
    Apart result;
    for (const std::uint32_t t : apart) {
      const auto first = static_cast<std::uint32_t>(result.vertices.size());
      for (std::uint32_t& v : indices[t]) {
        result.vertices.push_back(vertices[v]);
        v = triangles[t]
                .vertex[0];  // shrinks to a point, which no ray hits, and keeps the numbers of the others
      }
      result.indices.push_back({first, first + 1, first + 2});
    }
    return result;
  };
  // A foot that is a cut-out is one of these.
  const Apart of_cut_outs = textures == nullptr ? Apart{} : set_apart(textures->cut_outs());
  const Apart of_feet = set_apart(feet);
  add(vertices, indices, kTriangles);
  if (!feet.empty()) add(of_feet.vertices, of_feet.indices, kFeet);
  if (textures != nullptr) add(of_cut_outs.vertices, of_cut_outs.indices, kCutOuts, pass_cut_out, textures);
}

void EmbreeTree::add_filtered(const std::vector<Vec3f>& vertices,
                              const std::vector<std::array<std::uint32_t, 3>>& indices,
                              RTCFilterFunctionN filter) {
  add(vertices, indices, kTriangles, filter);
}

void EmbreeTree::add_shapes(const std::vector<CurvedShape>& shapes) {
  for (const CurvedShape& shape : shapes) targets_.emplace_back(shape);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(targets_.size()));
  rtcSetGeometryUserData(geometry, targets_.data());
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* args) { shape_bounds_callback(args); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_shape);
  rtcSetGeometryOccludedFunction(geometry, occlude_shape);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, kShapes);
  rtcReleaseGeometry(geometry);
}

void EmbreeTree::commit() {
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(scene_);
  const RTCError error = rtcGetDeviceError(device_);
  if (error != RTC_ERROR_NONE)
    throw ResourceError(
        "ray tracing",
        "Embree could not build its tree (error " + std::to_string(static_cast<int>(error)) + ")",
        "Free memory or use a coarser room.");
}

}  // namespace reemit
