#include "scenes/io/native/native_textures.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/model/colour.h"
#include "scenes/model/colour_spectra.h"
#include "scenes/model/texture_checks.h"

namespace reemit {

namespace {

TextureWrap wrap_of(const JsonCursor& at) {
  const std::string& name = at.choice({"repeat", "mirror", "clamp"});
  if (name == "clamp") return TextureWrap::kClamp;
  return name == "mirror" ? TextureWrap::kMirror : TextureWrap::kRepeat;
}

/// One number for both directions, or two.
Eigen::Vector2d pair_of(const JsonCursor& at, double most) {
  if (at.is_number()) return Eigen::Vector2d::Constant(at.number_in(-most, most));
  at.expect_array(2, 2);
  return {at[0].number_in(-most, most), at[1].number_in(-most, most)};
}

}  // namespace

Texture NativeTextures::read_texture(const JsonCursor& at, TextureEncoding encoding) {
  at.expect_object({"file", "encoding", "wrap", "filter", "scale", "offset", "rotation_deg"});
  if (const auto given = at.find("encoding"))
    encoding =
        given->choice({"srgb", "linear"}) == "srgb" ? TextureEncoding::kSrgb : TextureEncoding::kLinear;
  const JsonCursor file = at.at("file");
  TextureRead read = images_.from_file(folder_ / file.string(), encoding);
  if (!read.problem.empty()) file.fail(read.problem, "Names are relative to the folder of the room file.");
  if (const std::string note = reduction_note(*read.image); !note.empty()) scene_.notes.push_back(note);
  Texture texture;
  texture.image = std::move(read.image);
  if (const auto wrap = at.find("wrap")) {
    if (wrap->is_array()) {
      wrap->expect_array(2, 2);
      texture.wrap_u = wrap_of((*wrap)[0]);
      texture.wrap_v = wrap_of((*wrap)[1]);
    } else {
      texture.wrap_u = texture.wrap_v = wrap_of(*wrap);
    }
  }
  if (const auto filter = at.find("filter"))
    texture.nearest = filter->choice({"linear", "nearest"}) == "nearest";
  constexpr double kMost = 1e5;
  const auto scale = at.find("scale");
  const auto offset = at.find("offset");
  const auto rotation = at.find("rotation_deg");
  const Eigen::Vector2d s = scale ? pair_of(*scale, kMost) : Eigen::Vector2d::Ones();
  const Eigen::Vector2d o = offset ? pair_of(*offset, kMost) : Eigen::Vector2d::Zero();
  const double angle = rotation ? rotation->number_in(-360, 360) * std::numbers::pi / 180 : 0;
  const double c = std::cos(angle);
  const double n = std::sin(angle);
  // Coordinates are scaled, turned and moved; v runs up, rows of images down.
  texture.to_image << c * s.x(), -n * s.y(), o.x(), -n * s.x(), -c * s.y(), 1 - o.y();
  return texture;
}

TexelSpectra NativeTextures::spectra() {
  if (scene_.bands.kind() != BandKind::kSpectral) return {};
  if (!spectra_) spectra_ = spectra_in_white(scene_);
  return {spectra_};
}

Spectrum NativeTextures::mean_of(const Texture& texture) const {
  const Texel& mean = texture.image->mean;
  if (spectra_) {
    std::vector<float> values(scene_.bands.count());
    spectra_->values({mean[0], mean[1], mean[2]}, values);
    return Eigen::Map<const Eigen::ArrayXf>(values.data(), static_cast<Eigen::Index>(values.size()))
        .cast<double>();
  }
  const Eigen::Array3d rgb(mean[0], mean[1], mean[2]);
  if (scene_.bands.kind() == BandKind::kRgb) return rgb;
  return Spectrum::Constant(1, (rec709_luminance_weights() * rgb).sum());
}

void NativeTextures::read(const JsonCursor& at, Material& material) {
  MaterialTextures& textures = material.textures;
  if (const auto colour = at.find("texture")) {
    textures.reflectance = read_texture(*colour, TextureEncoding::kSrgb);
    if (!at.find("reflectance"))
      material.reflectance = Spectrum::Ones(static_cast<Eigen::Index>(scene_.bands.count()));
    textures.reflectance_factor = material.reflectance;
    textures.reflectance_spectra = spectra();
    material.reflectance *= mean_of(textures.reflectance);
  }
  if (const auto emission = at.find("emission_texture")) {
    if (!material.emits())
      emission->fail(
          "a texture of nothing: the material does not emit, or by \"total_power\" or "
          "\"total_flux_lm\", which are no radiance",
          "Give \"radiance\", \"exitance\", \"luminance_cd_m2\" or \"exitance_lm_m2\".");
    textures.emission = read_texture(*emission, TextureEncoding::kSrgb);
    textures.emission_factor = material.emitted_radiance;
    textures.emission_spectra = spectra();
    material.emitted_radiance *= mean_of(textures.emission);
  }
  if (const auto opacity = at.find("opacity")) textures.opacity_factor = opacity->number_in(0, 1);
  if (const auto image = at.find("opacity_texture")) {
    textures.opacity = read_texture(*image, TextureEncoding::kLinear);
    textures.opacity_is_colour = !textures.opacity.image->has_opacity;
  }
  if (const auto cutoff = at.find("opacity_cutoff")) {
    if (!textures.opacity)
      cutoff->fail("a cutoff without a texture", "Give the \"opacity_texture\" whose values it cuts.");
    textures.opacity_cutoff = cutoff->number_in(0, 1);
  }
}

}  // namespace reemit
