#include "solver/sky/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <tbb/task_arena.h>

#include "solver/sky/sky_survey.h"

namespace reemit {
namespace {

using std::numbers::pi;
/// Shadow rays that are drawn by brightness alone, whatever the survey says: it may have missed a gap.
constexpr double kBlind = 0.25;
/// Packets that go where the survey found no use for them.
constexpr double kUndirected = 0.1;
/// Cells of packets that the useful light is divided into, about.
constexpr double kCells = 768;
/// A view with less sky than this needs no more light than one with this much.
constexpr double kLeastOpen = 0.01;

Vec3 half_extent(const ZoneMesh& mesh, const RayTracer& rays) {
  Vec3 extent(0, 0, 0);
  const auto add = [&](const Vec3& point) {
    extent = extent.cwiseMax(rays.normalised_double(point).cwiseAbs());
  };
  for (std::size_t t = 0; t < mesh.flat_count(); ++t)
    for (int k = 0; k < 3; ++k) add(mesh.corner(TriangleId(t), k));
  for (std::size_t s = 0; s < mesh.curved().size(); ++s) {
    const auto [low, high] = shape_bounds(mesh.curved()[s].shape());
    add(low);
    add(high);
  }
  return extent;
}

const Sky& sky_of(const Scene& scene) {
  if (!scene.sky || scene.sky->up.isZero())
    throw std::invalid_argument("the sky of the scene has no directions: place_sky");
  return *scene.sky;
}

double open_or_least(double open) {
  return std::max(kLeastOpen, open);
}

double worth_of(const std::vector<UsefulLight>& light) {
  double sum = 0;
  for (const UsefulLight& l : light) sum += static_cast<double>(l.worth);
  return sum;
}

}  // namespace

SkyLight::SkyLight(const Scene& scene, const ZoneMesh& mesh, const RayTracer& rays,
                   const SurfaceModel& surfaces)
    : sky_(&sky_of(scene)),
      mesh_(&mesh),
      rays_(&rays),
      surfaces_(&surfaces),
      table_(*sky_, scene.bands),
      box_(SkyBox::around(half_extent(mesh, rays), sky_->up)) {
  if (sky_->sun_shines()) {
    beam_.emplace(sky_->towards_sun(), sky_->sun->half_angle, box_);
    sun_irradiance_ = sky_->sun->irradiance;
    const double projected = pi * std::pow(std::sin(sky_->sun->half_angle), 2);
    for (const double e : sun_irradiance_) sun_radiance_.push_back(static_cast<float>(e / projected));
  }
  if (sky_->ground_reflectance.size() > 0) ground_ = ground_radiance(*sky_, scene.bands);
  if (table_.empty()) return;
  if (!table_.is_coloured()) {
    entries_.emplace_back(table_, box_, std::nullopt);
    entry_spectrum_.push_back(table_.spectrum());
    return;
  }
  for (std::size_t b = 0; b < table_.band_count(); ++b) {
    entries_.emplace_back(table_, box_, b);
    Spectrum alone = Spectrum::Zero(static_cast<Eigen::Index>(table_.band_count()));
    alone[static_cast<Eigen::Index>(b)] = 1;
    entry_spectrum_.push_back(alone);
  }
}

void SkyLight::add_seen(const Vec3f& towards, const float* weight, float* sum) const {
  const std::size_t bands = table_.band_count();
  if (const float* sun = sun_radiance(towards))
    for (std::size_t b = 0; b < bands; ++b) sum[b] += weight[b] * sun[b];
  const Vec3 way = local(towards);
  const float* seen = table_.radiance(table_.cell_of(way));
  if (sky_->kind == SkyKind::kImage && (way.z() >= 0 || ground_.size() == 0)) {
    const SkyImage& image = *sky_->image;
    const double row =
        (0.5 - std::asin(std::clamp(way.z(), -1.0, 1.0)) / pi) * static_cast<double>(image.rows);
    const double column =
        (std::atan2(way.y(), way.x()) / (2 * pi) + 0.5) * static_cast<double>(image.columns);
    seen = image.pixel(std::min(static_cast<std::size_t>(std::max(0.0, row)), image.rows - 1),
                       std::min(static_cast<std::size_t>(std::max(0.0, column)), image.columns - 1), bands);
  }
  for (std::size_t b = 0; b < bands; ++b) sum[b] += weight[b] * seen[b];
}

float SkyLight::sky_found_by_lobe(const Vec3f& towards, float pdf_per_sr) const {
  return pdf_per_sr / (pdf_per_sr + static_cast<float>(table_.pdf_per_sr(cell(towards))));
}

float SkyLight::sun_found_by_lobe(float pdf_per_sr) const {
  return pdf_per_sr / (pdf_per_sr + static_cast<float>(1 / beam_->solid_angle()));
}

float SkyLight::expected_from_sky(const Vec3f& x, const Vec3f& normal) const {
  const SkyView& view = survey().view;
  const double open = std::min(1.0, 2 * open_or_least(view.open_share(view.place_of(x, normal))));
  return static_cast<float>(open * table_.irradiance(local(normal)));
}

float SkyLight::expected_from_sun(const Vec3f& normal) const {
  const double cosine = beam_->axis().dot(normal.cast<double>());
  // The rim of the disk may be above the horizon when its middle is below.
  return static_cast<float>(std::max(cosine + sky_->sun->half_angle > 0 ? 1e-4 : 0.0, cosine));
}

double SkyLight::pdf_per_sr(std::uint32_t place, const Vec3& way) const {
  const double blind = table_.pdf_per_sr(table_.cell_of(way));
  if (!survey().view.sees_sky()) return blind;
  return kBlind * blind + (1 - kBlind) * survey().view.pdf_per_sr(place, way);
}

SkyLight::Sample SkyLight::sample_sky(const Vec3f& x, const Vec3f& normal, float u0, float u1) const {
  const SkyView& view = survey().view;
  const std::uint32_t place = view.place_of(x, normal);
  auto u = static_cast<double>(u0);
  Vec3 way;
  if (!view.sees_sky())
    way = table_.sample(u, static_cast<double>(u1));
  else if (u < kBlind)
    way = table_.sample(u / kBlind, static_cast<double>(u1));
  else
    way = view.sample(place, (u - kBlind) / (1 - kBlind), static_cast<double>(u1));
  Sample sample;
  sample.towards = (table_.to_local().transpose() * way).normalized().cast<float>();
  const double cosine = sample.towards.cast<double>().dot(normal.cast<double>());
  if (!(cosine > 0)) return sample;
  const double density = pdf_per_sr(place, way);
  if (!(density > 0)) return sample;
  sample.factor =
      static_cast<float>(static_cast<double>(table_.brightness(table_.cell_of(way))) * cosine / density);
  return sample;
}

SkyLight::Sample SkyLight::sample_sun(const Vec3f& normal, float u0, float u1) const {
  const Vec3 towards = beam_->sample(static_cast<double>(u0), static_cast<double>(u1));
  const double cosine = towards.dot(normal.cast<double>());
  return {towards.cast<float>(), cosine > 0 ? static_cast<float>(cosine / towards.dot(beam_->axis())) : 0.0F};
}

void SkyLight::colour(const Vec3f& towards, std::vector<float>& by_band) const {
  const SkyTable::Cell at = cell(towards);
  const float* radiance = table_.radiance(at);
  by_band.resize(table_.band_count());
  for (std::size_t b = 0; b < by_band.size(); ++b) {
    const auto mean =
        static_cast<float>(table_.spectrum()[static_cast<Eigen::Index>(b)]) * table_.brightness(at);
    by_band[b] = mean > 0 ? radiance[b] / mean : 0;
  }
}

double SkyLight::flux(std::size_t source) const {
  const double metres2 = rays_->metres_per_unit() * rays_->metres_per_unit();
  if (source == kSunSource) return metres2 * beam_->area() * sun_irradiance_.sum();
  const std::size_t face = source % SkyEntry::kFaces;
  return metres2 * box_.face_area(face) * entries_[source / SkyEntry::kFaces].irradiance(face);
}

Spectrum SkyLight::power(std::size_t cell) const {
  const PacketCell& c = survey().cells[cell];
  const double share = c.numbers.volume() * flux(c.source);
  if (c.source == kSunSource) return share / sun_irradiance_.sum() * sun_irradiance_;
  return share * entry_spectrum_[c.source / SkyEntry::kFaces];
}

SkyRay SkyLight::start(std::size_t cell, float u0, float u1, float u2, float u3) const {
  const PacketCell& c = survey().cells[cell];
  const SkyEntry::Numbers u = c.numbers.at(
      {static_cast<double>(u0), static_cast<double>(u1), static_cast<double>(u2), static_cast<double>(u3)});
  if (c.source == kSunSource) return beam_->start(u);
  return entries_[c.source / SkyEntry::kFaces].start(c.source % SkyEntry::kFaces, u);
}

std::uint8_t SkyLight::need(const Vec3f& x, const Vec3f& normal) const {
  const SkyView& view = survey().view;
  const double open = view.open_share(view.place_of(x, normal));
  return static_cast<std::uint8_t>(
      std::clamp(0.5 / std::max(1e-3, open), 1.0, static_cast<double>(kMostNeed)));
}

const SkyLight::Survey& SkyLight::survey() const {
  // Isolated, so that a thread that waits for others in it does not take up a task that asks for it again.
  std::call_once(surveyed_, [this] { tbb::this_task_arena::isolate([this] { make_survey(); }); });
  return survey_;
}

void SkyLight::make_survey() const {
  survey_ = {};  // of one that memory did not suffice for
  std::vector<std::vector<UsefulLight>> useful = useful_sky();
  std::vector<UsefulLight> of_sun;
  if (beam_) of_sun = useful_sun();
  for (const auto& light : useful) survey_.worth += worth_of(light);
  survey_.worth += worth_of(of_sun);
  double all = 0;
  const auto add = [&](std::size_t source, std::vector<UsefulLight>& light) {
    if (!(flux(source) > 0)) return;
    for (const NumberCell& numbers : divide_numbers(light, survey_.worth / kCells))
      survey_.cells.push_back({source, numbers, 0});
    all += flux(source);
  };
  for (std::size_t s = 0; s < useful.size(); ++s) add(s, useful[s]);
  if (beam_) add(kSunSource, of_sun);
  const double undirected = survey_.worth > 0 ? kUndirected : 1;
  for (PacketCell& c : survey_.cells) {
    c.packets = undirected * c.numbers.volume() * flux(c.source) / all;
    if (survey_.worth > 0) c.packets += (1 - undirected) * c.numbers.worth / survey_.worth;
  }
}

std::vector<std::vector<UsefulLight>> SkyLight::useful_sky() const {
  std::vector<SkySight> sights;
  survey_sky(
      *mesh_, *rays_, *surfaces_, table_.to_local(),
      [this](const Vec3f& towards) { return table_.brightness(cell(towards)); }, survey_.view, sights);
  survey_.view.finish();
  std::vector<std::vector<UsefulLight>> useful(entries_.size() * SkyEntry::kFaces);
  double seen_area = 0;
  double needed = 0;
  for (const SkySight& sight : sights) {
    const double open = open_or_least(survey_.view.open_share(sight.place));
    const double area = square_metres(sight);
    seen_area += area;
    needed += area / open;
    for (std::size_t e = 0; e < entries_.size(); ++e) {
      UsefulLight light{};
      const std::size_t face =
          entries_[e].invert(sight.point.cast<double>(), sight.towards.cast<double>(), light.u);
      const float bright =
          table_.is_coloured() ? radiance(sight.towards)[e] : table_.brightness(cell(sight.towards));
      light.worth = static_cast<float>(pi * area * static_cast<double>(bright) / open);
      if (light.worth > 0) useful[e * SkyEntry::kFaces + face].push_back(light);
    }
  }
  if (seen_area > 0) survey_.mean_need = needed / seen_area;
  return useful;
}

std::vector<UsefulLight> SkyLight::useful_sun() const {
  std::vector<SkySight> sights;
  survey_sun(
      *mesh_, *rays_, *surfaces_,
      [this](float u0, float u1) {
        return Vec3f(beam_->sample(static_cast<double>(u0), static_cast<double>(u1)).cast<float>());
      },
      survey_.view, sights);
  std::vector<UsefulLight> useful;
  for (const SkySight& sight : sights) {
    const double open = open_or_least(survey_.view.open_share(sight.place));
    UsefulLight light{};
    beam_->invert(sight.point.cast<double>(), sight.towards.cast<double>(), light.u);
    light.worth = static_cast<float>(square_metres(sight) * sun_irradiance_.sum() / open);
    useful.push_back(light);
  }
  return useful;
}

double SkyLight::square_metres(const SkySight& sight) const {
  return static_cast<double>(sight.area) * (rays_->metres_per_unit() * rays_->metres_per_unit());
}

std::shared_ptr<const SkyLight> make_sky_light(const Scene& scene, const ZoneMesh& mesh,
                                               const RayTracer& rays, const SurfaceModel& surfaces) {
  if (!scene.sky) return nullptr;
  return std::make_shared<const SkyLight>(scene, mesh, rays, surfaces);
}

}  // namespace reemit
