#include "scenes/io/native/native_sky.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/io/common/sky_image.h"
#include "scenes/io/native/native_materials.h"
#include "scenes/model/limits.h"
#include "scenes/model/measures.h"
#include "scenes/model/sun_position.h"

namespace reemit {
namespace {

constexpr double kGroundReflectance = 0.2;  // the default of Radiance's gensky
constexpr int kClearType = 12;

/// The digits at `from`, which are a number of `least` ... `most`.
int digits(const JsonCursor& at, std::size_t from, std::size_t count, int least, int most) {
  const std::string& text = at.string();
  int value = 0;
  const char* begin = text.data() + from;
  if (from + count <= text.size()) {
    const auto [end, error] = std::from_chars(begin, begin + count, value);
    if (error == std::errc() && end == begin + count && value >= least && value <= most) return value;
  }
  at.fail(fmt::format("'{}' is not a time", text),
          "Write a date, a time and its distance from UTC: 2024-06-21T12:00:00+01:00, or ...Z.");
}

void expect_sign(const JsonCursor& at, std::size_t from, const char* signs) {
  const std::string& text = at.string();
  if (from >= text.size() || std::string(signs).find(text[from]) == std::string::npos)
    digits(at, text.size(), 1, 0, 0);
}

CivilTime read_time(const JsonCursor& at) {
  const std::string& text = at.string();
  CivilTime time;
  time.year = digits(at, 0, 4, 1900, 2100);
  expect_sign(at, 4, "-");
  time.month = digits(at, 5, 2, 1, 12);
  expect_sign(at, 7, "-");
  const std::chrono::year_month_day_last month_end{
      std::chrono::year(time.year),
      std::chrono::month_day_last(std::chrono::month(static_cast<unsigned>(time.month)))};
  time.day = digits(at, 8, 2, 1, static_cast<int>(static_cast<unsigned>(month_end.day())));
  expect_sign(at, 10, "T ");
  time.hours = digits(at, 11, 2, 0, 23);
  expect_sign(at, 13, ":");
  time.hours += digits(at, 14, 2, 0, 59) / 60.0;
  std::size_t next = 16;
  if (next < text.size() && text[next] == ':') {
    time.hours += digits(at, 17, 2, 0, 59) / 3600.0;
    next = 19;
  }
  expect_sign(at, next, "Z+-");
  if (text[next] == 'Z') {
    if (next + 1 != text.size()) digits(at, text.size(), 1, 0, 0);
    return time;
  }
  time.utc_offset_h = digits(at, next + 1, 2, 0, 14);
  expect_sign(at, next + 3, ":");
  time.utc_offset_h += digits(at, next + 4, 2, 0, 59) / 60.0;
  if (next + 6 != text.size()) digits(at, text.size(), 1, 0, 0);
  if (text[next] == '-') time.utc_offset_h = -time.utc_offset_h;
  return time;
}

Spectrum checked(const Spectrum& strength, const JsonCursor& at) {
  const std::string problem = strength_problem(strength, "the irradiance [W/m2]");
  if (!problem.empty()) at.fail(problem, kStrengthAdvice);
  return strength;
}

/// Irradiance in watts or lux [W/m2], of which one may be given; empty if none is.
Spectrum read_irradiance(const JsonCursor& at, const BandSet& bands) {
  const auto watts = at.find("irradiance");
  const auto lux = at.find("illuminance_lx");
  const auto colour = at.find("color");
  if (watts && lux) lux->fail("\"irradiance\" is given already", "Keep one of the two.");
  if (colour && !lux)
    colour->fail("a colour needs \"illuminance_lx\"", "Give one irradiance per band instead.");
  if (watts) return checked(read_emission(*watts, bands), *watts);
  if (!lux) return {};
  return checked(photometric_emission(lux->strength(), colour, bands), *lux);
}

Sun read_sun(const JsonCursor& at, const BandSet& bands) {
  at.expect_object({"altitude_deg", "azimuth_deg", "latitude_deg", "longitude_deg", "time", "irradiance",
                    "illuminance_lx", "color", "angle_deg"});
  Sun sun;
  const auto time = at.find("time");
  const auto altitude = at.find("altitude_deg");
  for (const char* key : {"altitude_deg", "azimuth_deg"})
    if (const auto other = at.find(key); time && other)
      other->fail("the time says where the sun stands", "Keep one of the two.");
  for (const char* key : {"latitude_deg", "longitude_deg"})
    if (const auto other = at.find(key); !time && other)
      other->fail("a place counts together with a time", "Add \"time\", or leave the place out.");
  if (!time && !altitude)
    at.fail(
        "it does not say where the sun stands",
        "Give \"altitude_deg\" and \"azimuth_deg\", or \"latitude_deg\", \"longitude_deg\" and \"time\".");
  if (time) {
    const Place place{at.at("latitude_deg").number_in(-90, 90), at.at("longitude_deg").number_in(-180, 180)};
    const SunPosition position = sun_position(place, read_time(*time));
    if (!(position.altitude_deg > 0))
      time->fail(
          fmt::format("the sun is {:.1f} degrees below the horizon then", -position.altitude_deg),
          "Check the time, its distance from UTC, and the signs of the place: north and east are above 0.");
    sun.altitude = position.altitude_deg * kRadiansPerDegree;
    sun.azimuth = position.azimuth_deg * kRadiansPerDegree;
  } else {
    if (altitude->number() <= 0)
      altitude->fail(fmt::format("the sun is {:g} degrees below the horizon", -altitude->number()),
                     "Give an altitude above 0, or leave out the sun.");
    sun.altitude = altitude->number_in(0, 90) * kRadiansPerDegree;
    const auto azimuth = at.find("azimuth_deg");
    sun.azimuth = azimuth ? azimuth->number_in(-360, 720) * kRadiansPerDegree : 180 * kRadiansPerDegree;
  }
  sun.irradiance = read_irradiance(at, bands);
  if (const auto angle = at.find("angle_deg"))
    sun.half_angle = 0.5 * angle->number_in(0.01, 20) * kRadiansPerDegree;
  return sun;
}

Vec3 read_axis(const JsonCursor& at) {
  if (at.is_string()) return at.choice({"y", "z"}) == "y" ? Vec3::UnitY() : Vec3::UnitZ();
  const Vec3 axis = at.vec3();
  const double length = axis.stableNorm();
  if (!(length > 0) || !std::isfinite(length))
    at.fail("the direction has no length", "Give a vector that is not 0.");
  return axis / length;
}

void read_gradation(const JsonCursor& at, const std::string& type, Sky& sky) {
  if (type == "perez") {
    const double direct = at.at("direct_normal_W_m2").number_in(0, 2000);
    const double diffuse = at.at("diffuse_horizontal_W_m2").number_in(1e-3, 2000);
    if (!sky.sun) at.fail("this sky needs the place of the sun", "Add \"sun\": {\"altitude_deg\": ...}.");
    sky.gradation = SkyGradation::of_weather(direct, diffuse, sky.sun->altitude);
    sky.description = "Perez all-weather";
    return;
  }
  const int number = type == "clear" ? kClearType : at.at("cie_type").integer_in(1, 15);
  sky.gradation = SkyGradation::of_cie_type(number);
  sky.description = fmt::format("CIE general sky {}", number);
  if (sky.gradation.depends_on_sun() && !sky.sun)
    at.fail(
        "this sky is brighter around the sun, and it is not said where that stands",
        "Add \"sun\": {\"altitude_deg\": ..., \"azimuth_deg\": ...}; without a strength it only says where.");
}

/// Refuses keys that say nothing of a sky of this type: whoever writes them means another.
void refuse_idle_keys(const JsonCursor& at, const std::string& type) {
  struct KeysOf {
    std::vector<std::string_view> types;
    std::vector<const char*> keys;
  };
  static const std::vector<KeysOf> all{
      {{"cie"}, {"cie_type"}},
      {{"perez"}, {"direct_normal_W_m2", "diffuse_horizontal_W_m2"}},
      {{"image"}, {"file", "scale", "rotation_deg"}},
      {{"uniform", "overcast", "clear", "cie", "perez"},
       {"irradiance", "illuminance_lx", "radiance", "zenith_luminance_cd_m2", "color"}}};
  for (const KeysOf& some : all) {
    if (std::find(some.types.begin(), some.types.end(), type) != some.types.end()) continue;
    for (const char* key : some.keys)
      if (const auto idle = at.find(key))
        idle->fail(fmt::format("it says nothing of a sky of type \"{}\", but of: {}", type,
                               fmt::join(some.types, ", ")),
                   "Leave it out, or choose another type.");
  }
}

void read_strength(const JsonCursor& at, const BandSet& bands, Sky& sky) {
  const auto radiance = at.find("radiance");
  const auto luminance = at.find("zenith_luminance_cd_m2");
  if (radiance || luminance) {
    const JsonCursor& given = radiance ? *radiance : *luminance;
    if (sky.kind != SkyKind::kUniform && sky.kind != SkyKind::kOvercast)
      given.fail("only uniform and overcast skies are given by their zenith", "Give \"illuminance_lx\".");
    if ((radiance && luminance) || at.find("irradiance") || at.find("illuminance_lx"))
      given.fail("the strength of the sky is given twice", "Keep one of the two.");
    const Spectrum zenith = radiance ? read_emission(*radiance, bands)
                                     : photometric_emission(luminance->strength(), at.find("color"), bands);
    sky.irradiance =
        checked(zenith * std::numbers::pi * (sky.kind == SkyKind::kUniform ? 1.0 : 7.0 / 9), given);
  } else {
    sky.irradiance = read_irradiance(at, bands);
  }
  if (sky.irradiance.size() == 0)
    at.fail("the sky has no strength",
            "Give \"illuminance_lx\", on a horizontal plane and without the sun, or \"irradiance\" [W/m2].");
  if (!(sky.irradiance > 0).any())
    at.fail("the sky sends no light", "Give it some, or \"type\": \"none\" for a sun alone.");
}

}  // namespace

void read_sky(const JsonCursor& at, const std::filesystem::path& folder, Scene& scene) {
  at.expect_object({"type", "cie_type", "irradiance", "illuminance_lx", "radiance", "zenith_luminance_cd_m2",
                    "color", "direct_normal_W_m2", "diffuse_horizontal_W_m2", "file", "scale", "rotation_deg",
                    "ground_reflectance", "up", "north", "sun"});
  Sky sky;
  const std::string& type =
      at.at("type").choice({"uniform", "overcast", "clear", "cie", "perez", "image", "none"});
  refuse_idle_keys(at, type);
  if (const auto sun = at.find("sun")) sky.sun = read_sun(*sun, scene.bands);
  if (const auto up = at.find("up")) sky.up = read_axis(*up);
  if (const auto north = at.find("north")) {
    sky.north = read_axis(*north);
    if (sky.up.isZero()) north->fail("\"north\" needs \"up\"", "Give both.");
    if (sky.north.cross(sky.up).norm() < 1e-3)
      north->fail("north is along up", "Choose a direction across it.");
  }
  if (type == "none") {
    sky.kind = SkyKind::kNone;
    sky.description = "none";
    if (!sky.sun_shines()) at.fail("there is neither sky nor sun", "Give the sun \"illuminance_lx\".");
  } else if (type == "image") {
    sky.kind = SkyKind::kImage;
    const std::filesystem::path file = folder / at.at("file").string();
    const auto scale = at.find("scale");
    const auto rotation = at.find("rotation_deg");
    sky.image = read_sky_image(file, scale ? scale->number_in(1e-9, 1e9) : 1,
                               rotation ? rotation->number_in(-360, 360) : 0, scene.bands);
    sky.description = file.filename().string();
  } else {
    sky.kind = type == "uniform"    ? SkyKind::kUniform
               : type == "overcast" ? SkyKind::kOvercast
                                    : SkyKind::kGeneral;
    sky.description = type == "overcast" ? "CIE overcast" : type;
    if (sky.kind == SkyKind::kGeneral) read_gradation(at, type, sky);
    read_strength(at, scene.bands, sky);
  }
  const auto ground = at.find("ground_reflectance");
  if (ground || sky.kind != SkyKind::kImage)
    sky.ground_reflectance =
        ground ? read_reflectance(*ground, scene.bands)
               : Spectrum::Constant(static_cast<Eigen::Index>(scene.bands.count()), kGroundReflectance);
  scene.sky = std::move(sky);
}

}  // namespace reemit
