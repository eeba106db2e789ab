#include "viewer_export/still/tile_renderer.h"

#include <algorithm>
#include <bit>
#include <numbers>
#include <utility>
#include <vector>

#include "solver/gather/gather_batch.h"
#include "solver/gather/zone_bias_estimate.h"
#include "solver/reflect/lambert.h"
#include "viewer_export/still/pixel_groups.h"

namespace reemit {

/// What a camera ray stands for, in pixels: textures are averaged over as much of what it sees. Below 1 since
/// a pixel has several rays, which do the rest.
constexpr double kSpot = 0.5;
/// Both ways on from glass are seen for so many steps where the eye looks at it; further on one of them is
/// chosen, and what is faint ends by roulette.
constexpr std::uint32_t kSplitSteps = 2;

/// One replicate of one pixel while a block is rendered.
struct TileRenderer::PixelSums {
  PointSampler sampler;
  std::uint64_t index;      // of the pixel in the picture
  std::uint32_t batch = 0;  // of the random numbers
  std::uint32_t part = 0;   // of the zone solution
  std::uint32_t parts = 1;  // from there on, whose mean zones are read; gather rays read the first
  Integrator integrator;
  float share;  // 1 / samples
  float* direct;
  float* indirect;
  float* albedo;
  float* caustic;              // null where the room bends no light
  std::vector<float>* weight;  // scratch, one per band
  PixelBlock found;
  bool sees_luminaire = false;  // the sample at hand
};

std::vector<std::uint32_t> Tile::pixels(int width) const {
  std::vector<std::uint32_t> pixels;
  pixels.reserve(static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0));
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) pixels.push_back(static_cast<std::uint32_t>(y * width + x));
  return pixels;
}

std::vector<Tile> tiles_of(int width, int height) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += Tile::kSize)
    for (int x = 0; x < width; x += Tile::kSize)
      tiles.push_back({x, y, std::min(x + Tile::kSize, width), std::min(y + Tile::kSize, height)});
  return tiles;
}

TileRenderer::TileRenderer(const StillLight& light, const PinholeCamera& camera, const StopToken& stop)
    : light_(light),
      room_(&light.room()),
      camera_(&camera),
      settings_(&light.settings()),
      stop_(&stop),
      field_(light.field()),
      direct_(light.direct()),
      specular_(settings_->seed, RngPurpose::kSpecularCamera, RngPurpose::kSpreadCamera),
      has_caustics_(room_->scene().bends_light()),
      all_(room_->band_count(), 1.0F) {}

PointSampler TileRenderer::sampler_of(std::uint32_t pixel, std::uint32_t width, int replicate,
                                      const SampleBlock& block) const {
  if (block.first + block.samples > block.shared)
    return {settings_->seed, RngPurpose::kPixel, pixel, replicate, block.log2_samples};
  return {settings_->seed, RngPurpose::kPixelGroup, place_in_group(pixel % width, pixel / width), replicate,
          std::countr_zero(static_cast<unsigned>(block.shared))};
}

TileRenderer::PixelSums TileRenderer::sums_into(float* values, std::uint64_t pixel,
                                                const PointSampler& sampler, int samples,
                                                std::vector<float>& weight) const {
  const std::size_t bands = field_.band_count();
  float* const indirect = values + bands;
  float* const albedo = indirect + bands;
  float* const caustic = has_caustics_ ? albedo + bands : nullptr;
  return {
      .sampler = sampler,
      .index = pixel,
      .integrator = settings_->integrator,
      .share = 1.0F / static_cast<float>(samples),
      .direct = values,
      .indirect = indirect,
      .albedo = albedo,
      .caustic = caustic,
      .weight = &weight,
      .found = {
          .direct = values, .indirect = indirect, .caustic = caustic, .albedo = albedo, .samples = samples}};
}

void TileRenderer::render(std::span<const std::uint32_t> pixels, const SampleBlock& block, Film& film) const {
  const std::size_t bands = field_.band_count();
  const auto width = static_cast<std::uint32_t>(film.image().width);
  const int last_replicate = block.first_replicate + block.replicates;
  const std::size_t stride = layers() * bands;
  std::vector<float> values(stride * pixels.size() * static_cast<std::size_t>(block.replicates), 0.0F);
  std::vector<float> weight(bands);
  std::vector<PixelBlock> found;
  found.reserve(pixels.size() * static_cast<std::size_t>(block.replicates));
  GatherBatch batch(light_.gather(), settings_->gathers);
  float* next = values.data();
  for (const std::uint32_t pixel : pixels) {
    const std::uint32_t column = pixel % width;
    const std::uint32_t row = pixel / width;
    for (int r = block.first_replicate; r < last_replicate; ++r, next += stride) {
      if (stop_->requested()) return;
      PixelSums sums = sums_into(next, pixel, sampler_of(pixel, width, r, block), block.samples, weight);
      sums.batch = static_cast<std::uint32_t>(block.first * static_cast<int>(Film::kReplicates) + r);
      sums.part = static_cast<std::uint32_t>(r) % static_cast<std::uint32_t>(field_.parts());
      sums.found.earlier = block.first;
      for (int s = block.first; s < block.first + block.samples; ++s) {
        const std::array<float, 2> u = sums.sampler.place(s);
        add_sample(column + 0.5 + sample_filter(settings_->filter, u[0]),
                   row + 0.5 + sample_filter(settings_->filter, u[1]), s, sums, batch);
      }
      found.push_back(sums.found);
    }
  }
  batch.flush();
  auto next_found = found.begin();
  for (const std::uint32_t pixel : pixels)
    for (int r = block.first_replicate; r < last_replicate; ++r)
      film.add(pixel, static_cast<std::size_t>(r), *next_found++);
}

void TileRenderer::fill_with_zones(const Tile& tile, int width, Film& film) const {
  const std::size_t bands = field_.band_count();
  std::vector<float> values(layers() * bands);
  std::vector<float> weight(bands);
  GatherBatch batch(light_.gather(), settings_->gathers);
  const auto pixel_at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(film.image().width) +
           static_cast<std::size_t>(x);
  };
  for (int y0 = tile.y0; y0 < tile.y1; y0 += width)
    for (int x0 = tile.x0; x0 < tile.x1; x0 += width) {
      const int x1 = std::min(x0 + width, tile.x1);
      const int y1 = std::min(y0 + width, tile.y1);
      const std::size_t pixel = pixel_at(x0, y0);
      std::fill(values.begin(), values.end(), 0.0F);
      PixelSums sums = sums_into(values.data(), pixel,
                                 PointSampler(settings_->seed, RngPurpose::kPixel, pixel, 0, 0), 1, weight);
      sums.parts = static_cast<std::uint32_t>(field_.parts());
      sums.integrator = Integrator::kZones;
      add_sample(0.5 * (x0 + x1), 0.5 * (y0 + y1), 0, sums, batch);
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) film.add(pixel_at(x, y), 0, sums.found);
    }
}

void TileRenderer::add_sample(double x, double y, int sample, PixelSums& sums, GatherBatch& batch) const {
  const PinholeCamera::Ray ray = camera_->ray(x, y);
  Hit hit;
  const RayTracer& rays = room_->rays();
  if (!rays.closest_for_camera(ray.origin, ray.direction, hit)) {
    add_sky(ray.direction, sums);
    return;
  }
  const std::size_t bands = field_.band_count();
  const SurfaceModel& surfaces = room_->surfaces();
  SurfacePoint point = seen_point(hit, ray.direction);
  point.footprint = spot_at(ray.skipped + static_cast<double>(hit.distance));
  sums.found.normal += point.normal.cast<double>();
  sums.found.depth += (ray.skipped + static_cast<double>(hit.distance)) * rays.metres_per_unit();
  ++sums.found.seen;

  SurfaceModel::PointValues at_point;
  const float* reflectance = surfaces.reflectance(point, at_point);
  for (std::size_t b = 0; b < bands; ++b) sums.albedo[b] += sums.share * reflectance[b];
  sums.sees_luminaire = surfaces.emits(hit.triangle, hit.front);
  add_seen(point, all_.data(), 1, sample, sums, batch);
  if (surfaces.is_specular(hit.triangle, hit.front)) {
    ++sums.found.mirroring;
    add_over_mirrors(point, hit.distance, sample, sums, batch);
  }
  if (sums.sees_luminaire) ++sums.found.luminous;
}

void TileRenderer::add_sky(const Vec3f& along, PixelSums& sums) const {
  if (room_->sky() == nullptr) return;
  std::vector<float>& weight = *sums.weight;
  std::fill(weight.begin(), weight.end(), sums.share);
  room_->sky()->add_seen(along, weight.data(), sums.direct);
}

void TileRenderer::add_sky_over_mirrors(const Vec3f& along, float pdf_per_sr, const float* through,
                                        PixelSums& sums) const {
  const SkyLight* sky = room_->sky();
  if (sky == nullptr) return;
  const bool is_shared = pdf_per_sr > 0 && sums.integrator != Integrator::kZones;
  const float found = is_shared ? sky->sky_found_by_lobe(along, pdf_per_sr) : 1;
  const float* radiance = sky->radiance(along);
  const float* sun = sky->sun_radiance(along);
  const float found_of_sun = is_shared && sun != nullptr ? sky->sun_found_by_lobe(pdf_per_sr) : 1;
  for (std::size_t b = 0; b < field_.band_count(); ++b) {
    sums.direct[b] += sums.share * through[b] * found * radiance[b];
    if (sun != nullptr) sums.direct[b] += sums.share * through[b] * found_of_sun * sun[b];
  }
}

/// A mirror, gloss or glass that is looked at, after others or not.
struct TileRenderer::Look {
  SurfacePoint x;
  std::vector<float> through;
  std::uint32_t steps;
  TriangleId body;   // of glass that was looked into
  float pdf_per_sr;  // of the ray from a lobe that still goes straight, as of SpecularPath; else 0
  float way;         // from there
};

std::optional<TileRenderer::Look> TileRenderer::follow(const Look& from, const SpecularStep& step, int sample,
                                                       PixelSums& sums, GatherBatch& batch) const {
  const RayTracer& rays = room_->rays();
  const SurfaceModel& surfaces = room_->surfaces();
  // What a lobe about a shading normal sends into the surface is lost.
  if (!(step.direction.dot(side_normal(rays, from.x.triangle, from.x.u, from.x.v, step.front)) > 0))
    return {};
  Hit hit;
  if (!rays.closest(rays.ray_origin(from.x.triangle, from.x.u, from.x.v, step.front), step.direction, hit)) {
    std::vector<float> through = from.through;
    for (std::size_t b = 0; b < through.size(); ++b) through[b] *= step.share()[b] / step.chance;
    add_sky_over_mirrors(step.direction, step.bends ? step.pdf_per_sr : from.pdf_per_sr, through.data(),
                         sums);
    return {};
  }
  Look next{seen_point(hit, step.direction),
            from.through,
            from.steps + 1,
            surfaces.body_beyond(from.x.triangle, step.front, from.body),
            step.bends ? step.pdf_per_sr : from.pdf_per_sr,
            hit.distance};
  if (!step.bends) next.way += from.way;
  next.x.footprint = from.x.footprint + spot_at(static_cast<double>(hit.distance));
  const bool is_shared = next.pdf_per_sr > 0 && sums.integrator != Integrator::kZones;
  const float found = is_shared ? direct_.found_by_lobe(hit.triangle, next.way, next.pdf_per_sr) : 1;
  for (std::size_t b = 0; b < next.through.size(); ++b) next.through[b] *= step.share()[b] / step.chance;
  surfaces.attenuate(surfaces.body_around(hit.triangle, hit.front, next.body), hit.distance,
                     next.through.data());
  const float inside = surfaces.radiance_outside(next.body);
  if (inside == 1) {
    add_seen(next.x, next.through.data(), found, sample, sums, batch);
  } else {
    std::vector<float> outside = next.through;
    for (float& share : outside) share *= inside;
    add_seen(next.x, outside.data(), found, sample, sums, batch);
  }
  // Patterns and luminaires behind a pane or in a mirror are part of what is seen.
  if (next.pdf_per_sr == 0 && next.steps <= kSplitSteps) {
    sums.sees_luminaire = sums.sees_luminaire || surfaces.emits(hit.triangle, hit.front);
    SurfaceModel::PointValues at_point;
    const float* reflectance = surfaces.reflectance(next.x, at_point);
    for (std::size_t b = 0; b < next.through.size(); ++b)
      sums.albedo[b] += sums.share * next.through[b] * reflectance[b];
  }
  if (!surfaces.is_specular(hit.triangle, hit.front)) return {};
  return next;
}

void TileRenderer::add_over_mirrors(SurfacePoint x, float way, int sample, PixelSums& sums,
                                    GatherBatch& batch) const {
  constexpr std::uint32_t kCertainSteps = 5;
  const RayTracer& rays = room_->rays();
  const SurfaceModel& surfaces = room_->surfaces();
  const PathKey key{sums.index, sums.batch, static_cast<std::uint32_t>(sample - sums.found.earlier), 0};
  SpecularStep step(field_.band_count());
  step.diffuse_way = DiffuseWay::kNotFollowed;  // add_light does
  std::uint32_t numbers = 0;
  std::vector<Look> looks;
  looks.push_back({x, all_, 0, {}, 0, 0});
  surfaces.attenuate(surfaces.body_around(x.triangle, x.front, {}), way, looks.back().through.data());
  const auto look_on = [&](const Look& from) {
    if (std::optional<Look> next = follow(from, step, sample, sums, batch)) looks.push_back(std::move(*next));
  };
  while (!looks.empty() && numbers < SpecularNumbers::kMostSteps) {
    Look look = std::move(looks.back());
    looks.pop_back();
    const SpecularSurface& surface = surfaces.specular(look.x.triangle);
    // Over a shading normal the mirror direction may point into the surface, or the eye lie below.
    const Vec3f normal = side_normal(rays, look.x);
    const Vec3f& n = look.x.normal;
    const Vec3f mirrored = 2 * n.dot(look.x.towards) * n - look.x.towards;
    if (!(n.dot(look.x.towards) > 0 && mirrored.dot(normal) > 0)) look.x.normal = normal;
    if (surfaces.spreads(look.x.triangle) && sums.integrator != Integrator::kZones)
      add_highlights(look.x, look.through.data(), sample, sums);
    std::array<float, 2> spread{};
    if (look.steps < kSplitSteps) {
      for (const SpecularWayOn way_on : {SpecularWayOn::kMirror, SpecularWayOn::kAcross}) {
        if (surface.is_spread()) spread = specular_.spread(key, numbers++);
        if (surface.take(look.x, way_on, spread, step)) look_on(look);
      }
      continue;
    }
    const Survival survival = look.steps < kCertainSteps ? Survival::kCertain : Survival::kRoulette;
    if (surface.is_spread()) spread = specular_.spread(key, numbers);
    if (surface.choose(look.x, specular_.at(key, numbers++), spread, survival, step)) look_on(look);
  }
}

void TileRenderer::add_seen(const SurfacePoint& x, const float* through, float found, int sample,
                            PixelSums& sums, GatherBatch& batch) const {
  const std::size_t bands = field_.band_count();
  const SurfaceModel& surfaces = room_->surfaces();
  SurfaceModel::PointValues at_point;
  const float* emitted = surfaces.emitted(x, at_point);
  const float towards_eye = std::fabs(room_->rays().normal(x.triangle, x.u, x.v).dot(x.towards));
  const float emission = found * sums.share * surfaces.emission_shape(x.triangle, towards_eye);
  for (std::size_t b = 0; b < bands; ++b) sums.direct[b] += emission * emitted[b] * through[b];
  if (sums.integrator != Integrator::kZones) {
    add_light(x, through, sample, sums, batch);
    return;
  }
  const ZoneId zone = room_->mesh().zone_at(x.triangle, x.u, x.v, x.front);
  const float* direct = field_.reflected_direct(zone);
  const float* caustic = field_.reflected_caustic(zone);
  const float share_of_part = sums.share / static_cast<float>(sums.parts);
  for (std::uint32_t part = sums.part; part < sums.part + sums.parts; ++part) {
    const float* all = field_.reflected(zone, part);
    for (std::size_t b = 0; b < bands; ++b)
      sums.indirect[b] += share_of_part * (all[b] - direct[b] - caustic[b]) * through[b];
  }
  for (std::size_t b = 0; b < bands; ++b) sums.direct[b] += sums.share * direct[b] * through[b];
  if (sums.caustic == nullptr) return;
  for (std::size_t b = 0; b < bands; ++b) sums.caustic[b] += sums.share * caustic[b] * through[b];
}

void TileRenderer::add_highlights(const SurfacePoint& x, const float* through, int sample,
                                  PixelSums& sums) const {
  const int shadow_rays = settings_->light_samples;
  std::vector<float>& weight = *sums.weight;
  for (std::size_t b = 0; b < field_.band_count(); ++b)
    weight[b] = sums.share / static_cast<float>(shadow_rays) * through[b];
  for (int i = 0; i < shadow_rays; ++i)
    direct_.add_lobe_sample(x, sums.sampler.light(sample, i, shadow_rays), {}, DiffuseWay::kNotFollowed,
                            weight.data(), {sums.direct, sums.direct});
}

void TileRenderer::add_light(const SurfacePoint& x, const float* through, int sample, PixelSums& sums,
                             GatherBatch& batch) const {
  const SurfaceModel& surfaces = room_->surfaces();
  SurfaceModel::PointValues at_point;
  add_scattered(x, surfaces.reflectance(x, at_point), sums.index, through, sample, sums, batch);
  if (!surfaces.is_specular(x.triangle, x.front) || !surfaces.specular(x.triangle).diffuses()) return;
  constexpr std::uint64_t kOfOtherSides = std::uint64_t{1} << 40;  // random numbers that no pixel has
  SurfacePoint behind = x;
  behind.front = !x.front;
  behind.normal = -x.normal;
  add_scattered(behind, surfaces.specular(x.triangle).diffuse_transmittance().data(),
                sums.index + kOfOtherSides, through, sample, sums, batch);
}

void TileRenderer::add_scattered(const SurfacePoint& x, const float* share, std::uint64_t index,
                                 const float* through, int sample, PixelSums& sums,
                                 GatherBatch& batch) const {
  const std::size_t bands = field_.band_count();
  if (std::all_of(share, share + bands, [](float s) { return s == 0; })) return;
  std::vector<float>& weight = *sums.weight;

  const int shadow_rays = settings_->light_samples;
  for (std::size_t b = 0; b < bands; ++b)
    weight[b] = lambert_brdf_per_sr(share[b]) * sums.share / static_cast<float>(shadow_rays) * through[b];
  const auto shadow = [&](int i) { return sums.sampler.light(sample, i, shadow_rays); };
  direct_.add_samples(x, shadow_rays, shadow, weight.data(), sums.direct);

  // Scattered radiance is share/pi times pi times the mean radiance over cosine-distributed rays.
  const bool path = settings_->integrator == Integrator::kPath;
  const int gathers = path ? 1 : settings_->gathers;
  const auto weigh_ray = [&] {
    for (std::size_t b = 0; b < bands; ++b)
      weight[b] = share[b] * sums.share / static_cast<float>(gathers) * through[b];
  };
  weigh_ray();
  if (!path && batch.aims()) {
    const auto number = static_cast<std::uint32_t>(sample - sums.found.earlier);
    batch.aim(x, sums.sampler.bright(sample), {index, sums.batch, number, sums.part}, weight.data(),
              sums.indirect, sums.caustic);
  }
  for (int i = 0; i < gathers; ++i) {
    const std::array<float, 2> u = sums.sampler.hemisphere(sample, i, gathers);
    const auto ray = static_cast<std::uint32_t>((sample - sums.found.earlier) * gathers + i);
    const PathKey key{index, sums.batch, ray, sums.part};
    if (path) {
      weigh_ray();  // it is used up
      light_.path().add_indirect(x, u[0], u[1], key, weight.data(), sums.indirect, sums.caustic);
    } else {
      batch.add(x, u[0], u[1], key, weight.data(), sums.indirect, sums.caustic);
    }
  }
}

std::optional<ZoneBias> TileRenderer::zone_bias(const Film& film) const {
  if (settings_->integrator == Integrator::kPath) return ZoneBias{};
  if (settings_->integrator == Integrator::kZones) {
    const std::optional<double>& known = light_.solution().record.discretisation;
    return known ? std::optional(ZoneBias{*known, *known}) : std::nullopt;
  }
  const StillImage& image = film.image();
  const std::size_t bands = field_.band_count();
  const auto pixels = static_cast<double>(image.pixel_count());
  std::vector<double> floor(bands, 0.0);
  double camera_rays = 0;
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    camera_rays += static_cast<double>(image.samples[p]);
    for (std::size_t b = 0; b < bands; ++b) floor[b] += settings_->error_floor * film.radiance(p, b) / pixels;
  }
  std::vector<SurfacePoint> points;
  std::vector<double> scale;
  // The groups are the quarters of the picture.
  const PointSampler sampler(settings_->seed, RngPurpose::kZoneBias, 0, ZoneSums::kGroups,
                             std::countr_zero(ZoneBiasEffort::kPointsPerGroup));
  for (std::size_t i = 0; i < ZoneBiasEffort::kPoints; ++i) {
    const std::size_t quarter = i / ZoneBiasEffort::kPointsPerGroup;
    const std::array<float, 2> u = sampler.place(static_cast<int>(i % ZoneBiasEffort::kPointsPerGroup));
    const double x = 0.5 * (static_cast<double>(quarter % 2) + static_cast<double>(u[0])) * image.width;
    const std::size_t row = quarter / 2;
    const double y = 0.5 * (static_cast<double>(row) + static_cast<double>(u[1])) * image.height;
    const PinholeCamera::Ray ray = camera_->ray(x, y);
    Hit hit;
    const bool seen = room_->rays().closest_for_camera(ray.origin, ray.direction, hit);
    // Where nothing is seen there is no bias either; any point does for the place in the list.
    points.push_back(seen ? seen_point(hit, ray.direction) : SurfacePoint{TriangleId(0)});
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
    for (std::size_t b = 0; b < bands; ++b) {
      const double radiance = film.radiance(pixel, b) + floor[b];
      scale.push_back(seen && radiance > 0 ? 1 / radiance : 0);
    }
  }
  const std::optional<ZoneBias> bias =
      estimate_zone_bias(light_.gather(), light_.path(), points, scale,
                         ZoneBiasEffort::of(camera_rays * (2 + settings_->gathers)), settings_->seed, stop_);
  if (stop_->requested()) return std::nullopt;
  return bias;
}

float TileRenderer::spot_at(double way) const {
  return static_cast<float>(kSpot * camera_->pixel_width() * way);
}

SurfacePoint TileRenderer::seen_point(const Hit& hit, const Vec3f& direction) const {
  const RayTracer& rays = room_->rays();
  SurfacePoint point = surface_point(rays, hit, direction);
  const BaseMesh& base = room_->mesh().base();
  const BaseTriangle& triangle = room_->mesh().triangle(hit.triangle);
  if (triangle.is_curved() || triangle.normal[0] == BaseTriangle::kFlat) return point;
  const auto corner = [&](std::size_t k) {
    const std::uint32_t n = triangle.normal[k];
    return n == BaseTriangle::kFlat ? rays.normal(hit.triangle) : Vec3f(base.normals[n].cast<float>());
  };
  Vec3f shading = (1 - hit.u - hit.v) * corner(0) + hit.u * corner(1) + hit.v * corner(2);
  if (!hit.front) shading = -shading;
  const float length = shading.norm();
  // A shading normal that points into the surface is an error of the room; the true one is safe.
  if (length > 0 && shading.dot(point.normal) > 0) point.normal = shading / length;
  return point;
}

}  // namespace reemit
