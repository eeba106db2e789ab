#include "solver/losses/opening_losses.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <variant>

#include "scenes/model/opening_reach.h"
#include "solver/emit/photometric_emitter.h"
#include "solver/losses/probe_flight.h"
#include "solver/shoot/emission.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerLight = 4096;
constexpr std::uint32_t kLeastPacketsPerLight = 256;
constexpr std::uint32_t kMostPackets = 1U << 19;
constexpr double kLeastLoss = 1e-3;

/// Where a light shines out of: what lies between a point of the opening and here parts the point from the
/// room. Nothing for lights at infinity.
struct MouthOf {
  const RayScene& rays;

  std::optional<Vec3f> operator()(const PointLight& l) const { return rays.normalised(l.position); }
  std::optional<Vec3f> operator()(const SpotLight& l) const { return rays.normalised(l.position); }
  std::optional<Vec3f> operator()(const DirectionalLight&) const { return std::nullopt; }
  std::optional<Vec3f> operator()(const PhotometricLight& l) const {
    const Vec3 aim = main_direction(*l.table);
    const double reach = opening_reach(l.opening, aim) / rays.metres_per_unit() + PhotometricEmitter::kClear;
    return (rays.normalised(l.position).cast<double>() + l.orientation * (reach * aim)).cast<float>();
  }

  /// Mean direction of the light, or the nadir where it goes to all sides alike; luminaire coordinates.
  static Vec3 main_direction(const IntensityTable& table) {
    constexpr int kSteps = 64;
    constexpr double kAllSidesAlike = 0.02;
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < 2 * kSteps; ++j) {
        const double z = 1 - (2 * i + 1.0) / kSteps;
        const double azimuth = std::numbers::pi * (j + 0.5) / kSteps;
        const double r = std::sqrt(1 - z * z);
        const Vec3 direction(r * std::cos(azimuth), r * std::sin(azimuth), z);
        const double candela = table.intensity(direction);
        sum += candela * direction;
        total += candela;
      }
    return sum.norm() > kAllSidesAlike * total ? Vec3(sum.normalized()) : Vec3(0, 0, -1);
  }
};

/// The surface between two points, if there is one.
std::optional<SurfaceId> between(const TransportScene& transport, const Vec3f& from, const Vec3f& to) {
  const Vec3f way = to - from;
  const float distance = way.norm();
  if (!(distance > RayScene::kLift) || transport.rays().visible(from, to)) return std::nullopt;
  Hit hit;
  if (!transport.rays().closest(from, way / distance, hit) || hit.distance > distance) return std::nullopt;
  return transport.mesh().triangle(hit.triangle).surface;
}

/// A face that a light stands on, closer than rays can tell apart, with its normal.
struct Contact {
  SurfaceId surface;
  Vec3f normal;
};
constexpr float kTouching = 4 * RayScene::kLift;

std::optional<Contact> contact_at(const TransportScene& transport, const Vec3f& point) {
  for (int k = 0; k < 3; ++k) {
    const Vec3f axis = Vec3f::Unit(k);
    Hit hit;
    if (!transport.rays().closest(point - kTouching * axis, axis, hit) || hit.distance > 2 * kTouching)
      continue;
    return Contact{transport.mesh().triangle(hit.triangle).surface,
                   transport.rays().normal(hit.triangle, hit.u, hit.v)};
  }
  return std::nullopt;
}

/// Books where the packets of one light end.
class OpeningBooks {
 public:
  OpeningBooks(const TransportScene& transport, const PunctualLight& light, const Vec3f& mouth)
      : transport_(transport), mouth_(mouth) {
    if (!std::holds_alternative<PhotometricLight>(light)) contact_ = contact_at(transport, mouth);
  }

  void add(const ProbeRay& probe) {
    ++packets_;
    std::optional<SurfaceId> cutter = between(transport_, probe.origin, mouth_);
    const SurfaceId met = probe.met ? transport_.mesh().triangle(probe.hit.triangle).surface : SurfaceId();
    if (contact_ && probe.direction.dot(contact_->normal) < 0) {
      if (probe.met && probe.hit.front && met == contact_->surface && probe.hit.distance < kTouching) {
        ++touching_;
        return;
      }
      cutter = contact_->surface;
    }
    if (cutter) {
      ++beyond_;
      ++takers_[*cutter];
    } else if (probe.met && is_back(transport_, probe.hit)) {
      ++on_backs_;
      ++takers_[met];
    } else if (probe.met) {
      ++seen_;
    }
  }

  OpeningLoss loss(std::uint32_t light) const {
    const auto share = [&](std::uint32_t count) { return static_cast<double>(count) / packets_; };
    OpeningLoss loss{light,          share(on_backs_ + beyond_),
                     share(beyond_), share(touching_),
                     share(seen_),   contact_ ? contact_->surface : SurfaceId()};
    if (!contact_ && !takers_.empty())
      loss.surface = std::max_element(takers_.begin(), takers_.end(), [](const auto& a, const auto& b) {
                       return a.second < b.second;
                     })->first;
    return loss;
  }

 private:
  const TransportScene& transport_;
  Vec3f mouth_;
  std::optional<Contact> contact_;
  std::map<SurfaceId, std::uint32_t> takers_;
  std::uint32_t packets_ = 0, on_backs_ = 0, beyond_ = 0, touching_ = 0, seen_ = 0;
};

OpeningLoss loss_of(const TransportScene& transport, std::uint32_t light, const Vec3f& mouth,
                    std::uint32_t packets) {
  const PunctualLight& source = transport.scene().lights[light];
  OpeningBooks books(transport, source, mouth);
  const SobolSequence numbers(light);
  Ray16 rays;
  for (std::uint32_t first = 0; first < packets; first += 16) {
    UniformLanes x;
    for (int d = 0; d < 4; ++d) numbers.sample16(first, d, x.u[d]);
    for (int lane = 0; lane < 16; ++lane)
      start_light_ray(source, transport.rays(), x.u[0][lane], x.u[1][lane], x.u[2][lane], x.u[3][lane], rays,
                      lane);
    trace_probes(transport.rays(), rays, 16, [&](int, const ProbeRay& probe) { books.add(probe); });
  }
  return books.loss(light);
}

}  // namespace

std::vector<OpeningLoss> opening_losses(const TransportScene& transport) {
  const std::vector<PunctualLight>& lights = transport.scene().lights;
  std::vector<OpeningLoss> losses;
  if (lights.empty()) return losses;
  const auto packets = std::clamp(static_cast<std::uint32_t>(kMostPackets / lights.size()),
                                  kLeastPacketsPerLight, kPacketsPerLight);
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const std::optional<Vec3f> mouth = std::visit(MouthOf{transport.rays()}, lights[l]);
    if (!mouth) continue;
    const OpeningLoss loss = loss_of(transport, static_cast<std::uint32_t>(l), *mouth, packets);
    if (loss.lost > kLeastLoss || loss.touching > 0) losses.push_back(loss);
  }
  return losses;
}

}  // namespace reemit
