#include "solver/losses/opening_losses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <variant>

#include "scenes/model/opening_reach.h"
#include "solver/emit/light_places.h"
#include "solver/emit/punctual_emitter.h"
#include "solver/losses/probe_flight.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerLight = 4096;
constexpr std::uint32_t kLeastPacketsPerLight = 64;
constexpr std::uint32_t kMostOpeningPackets = 1U << 19;
constexpr double kLeastLoss = 1e-3;
/// A luminaire that lights only a closed space less than this thin is in a piece of furniture, a plenum or
/// its own housing.
constexpr float kThinMetres = 0.5F;
constexpr float kThinShare = 0.25F;  // of the least extent of the room

/// The surface between two points, if there is one.
std::optional<SurfaceId> between(const PacketRoom& transport, const Vec3f& from, const Vec3f& to) {
  const Vec3f way = to - from;
  const float distance = way.norm();
  if (!(distance > RayTracer::kLift) || transport.rays().visible(from, to)) return std::nullopt;
  Hit hit;
  if (!transport.rays().closest(from, way / distance, hit) || hit.distance > distance) return std::nullopt;
  return transport.mesh().surface(hit.triangle, hit.front);
}

/// From a light that was moved before a face, how far away that is met.
constexpr float kTouching = 200 * static_cast<float>(kLightClearance);

/// The surface that a light was moved off; none if it was not.
std::optional<SurfaceId> surface_moved_off(const PacketRoom& transport, const Vec3f& from, const Vec3f& to) {
  Hit hit;
  if (from == to || !transport.rays().closest(to, (from - to).normalized(), hit)) return std::nullopt;
  return transport.mesh().surface(hit.triangle, hit.front);
}

/// Looks from both sides of the faces that a light meets. One outside of a room meets faces with the open
/// before them and the room behind them.
class SideLooks {
 public:
  SideLooks(const RayTracer& rays, const SurfaceModel& surfaces)
      : rays_(rays), surfaces_(surfaces), numbers_(0) {}

  void look(const Hit& hit) {
    constexpr std::uint32_t kMostLooks = 256;
    if (looks_ == kMostLooks) return;
    const Vec3f local = sample_cosine_hemisphere(numbers_.sample(looks_, 0), numbers_.sample(looks_, 1));
    ++looks_;
    const Vec3f front = rays_.normal(hit.triangle, hit.u, hit.v);
    const auto is_open = [&](bool side) {
      const Frame frame(side ? front : Vec3f(-front));
      return rays_.escapes(rays_.ray_origin(hit.triangle, hit.u, hit.v, side), frame.to_world(local));
    };
    if (is_open(hit.front)) ++open_before_;
    if (is_open(!hit.front)) ++open_behind_;
    const Frame frame(hit.front ? front : Vec3f(-front));
    note_lit(hit);
    Hit next;
    if (rays_.closest(rays_.ray_origin(hit.triangle, hit.u, hit.v, hit.front), frame.to_world(local), next))
      note_lit(next);
  }

  bool outside_of_a_room() const {
    return looks_ > 0 && 2 * open_before_ >= looks_ && 20 * open_behind_ <= looks_;
  }
  /// The light and what follows it from where it is reflected stay in a space thinner than this
  /// [normalised].
  bool within_thin_space(float thickness) const {
    return looks_ > 0 && open_before_ == 0 && !lets_light_through_ && lit_.sizes().minCoeff() < thickness;
  }

 private:
  void note_lit(const Hit& hit) {
    lit_.extend(rays_.point(hit.triangle, hit.u, hit.v));
    if (surfaces_.any_specular() && surfaces_.is_specular(hit.triangle, hit.front) &&
        surfaces_.specular(hit.triangle).lets_light_through())
      lets_light_through_ = true;
  }

  const RayTracer& rays_;
  const SurfaceModel& surfaces_;
  Eigen::AlignedBox3f lit_;
  bool lets_light_through_ = false;
  SobolSequence numbers_;
  std::uint32_t looks_ = 0, open_before_ = 0, open_behind_ = 0;
};

/// Books where the packets of one light end.
class OpeningBooks {
 public:
  /// `thin` [normalised]: of spaces that a luminaire should not be shut in. `contact`: what it stands on.
  OpeningBooks(const PacketRoom& transport, const Vec3f& mouth, float thin,
               const std::optional<SurfaceId>& contact)
      : transport_(transport),
        mouth_(mouth),
        thin_(thin),
        contact_(contact),
        looks_(transport.rays(), transport.surface_model()) {}

  void add(const ProbeRay& probe) {
    ++packets_;
    const std::optional<SurfaceId> cutter = between(transport_, probe.origin, mouth_);
    const SurfaceId met =
        probe.met ? transport_.mesh().surface(probe.hit.triangle, probe.hit.front) : SurfaceId();
    if (contact_ && probe.met && probe.hit.distance < kTouching && !is_back(transport_, probe.hit)) {
      ++touching_;
    } else if (cutter) {
      ++beyond_;
      ++takers_[*cutter];
    } else if (probe.met && is_back(transport_, probe.hit)) {
      ++on_backs_;
      ++takers_[met];
    } else if (probe.met) {
      ++seen_;
      ++seers_[met];
      looks_.look(probe.hit);
    }
  }

  OpeningLoss loss(std::uint32_t light) const {
    const auto share = [&](std::uint32_t count) { return static_cast<double>(count) / packets_; };
    OpeningLoss loss{
        light, share(on_backs_ + beyond_), share(beyond_), share(touching_), share(seen_), most_of(takers_)};
    const std::uint32_t met = on_backs_ + beyond_ + touching_ + seen_;
    if (met <= kLeastLoss * packets_) {
      loss.meets_nothing = true;
      loss.lost = 1;
      loss.surface = SurfaceId();
    } else if (contact_) {
      loss.surface = *contact_;
    } else if (met == packets_ && on_backs_ == 0 && looks_.within_thin_space(thin_)) {
      loss.is_shut_in = true;
      loss.lost = 1;
      loss.surface = most_of(seers_);
    } else if (looks_.outside_of_a_room()) {
      loss.lost = 1;
      loss.seen = 0;
      loss.surface = most_of(seers_);
    }
    return loss;
  }

 private:
  using Counts = std::map<SurfaceId, std::uint32_t>;
  static SurfaceId most_of(const Counts& counts) {
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == counts.end() ? SurfaceId() : most->first;
  }

  const PacketRoom& transport_;
  Vec3f mouth_;
  float thin_;
  std::optional<SurfaceId> contact_;
  SideLooks looks_;
  Counts takers_, seers_;
  std::uint32_t packets_ = 0, on_backs_ = 0, beyond_ = 0, touching_ = 0, seen_ = 0;
};

OpeningLoss loss_of(const PacketRoom& transport, std::uint32_t light, const PunctualEmitter& emitter,
                    const std::optional<SurfaceId>& contact, float thin, std::uint32_t packets) {
  OpeningBooks books(transport, mouth_of_light(emitter), thin, contact);
  const SobolSequence numbers(light);
  Ray16 rays;
  for (std::uint32_t first = 0; first < packets; first += 16) {
    UniformLanes x;
    for (int d = 0; d < 4; ++d) numbers.sample16(first, d, x.u[d]);
    std::array<LightRay, 16> starts;
    start_light_rays(emitter, {x.u[0], x.u[1], x.u[2], x.u[3]}, starts);
    for (int lane = 0; lane < 16; ++lane) {
      const LightRay& start = starts[static_cast<std::size_t>(lane)];
      rays.set(lane, start.origin, start.direction);
    }
    trace_probes(transport.rays(), rays, 16, [&](int, const ProbeRay& probe) { books.add(probe); });
  }
  return books.loss(light);
}

}  // namespace

std::vector<OpeningLoss> opening_losses(const PacketRoom& transport, const StopToken* stop) {
  const std::vector<PunctualLight>& lights = transport.scene().lights;
  std::vector<OpeningLoss> losses;
  if (lights.empty()) return losses;
  const auto packets = std::clamp(static_cast<std::uint32_t>(kMostOpeningPackets / lights.size()),
                                  kLeastPacketsPerLight, kPacketsPerLight);
  const auto metres = static_cast<float>(transport.rays().metres_per_unit());
  const auto least_extent = static_cast<float>(bounds(transport.scene()).size().minCoeff()) / metres;
  const float thin = std::min(kThinMetres / metres, kThinShare * least_extent);
  const std::vector<PunctualLight> before_faces = lights_before_faces(transport.scene(), transport.rays());
  for (std::size_t l = 0; l < lights.size(); ++l) {
    end_if_requested(stop);
    // Where it is meant to be: an opening that is cut by a face loses what lies beyond. A lamp without size
    // stands before the face that it lies in, and what it sends towards that lands on it around the lamp.
    const PunctualEmitter meant = make_punctual_emitter(lights[l], transport.rays());
    if (is_at_infinity(meant)) continue;
    const bool has_size = std::holds_alternative<PhotometricLight>(lights[l]);
    const PunctualEmitter emitter =
        has_size ? meant : make_punctual_emitter(before_faces[l], transport.rays());
    const std::optional<SurfaceId> contact =
        surface_moved_off(transport, mouth_of_light(meant), mouth_of_light(emitter));
    const OpeningLoss loss =
        loss_of(transport, static_cast<std::uint32_t>(l), emitter, contact, thin, packets);
    if (loss.lost > kLeastLoss || loss.touching > 0) losses.push_back(loss);
  }
  return losses;
}

}  // namespace reemit
