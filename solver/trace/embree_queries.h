#pragma once
#include "solver/trace/embree_tree.h"

namespace reemit {

// The calls of Embree 3 and 4, which differ in whether they want a context.

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

inline RTCRay make_ray(const Vec3f& origin, const Vec3f& direction, float near, float far,
                       std::uint32_t key) {
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
  ray.id = key;
  return ray;
}

inline void intersect1(RTCScene scene, RTCRayHit& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
#endif
}

inline void intersect16(const int* valid, RTCScene scene, RTCRayHit16& rays) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect16(valid, scene, &rays);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect16(valid, scene, &context, &rays);
#endif
}

inline void occluded1(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

/// With a context for filters.
inline void occluded1(RTCScene scene, RTCRay& ray, QueryContext& context) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
#else
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

inline void occluded16(const int* valid, RTCScene scene, RTCRay16& rays) {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded16(valid, scene, &rays);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid, scene, &context, &rays);
#endif
}

}  // namespace reemit
