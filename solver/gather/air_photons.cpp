#include "solver/gather/air_photons.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <tbb/parallel_for.h>

#include "solver/sampling/warp.h"

namespace reemit {
namespace {

/// Radii that gains are found for are a quarter of an octave apart.
constexpr int kCodesPerStep = 6;

}  // namespace

AirPhotons::AirPhotons(const Room& room, std::span<const MeasuringPoint> points, const AirSheets& sheets,
                       std::vector<CausticPhotons> parts)
    : room_(&room), gains_(points.size()), parts_(parts.size()) {
  for (std::size_t i = 0; i < points.size(); ++i) sheet_.push_back(sheets.sheet_of(i));
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) { gains_[i] = gains_at(points[i]); });
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t p) {
    parts_[p].all = std::move(parts[p]);
    parts_[p].grids = grids_by_radius(parts_[p].all);
  });
}

AirPhotons::Gains AirPhotons::gains_at(const MeasuringPoint& x) const {
  constexpr int kLooks = 128;
  constexpr int kLeastLooks = 8;  // that tell more than how many there are
  constexpr int kMostSteps = 256 / kCodesPerStep + 1;
  const Frame frame(x.normal);
  Gains gains;
  for (int step = 0; step < kMostSteps; ++step) {
    const float radius = photon_radius(static_cast<std::uint8_t>(std::min(step * kCodesPerStep, 255)));
    int open = 0;
    Eigen::Matrix3f moments = Eigen::Matrix3f::Zero();  // of what is open
    for (int i = 0; i < kLooks; ++i) {
      // As the kernel has it: the squared radius within which a share u of it lies is 1 - sqrt(1 - u).
      const float r = std::sqrt(1 - std::sqrt(1 - (static_cast<float>(i) + 0.5F) / kLooks));
      const double turns = static_cast<double>(i) * (std::numbers::phi - 1);
      const auto angle = static_cast<float>(2 * std::numbers::pi * (turns - std::floor(turns)));
      const Vec3f aside(r * std::cos(angle), r * std::sin(angle), 0);
      if (!room_->rays().visible(x.place, x.place + radius * frame.to_world(aside))) continue;
      ++open;
      const Gain place(1, aside.x(), aside.y());
      moments += place * place.transpose() / kLooks;
    }
    if (open == kLooks && gains.empty()) break;
    Gain gain = Gain::Zero();
    if (open == kLooks)
      gain[0] = 1;
    else if (open >= kLeastLooks)
      gain = moments.ldlt().solve(Gain(1, 0, 0));
    else if (open > 0)
      gain[0] = 1 / moments(0, 0);
    gains.push_back(gain);
    // Smaller kernels lie within.
    if (open == kLooks) break;
  }
  return gains;
}

AirPhotons::Gain AirPhotons::gain_of(const Gains& gains, std::uint8_t code) {
  const std::size_t step = code / kCodesPerStep;
  if (step + 1 >= gains.size()) return gains.back();
  const float share = static_cast<float>(code % kCodesPerStep) / kCodesPerStep;
  return (1 - share) * gains[step] + share * gains[step + 1];
}

void AirPhotons::add_irradiance(const MeasuringPoint& x, std::size_t part,
                                std::span<const float> left_to_rays, const float* weight, float* sum) const {
  if (parts_.empty() || x.number == MeasuringPoint::kNoNumber) return;
  const Photons& photons = parts_[part % parts_.size()];
  const TriangleId sheet(sheet_[x.number]);
  const Gains& gains = gains_[x.number];
  const std::size_t bands = room_->band_count();
  const auto metres = static_cast<float>(room_->rays().metres_per_unit());
  const Frame frame(x.normal);
  for (std::size_t level = 0; level < kRadiusLevels; ++level) {
    photons.grids[level].visit(x.place, radius_of_level(level), [&](std::uint32_t i, float d2) {
      const std::uint8_t code = photons.all.radius_codes[i];
      const float radius = photon_radius(code);
      if (d2 >= radius * radius || photons.all.triangles[i] != sheet) return;
      float gain = 1;
      if (!gains.empty()) {
        const Vec3f& place = photons.all.places[i];
        if (!room_->rays().visible(x.place, place)) return;
        const Vec3f aside = frame.to_local(place - x.place) / radius;
        gain = gain_of(gains, code).dot(Gain(1, aside.x(), aside.y()));
      }
      const SurfaceId luminaire = photons.all.luminaires[i];
      const float share = luminaire.valid() ? 1 - left_to_rays[luminaire.index()] : 1;
      const float per_m2 = gain * share * photon_kernel(d2, radius) / (metres * metres);
      for (std::size_t b = 0; b < bands; ++b) sum[b] += weight[b] * per_m2 * photons.all.power[i * bands + b];
    });
  }
}

}  // namespace reemit
