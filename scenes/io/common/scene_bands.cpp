#include "scenes/io/common/scene_bands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/io/common/sky_image.h"
#include "scenes/io/common/surface_geometry.h"
#include "scenes/model/colour_spectra.h"
#include "scenes/model/error.h"
#include "scenes/model/light_strength.h"
#include "scenes/model/texture_checks.h"
#include "scenes/model/upsampling.h"

namespace reemit {
namespace {

using Rgb = Eigen::Array3d;

Rgb rgb_of(const Spectrum& value) {
  return value.size() == 1 ? Rgb::Constant(value[0]) : Rgb(value);
}

/// The texels of an image, or of the largest of its copies that has no more than some thousand.
std::vector<Texel> overview(const TextureImage& image) {
  constexpr int kMost = 1 << 12;
  if (image.width * image.height > kMost)
    for (const TextureLevel& level : image.levels)
      if (level.width * level.height <= kMost) return level.texels;
  std::vector<Texel> texels;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) texels.push_back(image.texel(x, y));
  return texels;
}

/// To the bands of a grey room.
class ToGrey {
 public:
  Spectrum reflectance(const Rgb& rgb, double /*most*/) { return mean(rgb); }
  Spectrum emission(const Rgb& rgb) { return mean(rgb); }
  Spectrum optical_constant(const Rgb& rgb) { return mean(rgb); }
  void reflectance_textures(Material& material, double /*part*/) {
    if (material.textures.reflectance)
      material.textures.reflectance_factor = mean(rgb_of(material.textures.reflectance_factor));
  }
  void emission_textures(MaterialTextures& textures) {
    if (textures.emission) textures.emission_factor = mean(rgb_of(textures.emission_factor));
  }

 private:
  static Spectrum mean(const Rgb& rgb) {
    const Spectrum weights = BandSet::rgb().efficacy_lm_per_w();
    return Spectrum::Constant(1, (rgb * weights).sum() / weights.sum());
  }
};

/// To the bands of a spectral room.
class ToSpectrum {
 public:
  /// `known`: in equal-energy white, if there are such already.
  ToSpectrum(const BandSet& bands, BandKind from, const Rgb& light,
             std::shared_ptr<const ColourSpectra> known = nullptr)
      : bands_(bands),
        by_luminance_(from == BandKind::kGrey),
        is_white_((light == light[0]).all()),
        upsampling_(bands, light),
        in_white_(std::move(known)) {}

  Spectrum reflectance(const Rgb& rgb, double most) { return noted(upsampling_.reflectance(rgb, most)); }
  Spectrum emission(const Rgb& rgb) { return noted(upsampling_.emission(rgb)); }
  /// Linear between the dominant wavelengths of the primaries, which metal_constants takes as well.
  Spectrum optical_constant(const Rgb& rgb) {
    constexpr double kBlue = 464, kGreen = 549, kRed = 611;  // [nm]
    Spectrum values(static_cast<Eigen::Index>(bands_.count()));
    for (std::size_t i = 0; i < bands_.count(); ++i) {
      const double nm = std::clamp(bands_.centres_nm()[i], kBlue, kRed);
      values[static_cast<Eigen::Index>(i)] = nm < kGreen
                                                 ? std::lerp(rgb[2], rgb[1], (nm - kBlue) / (kGreen - kBlue))
                                                 : std::lerp(rgb[1], rgb[0], (nm - kGreen) / (kRed - kGreen));
    }
    return values;
  }
  /// The colours of its image and of vertices, within a part of the light as reflectance() is. Pre: the
  /// reflectance of the material is still a colour.
  void reflectance_textures(Material& material, double part) {
    MaterialTextures& textures = material.textures;
    const Rgb factor = rgb_of(textures.reflectance ? textures.reflectance_factor : material.reflectance);
    textures.reflectance_factor = Spectrum::Constant(static_cast<Eigen::Index>(bands_.count()), part);
    textures.reflectance_spectra = {in_light(), (factor / part).cast<float>()};
    note_deviation(textures.reflectance, textures.reflectance_spectra);
  }
  /// The colours of its image.
  void emission_textures(MaterialTextures& textures) {
    if (!textures.emission) return;
    // At most half of saturated, as emission() is where the image is 1.
    const Rgb strongest = rgb_of(textures.emission_factor);
    const Rgb twice = Rgb::Constant(std::max(2 * strongest.maxCoeff(), std::numeric_limits<double>::min()));
    textures.emission_factor = upsampling_.emission(twice).values;
    textures.emission_spectra = {in_white(), (strongest / twice).cast<float>()};
    note_deviation(textures.emission, textures.emission_spectra);
  }
  std::shared_ptr<const SkyImage> sky_image(const SkyImage& image) {
    return spectral_sky_image(image, *in_white(), upsampling_.emission(Rgb::Ones()).values);
  }
  double largest_deviation() const { return largest_deviation_; }

 private:
  std::shared_ptr<const ColourSpectra> in_light() {
    if (is_white_ || by_luminance_) return in_white();
    if (!in_light_) in_light_ = std::make_shared<const ColourSpectra>(upsampling_, bands_.count());
    return in_light_;
  }
  std::shared_ptr<const ColourSpectra> in_white() {
    if (!in_white_)
      in_white_ = std::make_shared<const ColourSpectra>(
          by_luminance_ ? ColourSpectra::by_luminance(bands_.count())
                        : ColourSpectra(Upsampling(bands_), bands_.count()));
    return in_white_;
  }
  /// Of some thousand means over an image.
  void note_deviation(const Texture& texture, const TexelSpectra& becomes) {
    if (!texture) return;
    for (const Texel& texel : overview(*texture.image)) {
      std::array<float, 3> rgb;
      for (std::size_t c = 0; c < 3; ++c) rgb[c] = texel[c] * becomes.tint[static_cast<Eigen::Index>(c)];
      largest_deviation_ = std::max(largest_deviation_, becomes.spectra->deviation(rgb));
    }
  }
  Spectrum noted(const Upsampled& upsampled) {
    largest_deviation_ = std::max(largest_deviation_, upsampled.deviation);
    return upsampled.values;
  }

  const BandSet& bands_;
  bool by_luminance_, is_white_;
  Upsampling upsampling_;
  std::shared_ptr<const ColourSpectra> in_light_, in_white_;
  double largest_deviation_ = 0;
};

/// What the brightest texel reflects, of the side that reflects more.
double largest_diffuse(const Material& material) {
  double most = material.largest_reflectance().maxCoeff();
  if (const Texture& image = material.textures.reflectance; image) {
    const Rgb factor = rgb_of(material.textures.reflectance_factor);
    for (std::size_t c = 0; c < 3; ++c)
      most =
          std::max(most, factor[static_cast<Eigen::Index>(c)] * static_cast<double>(image.image->largest[c]));
  }
  return std::min(most, 1.0);
}

/// The shares that all light that meets the surface is split into. Each gets a part of 1 that is in
/// proportion to its largest component; no spectrum leaves its part, so the sum stays below 1 in every band.
/// Where colours are so different that there is no such part, each may reach 1, and the checks of the room
/// take from mirrors and glass what is too much.
template <class To>
void convert_shares(Material& material, bool has_colours, To& to) {
  NonDiffusePart& rest = material.non_diffuse;
  std::vector<Spectrum*> shares{&rest.diffuse_transmittance};
  if (rest.angle_law != AngleLaw::kConductor) shares.push_back(&rest.specular_reflectance);
  if (rest.angle_law != AngleLaw::kDielectric) shares.push_back(&rest.specular_transmittance);
  std::erase_if(shares, [](const Spectrum* s) { return s->size() == 0; });
  const double diffuse = largest_diffuse(material);
  double sum = diffuse;
  for (const Spectrum* share : shares) sum += share->maxCoeff();
  const auto part = [&](double largest) {
    return sum > Material::kAllLight || !(largest > 0) ? 1.0 : largest / sum;
  };
  if (has_colours || material.textures.reflectance) to.reflectance_textures(material, part(diffuse));
  material.reflectance = to.reflectance(rgb_of(material.reflectance), part(diffuse));
  if (material.back_reflectance.size() > 0)
    material.back_reflectance = to.reflectance(rgb_of(material.back_reflectance), part(diffuse));
  for (Spectrum* share : shares) *share = to.reflectance(rgb_of(*share), part(share->maxCoeff()));
}

/// By the transmittance of the length over which the channel that is absorbed most falls to 1/e.
template <class To>
Spectrum converted_absorption(const Spectrum& absorption, To& to) {
  const double most = absorption.maxCoeff();
  if (!(most > 0)) return to.reflectance(Rgb::Zero(), 1);
  return -most * to.reflectance((-rgb_of(absorption) / most).exp(), 1).log();
}

/// `has_colours`: vertices of surfaces of it have.
template <class To>
void convert(Material& material, bool has_colours, To& to) {
  NonDiffusePart& rest = material.non_diffuse;
  convert_shares(material, has_colours, to);
  to.emission_textures(material.textures);
  material.emitted_radiance = to.emission(rgb_of(material.emitted_radiance));
  if (rest.angle_law == AngleLaw::kConductor && rest.specular_reflectance.size() > 0)
    rest.specular_reflectance = to.reflectance(rgb_of(rest.specular_reflectance), 1);
  if (rest.angle_law == AngleLaw::kDielectric && rest.specular_transmittance.size() > 0)
    rest.specular_transmittance = to.reflectance(rgb_of(rest.specular_transmittance), 1);
  if (rest.absorption_per_m.size() > 0)
    rest.absorption_per_m = converted_absorption(rest.absorption_per_m, to);
  for (Spectrum* constant : {&rest.metal_eta, &rest.metal_k})
    if (constant->size() > 0) *constant = to.optical_constant(rgb_of(*constant));
}

void convert_sky(Sky& sky, ToSpectrum& to) {
  for (Spectrum* value : {&sky.irradiance, sky.sun ? &sky.sun->irradiance : nullptr})
    if (value != nullptr && value->size() > 0) *value = to.emission(rgb_of(*value));
  if (sky.image) sky.image = to.sky_image(*sky.image);
  if (sky.ground_reflectance.size() > 0)
    sky.ground_reflectance = to.reflectance(rgb_of(sky.ground_reflectance), 1);
}

/// Flux of a light [W] for each unit of its strength; of directional ones through a sphere around the room.
double flux_per_strength(const PunctualLight& light, const Box& room) {
  if (const auto* spot = std::get_if<SpotLight>(&light))
    return 2 * std::numbers::pi * (1 - std::cos(spot->outer_angle));
  if (const auto* measured = std::get_if<PhotometricLight>(&light)) return measured->table->total_flux();
  if (std::holds_alternative<DirectionalLight>(light))
    return std::numbers::pi / 4 * room.size().squaredNorm();
  return 4 * std::numbers::pi;
}

/// Colour of all that the luminaires of the room send, or 0 if there is none.
Rgb light_of(const Scene& scene) {
  Rgb sum = Rgb::Zero();
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.material_of(surface);
    if (material.emits())
      sum += rgb_of(material.exitance()) * (surface_area(surface) * (material.emits_both_sides ? 2 : 1));
  }
  const Box room = bounds(scene);
  for (const PunctualLight& light : scene.lights)
    sum += rgb_of(strength_of(light)) * flux_per_strength(light, room);
  return sum;
}

}  // namespace

double convert_material(Material& material, const BandSet& from, const Scene& scene) {
  const BandSet& to = scene.bands;
  if (from == to) return 0;
  if (to.kind() == BandKind::kGrey) {
    ToGrey grey;
    convert(material, false, grey);
    return 0;
  }
  const bool has_colours = material.textures.reflectance || material.textures.emission;
  ToSpectrum spectrum(to, from.kind(), Rgb::Ones(), has_colours ? spectra_in_white(scene) : nullptr);
  convert(material, false, spectrum);
  return spectrum.largest_deviation();
}

void give_bands(Scene& scene, const SpectralBands& wanted) {
  const BandSet bands = BandSet::spectral(wanted.centres_nm());
  if (scene.bands == bands) return;
  if (scene.bands.kind() == BandKind::kSpectral)
    throw InputError(scene.source,
                     fmt::format("the room has {} spectral bands of its own, not those of --bands {}",
                                 scene.bands.count(), wanted.text()),
                     "Leave --bands away: it is for rooms whose materials are colours.");
  // In light that lacks a primary, colours say nothing of the reflectance there.
  constexpr double kLeastPrimary = 0.05;
  Rgb light = light_of(scene);
  const bool seen_in_light =
      light.allFinite() && light.maxCoeff() > 0 && light.minCoeff() >= kLeastPrimary * light.maxCoeff();
  if (!seen_in_light) light = Rgb::Ones();
  light /= light.maxCoeff();
  ToSpectrum spectrum(bands, scene.bands.kind(), light);
  std::vector<bool> has_colours(scene.materials.size(), false);
  for (const Surface& surface : scene.surfaces)
    if (surface.has_vertex_colours) has_colours[surface.material.index()] = true;
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    convert(scene.materials[i], has_colours[i], spectrum);
  for (PunctualLight& light_source : scene.lights)
    strength_of(light_source) = spectrum.emission(rgb_of(strength_of(light_source)));
  if (scene.sky) convert_sky(*scene.sky, spectrum);
  scene.bands = bands;
  scene.notes.push_back(fmt::format(
      "Colours became {} bands, {} nm: emission is equal-energy white times a smooth spectrum; reflectances "
      "have their colours in {}.",
      bands.count(), wanted.text(),
      light.minCoeff() < 1
          ? fmt::format("the light of the luminaires, red : green : blue {:.3g} : {:.3g} : {:.3g}", light[0],
                        light[1], light[2])
          : "equal-energy white"));
  constexpr double kWorthAWord = 1e-3;
  if (spectrum.largest_deviation() > kWorthAWord)
    scene.warnings.push_back(fmt::format(
        "The bands {} nm are too few for the colours of the room: the nearest spectra miss one by "
        "{:.2g} %. Take smaller steps.",
        wanted.text(), 100 * spectrum.largest_deviation()));
}

}  // namespace reemit
