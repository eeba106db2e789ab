#include "solver/losses/luminaire_warnings.h"

#include <utility>
#include <variant>

#include <fmt/format.h>

#include "solver/losses/lamp_losses.h"
#include "solver/losses/opening_losses.h"
#include "solver/losses/probe_flight.h"

namespace reemit {
namespace {

std::string name_of(const PunctualLight& light, std::size_t index) {
  const std::string& name = std::visit([](const auto& l) -> const std::string& { return l.name; }, light);
  return name.empty() ? fmt::format("light {}", index + 1) : "light '" + name + "'";
}

std::string warning_of(const OpeningLoss& loss, const Scene& scene) {
  const PunctualLight& light = scene.lights[loss.light];
  const std::string name = name_of(light, loss.light);
  if (loss.meets_nothing)
    return fmt::format(
        "{}: its light meets nothing; is it outside of the room, or its position in other units?", name);
  const std::string surface = quoted_name(scene, loss.surface);
  if (loss.is_shut_in)
    return fmt::format("{}: none of its light gets out of {}, which is closed around it; move it", name,
                       surface);
  if (loss.touching > 0) {
    const std::string lost =
        loss.lost > 0 ? fmt::format("{} of its light is lost and ", share_text(loss.lost)) : "";
    return fmt::format("{} lies in {}: {}{} of its light falls on the very point it stands on; move it off",
                       name, surface, lost, share_text(loss.touching));
  }
  const std::string lost = fmt::format("{}: {} of its light is lost, because ", name, share_text(loss.lost));
  const bool crosses = 2 * loss.beyond > loss.lost;
  if (loss.seen <= 0) return lost + fmt::format("it lies in or behind {}; move it", surface);
  if (!crosses) return lost + fmt::format("it ends on the back of {}; turn or thicken the surface", surface);
  if (!std::holds_alternative<PhotometricLight>(light))
    return lost + fmt::format("it lies in {}; move it off", surface);
  const Vec3 size = std::get<PhotometricLight>(light).opening.size();
  if (size.maxCoeff() > bounds(scene).size().maxCoeff())
    return lost +
           fmt::format(
               "its opening of {:.3g} x {:.3g} m is larger than the room; is the unit of its file right?",
               size.x(), size.y());
  return lost + fmt::format(
                    "its opening lies across {}; in a native room, \"mount\": \"ceiling\" or \"wall\" keeps "
                    "it on one side",
                    surface);
}

/// Of a room that is as good as dark; empty of others.
std::string faintness_warning(const PacketRoom& transport, const PacketSources& emission) {
  constexpr double kStarlight = 1e-6;  // [W/m2], some 2e-4 lx
  double watts = 0;
  for (std::size_t s = 0; s < emission.sources.size(); ++s) watts += emission.watts_of(s);
  const ZoneMesh& mesh = transport.mesh();
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) area += mesh.triangle_area(TriangleId(t));
  if (!(watts > 0) || watts >= kStarlight * area) return "";
  return fmt::format(
      "all luminaires together send out {:.3g} W, {:.1g} W on a square metre of the surfaces: less than "
      "starlight. Are their strengths in other units, or is a luminaire missing?",
      watts, watts / area);
}

}  // namespace

std::vector<std::string> luminaire_warnings(const PacketRoom& transport, const PacketSources& emission,
                                            const StopToken* stop) {
  const Scene& scene = transport.scene();
  std::vector<std::string> warnings;
  if (std::string faint = faintness_warning(transport, emission); !faint.empty())
    warnings.push_back(std::move(faint));
  for (const OpeningLoss& loss : opening_losses(transport, stop)) warnings.push_back(warning_of(loss, scene));
  for (const LampLoss& lamp : lamp_losses(transport, emission, stop)) {
    const std::string name = fmt::format(
        "luminaire {}{}", quoted_name(scene, lamp.surfaces[0]),
        lamp.surfaces.size() > 1 ? fmt::format(" with {} more surface(s)", lamp.surfaces.size() - 1) : "");
    if (lamp.shines_onto_itself)
      warnings.push_back(
          fmt::format("{}: {} of its power shines onto the lamp itself; a closed lamp should emit from its "
                      "outer side only",
                      name, share_text(lamp.onto_itself)));
    if (lamp.stands_across)
      warnings.push_back(
          fmt::format("{}: {} of its power leaves from parts that see nothing but the open outside; does it "
                      "stand through a ceiling or a wall? Move it in, or let only what is in the room emit",
                      name, share_text(lamp.outside)));
  }
  return warnings;
}

std::vector<std::string> luminaire_warnings(const Scene& scene, const ZoneMesh& mesh) {
  const Room room(scene, mesh);
  const PacketRoom transport(room);
  return luminaire_warnings(transport, collect_packet_sources(transport));
}

}  // namespace reemit
