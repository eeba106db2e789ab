#include "solver/shoot/specular_packets.h"

#include <algorithm>
#include <array>

namespace reemit {
namespace {

/// What a step makes of direct light.
LightPart part_of(const SpecularStep& step) {
  if (step.way == SpecularWayOn::kDiffuse) return LightPart::kIndirect;
  return step.bends ? LightPart::kCaustic : LightPart::kDirect;
}

}  // namespace

SpecularPackets::SpecularPackets(const BatchTask& task, BatchBooks& books)
    : rays_(task.transport.rays()),
      surfaces_(task.transport.surface_model()),
      mesh_(task.transport.mesh()),
      books_(books),
      rng_(task.settings.seed, RngPurpose::kSpecular),
      batch_(task.batch),
      any_(surfaces_.any_specular()),
      channels_(task.transport.channels()),
      way_(channels_.bands()),
      power_(channels_.count()) {}

void SpecularPackets::draw_bits(const CounterRng& rng, const PacketBlock& block, std::uint32_t step,
                                BitLanes& bits) const {
  rng.bits4x16(block.id, batch_, step, bits);
  if (!any_) return;
  for (int lane = 0; lane < block.count; ++lane) {
    if (block.way[lane].steps == 0) continue;
    const std::array<std::uint32_t, 4> own = rng.bits4(number_of(block, lane), batch_, step);
    for (std::size_t k = 0; k < 4; ++k) bits.word[k][lane] = own[k];
  }
}

std::uint32_t SpecularPackets::lanes(const PacketBlock& block, const Hit16& hits) const {
  std::uint32_t lanes = 0;
  for (int lane = 0; lane < block.count; ++lane) {
    if (hits.triangle[lane] == RayTracer::kMiss) continue;
    const bool any = surfaces_.is_specular_or_inside(TriangleId(hits.triangle[lane]), hits.front[lane]) ||
                     block.way[lane].body.valid();
    lanes |= (any ? 1U : 0U) << lane;
  }
  return lanes;
}

void SpecularPackets::attenuate(const SpecularWay& way, const Hit16& hits, int lane,
                                std::int64_t* power) const {
  const TriangleId body = surfaces_.body_around(TriangleId(hits.triangle[lane]), hits.front[lane], way.body);
  if (!body.valid()) return;
  const std::size_t account = mesh_.triangle(body).surface.index() * channels_.count();
  channels_.for_each([&](std::size_t c, std::size_t band) {
    const float share = surfaces_.specular(body).left_inside(band, hits.distance[lane]);
    const std::int64_t left = share_of(power[c], static_cast<double>(share));
    book(books_.absorbed[account + c], power[c] - left);
    power[c] = left;
  });
}

float SpecularPackets::chances(const Hit16& hits, int lane) {
  const TriangleId t(hits.triangle[lane]);
  if (!surfaces_.is_specular(t, hits.front[lane])) return 0;
  const float cosine = hits.cosine[lane];
  return cosine > 0 ? surfaces_.specular(t).shares(cosine, hits.front[lane], way_) : 0;
}

void SpecularPackets::carry_on(const PacketBlock& block, const Hit16& hits, int lane, std::uint32_t step,
                               WaitingPackets& next) {
  if (!surfaces_.is_specular(TriangleId(hits.triangle[lane]), hits.front[lane])) return;
  const std::array<float, 4> u = rng_.uniform4(number_of(block, lane), batch_, step);
  carry_on(block, hits, lane, u[0], {u[1], u[2]}, 1, next);
}

void SpecularPackets::carry_on(const PacketBlock& block, const Hit16& hits, int lane, std::uint32_t step,
                               float u, float most, WaitingPackets& next) {
  std::array<float, 2> spread{};
  if (surfaces_.specular(TriangleId(hits.triangle[lane])).is_spread()) {
    const std::array<float, 4> numbers = rng_.uniform4(number_of(block, lane), batch_, step);
    spread = {numbers[1], numbers[2]};
  }
  carry_on(block, hits, lane, u, spread, most, next);
}

void SpecularPackets::carry_on(const PacketBlock& block, const Hit16& hits, int lane, float u,
                               const std::array<float, 2>& spread, float most, WaitingPackets& next) {
  const TriangleId t(hits.triangle[lane]);
  const SpecularSurface& specular = surfaces_.specular(t);
  const float most_shares = specular.most_shares(hits.cosine[lane]);
  if (most_shares <= most && u >= most_shares) return;  // as most packets end
  SurfacePoint x = surface_point(rays_, t, hits.u[lane], hits.v[lane], hits.front[lane]);
  x.towards = -block.rays.direction(lane);
  if (!specular.choose(x, u, spread, Survival::kRoulette, way_, most)) return;
  const std::size_t values = channels_.count();
  const std::int64_t* power = &block.power[static_cast<std::size_t>(lane) * values];
  const std::size_t surface = mesh_.triangle(t).surface.index();
  bool jumps = false;
  const bool is_in_glass = specular.is_body() && !hits.front[lane];
  const bool ends = block.way[lane].steps + 1 >= (is_in_glass ? kMostStepsInGlass : kMostSteps);
  channels_.for_each([&](std::size_t c, std::size_t band) {
    power_[c] =
        share_of(power[c], static_cast<double>(way_.share()[band]) / static_cast<double>(way_.chance));
    if (power_[c] == 0) return;
    jumps = jumps || static_cast<double>(power_[c]) > kUsualRoulette * static_cast<double>(power[c]);
    book(books_.absorbed[surface * values + c], -power_[c]);
    if (ends) book(books_.unshot[c], power_[c]);
  });
  if (jumps) count_event(books_.events.roulette_jumps);
  if (ends) return;
  const Vec3f origin = rays_.ray_origin(t, x.u, x.v, way_.front);
  if (rays_.starts_behind(t, way_.front, origin)) count_event(books_.events.starts_behind);
  next.add(origin, way_.direction, block.id[lane],
           {block.way[lane].steps + 1, std::max(block.way[lane].part, part_of(way_)),
            surfaces_.body_beyond(t, way_.front, block.way[lane].body)},
           power_.data());
}

}  // namespace reemit
