#include "solver/emit/punctual_emitter.h"

#include <stdexcept>
#include <type_traits>

namespace reemit {
namespace {

template <class Light, class Emitters>
struct EmitterFor;
template <class Light, class First, class... Rest>
struct EmitterFor<Light, std::variant<First, Rest...>>
    : std::conditional_t<std::is_same_v<typename First::Light, Light>, std::type_identity<First>,
                         EmitterFor<Light, std::variant<Rest...>>> {};
template <class Light>
struct EmitterFor<Light, std::variant<>> {};

/// The kind of emitter of a kind of light.
template <class Light>
using EmitterOf = typename EmitterFor<Light, PunctualEmitter>::type;

/// What only lights that are somewhere in the room have.
template <class Result, class Ask>
Result of_place(const PunctualEmitter& emitter, Ask&& ask) {
  return std::visit(
      [&]<class Emitter>(const Emitter& e) -> Result {
        if constexpr (Emitter::kAtInfinity)
          throw std::logic_error("asked for the place of a light that is nowhere in the room");
        else
          return ask(e);
      },
      emitter);
}

}  // namespace

PunctualEmitter make_punctual_emitter(const PunctualLight& light, const RayTracer& rays) {
  return std::visit([&]<class Light>(const Light& l) -> PunctualEmitter { return EmitterOf<Light>(l, rays); },
                    light);
}

const Spectrum& strength_of(const PunctualLight& light) {
  return std::visit(
      []<class Light>(const Light& l) -> const Spectrum& { return EmitterOf<Light>::strength(l); }, light);
}

Spectrum light_power(const PunctualLight& light, double metres_per_unit) {
  return std::visit([&]<class Light>(const Light& l) { return EmitterOf<Light>::power(l, metres_per_unit); },
                    light);
}

bool is_at_infinity(const PunctualLight& light) {
  return std::visit([]<class Light>(const Light&) { return EmitterOf<Light>::kAtInfinity; }, light);
}

LuminaireBounds bounds_of_light(const PunctualEmitter& emitter, float strength) {
  return of_place<LuminaireBounds>(emitter, [&](const auto& e) { return e.bounds(strength); });
}

Vec3f mouth_of_light(const PunctualEmitter& emitter) {
  return of_place<Vec3f>(emitter, [](const auto& e) { return e.mouth(); });
}

}  // namespace reemit
