#include "solver/trace/ray_tracer.h"

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "mesh/zones/hairlines.h"
#include "solver/trace/embree_queries.h"

namespace reemit {
namespace {

/// Distances of two faces along a ray are told apart where they are this far from their common edge
/// [normalised units]; the wrong one was met up to 3e-7 from edges.
constexpr float kEdgeWidth = 2e-6F;
/// By how much rays are turned for the second look.
constexpr float kTurn = 3e-6F;

/// Where a way to a ray origin ends, so that what it lies on is not in the way.
float shortened(float distance) {
  return distance * (1 - 1e-6F);
}

Vec3f turned(const Vec3f& d) {
  return Vec3f(d.x() + kTurn * d.y(), d.y() + kTurn * d.z(), d.z() - kTurn * d.x()).normalized();
}

}  // namespace

RayTracer::RayTracer(const ZoneMesh& mesh) : RayTracer(mesh, RoomTextures()) {}

RayTracer::RayTracer(const ZoneMesh& mesh, const RoomTextures& textures)
    : mesh_(&mesh),
      cut_outs_(textures.cut_outs().empty() ? nullptr : &textures),
      embree_(std::make_unique<EmbreeTree>()) {
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
  misses_are_doubtful_ = cut_outs_ != nullptr || may_have_hairlines(base);
  corners_.reserve(3 * base.triangles.size());
  faces_.reserve(base.triangles.size() + 1);
  for (std::size_t t = 0; t < base.triangles.size(); ++t) {
    for (const std::uint32_t v : base.triangles[t].vertex) corners_.push_back(normalised(base.vertices[v]));
    faces_.push_back({mesh.triangle_normal(TriangleId(t)).cast<float>(), -kInfinity});
  }
  if (faces_.empty()) faces_.push_back({Vec3f::Zero(), -kInfinity});
  for (std::size_t t = 0; t < flat_count_; ++t)
    for (int k = 0; k < 3; ++k) {
      float height = 0;
      into_triangle(TriangleId(t), k, height);
      faces_[t].edge_share = std::max(faces_[t].edge_share, kEdgeWidth / std::max(height, kEdgeWidth));
    }
  std::vector<CurvedShape> shapes;
  for (const CurvedShape& shape : base.shapes) {
    shapes.push_back(normalised(shape));
    shapes_.emplace_back(shapes.back());
  }
  for (std::size_t t = flat_count_; t < base.triangles.size(); ++t)
    patch_middles_.push_back(curved_point(TriangleId(t), kMiddle, kMiddle).cast<float>());
  if (!shapes.empty()) feet_ = ShapeFeet(mesh, corners_, shapes);

  std::vector<Vec3f> vertices;
  vertices.reserve(base.vertices.size());
  for (const Vec3& p : base.vertices) vertices.push_back(normalised(p));
  const auto flat = std::span(base.triangles).first(flat_count_);
  embree_->add_triangles(vertices, flat, feet_.triangles(), cut_outs_);
  if (!shapes.empty()) embree_->add_shapes(shapes);
  embree_->commit();
}

CurvedShape RayTracer::normalised(const CurvedShape& shape) const {
  Eigen::Affine3d to_normalised = Eigen::Affine3d::Identity();
  to_normalised.scale(1 / metres_per_unit_).translate(-centre_);
  return transformed(shape, to_normalised);
}

Vec3 RayTracer::curved_point(TriangleId t, float u, float v) const {
  const BaseTriangle& patch = mesh_->triangle(t);
  return shapes_[patch.shape].point(patch.patch, u, v);
}

Vec3f RayTracer::curved_normal(TriangleId t, float u, float v) const {
  const BaseTriangle& patch = mesh_->triangle(t);
  return shapes_[patch.shape].normal(patch.patch, u, v).cast<float>();
}

float RayTracer::read_hit(std::uint32_t geometry, std::uint32_t primitive, float u, float v, float distance,
                          const Vec3f& origin, const Vec3f& direction, Hit& hit) const {
  hit.distance = distance;
  float height = 0;
  if (geometry == EmbreeTree::kShapes) {
    const Vec3 d = direction.cast<double>();
    const Vec3 point = origin.cast<double>() + static_cast<double>(distance) * d;
    const CurvedPatches& patches = shapes_[primitive];
    const CurvedPatches::Place place = patches.place_of(point);
    hit.triangle = TriangleId(mesh_->first_patch(primitive).index() + place.patch);
    hit.u = static_cast<float>(place.at.u);
    hit.v = static_cast<float>(place.at.v);
    height = static_cast<float>(patches.normal_at(point).dot(d));
  } else {
    ShapeFeet::Place place{primitive, u, v};
    if (geometry == EmbreeTree::kCutOuts) place.triangle = cut_outs_->cut_outs()[primitive];
    if (geometry == EmbreeTree::kFeet)
      place = feet_.place_of({feet_.triangles()[primitive], u, v}, origin.cast<double>(),
                             direction.cast<double>(), static_cast<double>(distance));
    hit.triangle = TriangleId(place.triangle);
    hit.u = place.u;
    hit.v = place.v;
    height = faces_[place.triangle].normal.dot(direction);
  }
  hit.front = height < 0;
  return height;
}

std::uint32_t RayTracer::key_of(const Vec3f& origin, const Vec3f& direction, std::uint32_t chance) {
  std::uint32_t key = 0x9e3779b9U ^ chance;
  for (const Vec3f* v : {&origin, &direction})
    for (const float x : *v) key = mixed_bits(key ^ std::bit_cast<std::uint32_t>(x));
  return key | 1U;  // 0 stands for none
}

RayTracer::~RayTracer() = default;
RayTracer::RayTracer(RayTracer&&) noexcept = default;
RayTracer& RayTracer::operator=(RayTracer&&) noexcept = default;

Vec3f RayTracer::lifted(const Vec3f& point, const Vec3f& side_normal, const Vec3f& middle) {
  const Vec3f inward = middle - point;
  return point + kLift * side_normal + inset_share(inward.norm()) * inward;
}

void RayTracer::move_off_edges(TriangleId t, float& u, float& v) const {
  constexpr float kOffEdge = 4 * kLift;
  float weight[3] = {1 - u - v, u, v};
  for (int k = 0; k < 3; ++k) {
    float height = 0;
    into_triangle(t, k, height);
    const float wanted = height > 3 * kOffEdge ? kOffEdge / height : 1.0F / 3;
    if (weight[k] >= wanted) continue;
    const float rest = (1 - wanted) / (1 - weight[k]);
    for (float& other : weight) other *= rest;
    weight[k] = wanted;
  }
  u = weight[1];
  v = weight[2];
}

Vec3f RayTracer::curved_ray_origin(TriangleId t, float u, float v, bool front, Vec3f& normal) const {
  // Drawn inwards along the shape, so that the start stays on its side of faces that the shape stands on. How
  // far the middle is, is asked of the triangle that stands for the patch: where it matters, near its edges,
  // the two differ by a few per cent.
  const float inset = inset_share(patch_chord(t).distance(u, v));
  const float s = u + inset * (kMiddle - u);
  const float r = v + inset * (kMiddle - v);
  const CurvedPatches& shape = shapes_[shape_of(t)];
  const CurvedPatches::Point at = shape.at(mesh_->triangle(t).patch, s, r);
  Vec3 p = at.position;
  Vec3 n = at.normal.cast<float>().cast<double>();
  normal = n.cast<float>();
  if (touches_others(t)) {
    p = feet_.clear_of_others(shape_of(t), p);
    n = shape.normal_at(p);
  }
  return (p + (front ? kLift : -kLift) * n).cast<float>();
}

Vec3f RayTracer::ray_origin(TriangleId t, float u, float v, bool front, Vec3f& front_normal) const {
  if (is_curved(t)) return curved_ray_origin(t, u, v, front, front_normal);
  front_normal = normal(t);
  if (std::min({u, v, 1 - u - v}) < edge_share(t)) move_off_edges(t, u, v);
  const Vec3f& n = normal(t);
  const Vec3f start =
      lifted(point(t, u, v), front ? n : Vec3f(-n), (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0F);
  return is_foot(t) ? clear_of_shapes(t, start) : start;
}

bool RayTracer::nearest(const Vec3f& origin, const Vec3f& direction, float far, std::uint32_t key,
                        Hit& hit) const {
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, 0, far, key);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect1(embree_->scene(), query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  read_hit(query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar, origin, direction,
           hit);
  return true;
}

bool RayTracer::closest(const Vec3f& origin, const Vec3f& direction, Hit& hit, std::uint32_t chance) const {
  const std::uint32_t key = cut_out_key(origin, direction, chance);
  const auto trace = [&](const Vec3f& d, Hit& found) { return nearest(origin, d, kInfinity, key, found); };
  const auto number = [](const Hit& found) { return static_cast<std::uint32_t>(found.triangle.index()); };
  const bool any = trace(direction, hit);
  const std::uint32_t met = any ? number(hit) : kMiss;
  if (!is_doubtful(met, hit.u, hit.v, hit.front)) return any;
  Hit second;
  if (!trace(second_direction(direction, met, hit.u, hit.v), second)) return any;
  if (!any || !is_lost(number(second), second.front)) hit = second;
  return true;
}

bool RayTracer::closest_for_camera(const Vec3f& origin, const Vec3f& direction, Hit& hit) const {
  const std::uint32_t key = cut_out_key(origin, direction);
  const auto look = [&](const Vec3f& d) {
    float near = 0;
    for (;;) {
      RTCRayHit query{};
      query.ray = make_ray(origin, d, near, kInfinity, key);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      intersect1(embree_->scene(), query);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
      read_hit(query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar, origin, d, hit);
      if (!is_lost(static_cast<std::uint32_t>(hit.triangle.index()), hit.front)) return true;
      near = std::max(query.ray.tfar * (1 + 1e-6F), std::nextafter(query.ray.tfar, kInfinity));
    }
  };
  return look(direction) || (misses_are_doubtful_ && look(turned(direction)));
}

void RayTracer::closest16(const Ray16& rays, int count, Hit16& hits) const {
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
    query.ray.id[i] = cut_outs_ != nullptr && i < count ? cut_out_key(rays, i) : 0;
    query.ray.flags[i] = 0;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.primID[i] = kMiss;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  // Embree may pass over `valid` and look for rays of no length instead. What else lies in these lanes it
  // would trace, or end the program where that is no number.
  for (int i = count; i < 16; ++i) {
    query.ray.org_x[i] = query.ray.org_y[i] = query.ray.org_z[i] = 0;
    query.ray.dir_x[i] = query.ray.dir_y[i] = query.ray.dir_z[i] = 0;
    query.ray.tfar[i] = -kInfinity;
  }
  intersect16(valid, embree_->scene(), query);
  unsigned others = 0;  // of geometries that do not number their parts as the mesh does
  for (int i = 0; i < 16; ++i) {
    const std::uint32_t t = query.hit.primID[i];
    const bool is_hit = t != kMiss;
    hits.triangle[i] = t;
    hits.u[i] = is_hit ? query.hit.u[i] : 0;  // callers hand these on without a look
    hits.v[i] = is_hit ? query.hit.v[i] : 0;
    hits.distance[i] = query.ray.tfar[i];
    others |= is_hit ? query.hit.geomID[i] ^ EmbreeTree::kTriangles : 0;
  }
  for (int i = 0; i < count; ++i)
    if (query.hit.primID[i] < flat_count_) mesh_->prefetch(TriangleId(query.hit.primID[i]));
  read_flat_hits(faces_.data(), rays, hits);
  for (int i = 0; others != 0 && i < count; ++i) {
    const std::uint32_t t = query.hit.primID[i];
    if (t == kMiss || query.hit.geomID[i] == EmbreeTree::kTriangles) continue;
    Hit hit;
    const float height = read_hit(query.hit.geomID[i], t, query.hit.u[i], query.hit.v[i], query.ray.tfar[i],
                                  rays.origin(i), rays.direction(i), hit);
    hits.cosine[i] = std::fabs(height);
    hits.triangle[i] = static_cast<std::uint32_t>(hit.triangle.index());
    hits.u[i] = hit.u;
    hits.v[i] = hit.v;
    hits.front[i] = hit.front;
    hits.near_edge[i] = std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < edge_share(hit.triangle);
  }
}

/// Unit direction in the plane of a flat triangle from the edge opposite to a corner towards it, and how far
/// the corner is from that edge. A triangle without area has neither.
Vec3f RayTracer::into_triangle(TriangleId t, int corner_number, float& height) const {
  const Vec3f& from = corner(t, (corner_number + 1) % 3);
  const Vec3f edge = corner(t, (corner_number + 2) % 3) - from;
  const Vec3f up = corner(t, corner_number) - from;
  const float length2 = edge.squaredNorm();
  const Vec3f across = length2 > 0 ? Vec3f(up - (up.dot(edge) / length2) * edge) : up;
  height = across.norm();
  return height > 0 ? Vec3f(across / height) : Vec3f(Vec3f::Zero());
}

unsigned RayTracer::edges_near(std::uint32_t triangle, float u, float v) const {
  const float weight[3] = {1 - u - v, u, v};
  unsigned edges = 0;
  for (int k = 0; k < 3; ++k) {
    float height = 0;
    into_triangle(TriangleId(triangle), k, height);
    if (weight[k] * height < kEdgeWidth) edges |= 1U << k;
  }
  return edges;
}

Vec3f RayTracer::second_direction(const Vec3f& direction, std::uint32_t triangle, float u, float v) const {
  if (triangle == kMiss || is_curved(TriangleId(triangle))) return turned(direction);
  const unsigned edges = edges_near(triangle, u, v);
  Vec3f turn = Vec3f::Zero();
  for (int k = 0; k < 3; ++k) {
    if ((edges >> k & 1U) == 0) continue;
    float height = 0;
    const Vec3f inwards = into_triangle(TriangleId(triangle), k, height);
    // Across the edge as the ray sees it, however flat it comes.
    const Vec3f across = direction.cross(inwards.cross(faces_[triangle].normal));
    const float length = across.norm();
    if (length > 0) turn += (across.dot(inwards) < 0 ? -1 : 1) / length * across;
  }
  // Away from all edges, or near to all of them, there is no way inwards.
  constexpr float kNowhere = 0.1F;
  if (turn.norm() < kNowhere) return turned(direction);
  return (direction + kTurn * turn).normalized();
}

void RayTracer::look_again16(const Ray16& rays, int count, Hit16& hits) const {
  Ray16 doubtful;
  int lanes[16];
  int doubtful_count = 0;
  for (int i = 0; i < count; ++i) {
    if (!is_doubtful(hits.triangle[i], hits.u[i], hits.v[i], hits.front[i])) continue;
    doubtful.set(doubtful_count, rays.origin(i), second_direction(rays.direction(i), hits, i),
                 cut_out_key(rays, i));
    lanes[doubtful_count++] = i;
  }
  if (doubtful_count == 0) return;
  Hit16 again;
  closest16(doubtful, doubtful_count, again);
  for (int k = 0; k < doubtful_count; ++k) {
    const int i = lanes[k];
    // A back is believed when it is met again, and an edge when the ray would get lost.
    if (hits.triangle[i] != kMiss && is_lost(again.triangle[k], again.front[k])) continue;
    hits.triangle[i] = again.triangle[k];
    hits.u[i] = again.u[k];
    hits.v[i] = again.v[k];
    hits.distance[i] = again.distance[k];
    hits.cosine[i] = again.cosine[k];
    hits.front[i] = again.front[k];
    hits.near_edge[i] = again.near_edge[k];
  }
}

bool RayTracer::first_on_way(const Vec3f& origin, const Vec3f& direction, float distance, Hit& hit,
                             std::uint32_t chance) const {
  const float far = shortened(distance);
  if (!nearest(origin, direction, far, cut_out_key(origin, direction, chance), hit)) return false;
  // From within, curved shapes are met sooner than the ray origins on them.
  return !is_curved(hit.triangle) || hit.distance < far - static_cast<float>(ShapeTarget::kSooner);
}

bool RayTracer::visible(const Vec3f& from, const Vec3f& to, std::uint32_t chance) const {
  const Vec3f d = to - from;
  const float distance = d.norm();
  if (!(distance > 0)) return true;
  const Vec3f direction = d / distance;
  RTCRay ray = make_ray(from, direction, 0, shortened(distance), cut_out_key(from, direction, chance));
  occluded1(embree_->scene(), ray);
  return ray.tfar >= 0;
}

bool RayTracer::escapes(const Vec3f& origin, const Vec3f& direction, std::uint32_t chance) const {
  const std::uint32_t key = cut_out_key(origin, direction, chance);
  RTCRay ray = make_ray(origin, direction, 0, kInfinity, key);
  occluded1(embree_->scene(), ray);
  if (ray.tfar < 0) return false;
  if (!misses_are_doubtful_) return true;
  ray = make_ray(origin, turned(direction), 0, kInfinity, key);
  occluded1(embree_->scene(), ray);
  return ray.tfar >= 0;
}

}  // namespace reemit
