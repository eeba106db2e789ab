#include "solver/gather/caustic_photons.h"

#include <cmath>
#include <utility>

namespace reemit {

bool CausticPhotons::is_on_face(std::uint32_t i, const Place& place, float radius) const {
  if (in_air) return triangles[i] == place.triangle;
  constexpr float kFlat = 0.15F;
  const Vec3f way = places[i] - place.at;
  return normals[i].dot(place.normal) > kSameFace && std::fabs(way.dot(place.normal)) < kFlat * radius &&
         is_level(place.normal, normals[i], way);
}

void CausticPhotons::append(const CausticPhotons& more) {
  places.insert(places.end(), more.places.begin(), more.places.end());
  normals.insert(normals.end(), more.normals.begin(), more.normals.end());
  triangles.insert(triangles.end(), more.triangles.begin(), more.triangles.end());
  luminaires.insert(luminaires.end(), more.luminaires.begin(), more.luminaires.end());
  power.insert(power.end(), more.power.begin(), more.power.end());
  radius_codes.insert(radius_codes.end(), more.radius_codes.begin(), more.radius_codes.end());
}

CausticPhotons mean_of(std::vector<CausticPhotons> estimates) {
  if (estimates.size() == 1) return std::move(estimates.front());
  CausticPhotons mean;
  if (!estimates.empty()) mean.in_air = estimates.front().in_air;
  for (const CausticPhotons& estimate : estimates) mean.append(estimate);
  for (float& watts : mean.power) watts /= static_cast<float>(estimates.size());
  return mean;
}

}  // namespace reemit
