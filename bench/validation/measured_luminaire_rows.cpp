#include <optional>
#include <stdexcept>

#include "bench/validation/code_room.h"
#include "bench/validation/families.h"
#include "bench/validation/point_gather.h"
#include "scenes/io/photometry/ies_reader.h"
#include "solver/room/room.h"
#include "solver/sampling/warp.h"

namespace reemit::validation {
namespace {

/// A luminaire that hangs at height h above a large black triangle in z = 0 and is aimed straight down, with
/// 1 W/sr per candela, so that irradiances are in lx.
class Hanging {
 public:
  Hanging(const MeasuredLuminaire& luminaire, double height) {
    room_.add("receiver", room_.paint(0),
              Polygon{Vec3(kReach, -kReach, 0), Vec3(0, 2 * kReach, 0), Vec3(-kReach, -kReach, 0)});
    PhotometricLight light;
    light.name = luminaire.name;
    light.position = Vec3(0, 0, height);
    light.table = luminaire.table;
    light.opening = luminaire.opening;
    light.intensity_per_candela = Spectrum::Ones(1);
    room_.scene().lights.push_back(light);
    mesh_.emplace(room_.exact_zones());
  }

  const Scene& scene() const { return room_.scene(); }
  const ZoneMesh& mesh() const { return mesh_->mesh; }

  SurfacePoint place(const RayTracer& rays, double x, double y) const {
    // p = a + u (b - a) + v (c - a) for the corners above.
    const double v = (kReach - x - (y + kReach) / 3) / (2 * kReach);
    const double u = (y + kReach) / (3 * kReach);
    return surface_point(rays, TriangleId(0), static_cast<float>(u), static_cast<float>(v), true);
  }

 private:
  static constexpr double kReach = 8;
  CodeRoom room_;
  std::optional<MeshResult> mesh_;
};

/// Area mean over a disk about the foot of the luminaire.
Estimates mean_on_disk(const Hanging& room, const Room& walls, double radius, const std::string& id,
                       const Effort& effort) {
  const DirectLight direct(walls);
  int samples = 64;
  while (samples < 4096 * effort.work) samples *= 2;
  Estimates estimates;
  for (std::uint64_t replicate = 0; replicate < SolvedRoom::kReplicates; ++replicate) {
    const SobolSequence numbers(seed_of(id) + replicate);
    float sum = 0;
    const float weight = 1 / static_cast<float>(samples);
    for (int k = 0; k < samples; ++k) {
      const auto at = [&](int dimension) { return numbers.sample(static_cast<std::uint32_t>(k), dimension); };
      const Point2 d = sample_disk(at(3), at(4));
      direct.add_sample(
          room.place(walls.rays(), radius * static_cast<double>(d.x), radius * static_cast<double>(d.y)),
          {at(0), at(1), at(2)}, &weight, &sum);
    }
    estimates.push_back(static_cast<double>(sum));
  }
  return estimates;
}

}  // namespace

std::vector<ValidationRow> evaluate_measured_luminaires(const std::vector<ReferenceCase>& cases,
                                                        const Effort& effort) {
  constexpr double kClosedForm = 1e-13;
  constexpr int kSamples = 16;  // a point luminaire: all samples are the same
  std::vector<ValidationRow> rows;
  for (const ReferenceCase& c : cases) {
    const std::string file = c.parameters.at("file");
    const MeasuredLuminaire luminaire =
        read_ies_file(REEMIT_SOURCE_DIR "/bench/validation/luminaires/" + file);
    const Hanging room(luminaire, c.parameters.at("h"));
    const Room walls(room.scene(), room.mesh());
    for (const ReferenceValue& v : c.values) {
      if (v.quantity == "total_flux_lm") {
        rows.push_back(make_row(c, v, "closed form",
                                Estimates(SolvedRoom::kReplicates, luminaire.table->total_flux()),
                                kClosedForm));
      } else if (v.point) {
        rows.push_back(make_row(c, v, "direct light",
                                direct_irradiance(walls, room.place(walls.rays(), v.point->x(), v.point->y()),
                                                  kSamples, seed_of(v.id)),
                                kPointBound));
      } else if (v.quantity == "E_mean_disk") {
        rows.push_back(make_row(c, v, "direct light",
                                mean_on_disk(room, walls, c.parameters.at("disk_radius"), v.id, effort),
                                kPointBound));
      } else {
        throw std::invalid_argument("unknown quantity " + v.quantity);
      }
    }
  }
  return rows;
}

}  // namespace reemit::validation
