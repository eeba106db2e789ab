#include "scenes/io/native/sky_option.h"

#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/json_cursor.h"
#include "scenes/io/native/native_sky.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

using Json = nlohmann::json;

constexpr const char* kSkyAdvice =
    "Write uniform:10000lx, overcast:10000lx, clear:20000lx, cie7:15000lx or image:FILE, and after commas "
    "ground=0.2, up=z, north=..., scale=..., rotation=...";
constexpr const char* kSunAdvice =
    "Write altitude=40,azimuth=180,lx=80000, or "
    "latitude=48.2,longitude=16.4,time=2024-06-21T12:00+02:00,lx=80000.";

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

double number_of(const std::string& text, const char* option, const char* advice) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(option, fmt::format("'{}' is not a number", text), advice);
  return value;
}

/// A number, or several of them separated by '/'.
Json values_of(const std::string& text, const char* option, const char* advice) {
  const std::vector<std::string> parts = split(text, '/');
  if (parts.size() == 1) return number_of(text, option, advice);
  Json values = Json::array();
  for (const std::string& part : parts) values.push_back(number_of(part, option, advice));
  return values;
}

bool take_suffix(std::string& text, const std::string& suffix) {
  if (text.size() <= suffix.size() || !text.ends_with(suffix)) return false;
  text.resize(text.size() - suffix.size());
  return true;
}

/// KEY=VALUE as a member of the object of a room file.
void add_member(const std::string& part, const std::map<std::string, std::string>& keys, const char* option,
                const char* advice, Json& object) {
  const std::size_t at = part.find('=');
  const auto key = keys.find(part.substr(0, at));
  if (at == std::string::npos || key == keys.end())
    throw InputError(option, fmt::format("'{}' is not known", part), advice);
  const std::string value = part.substr(at + 1);
  const bool is_word = key->second == "time" || value == "y" || value == "z";
  object[key->second] = is_word ? Json(value) : values_of(value, option, advice);
}

Json sun_object(const std::string& text) {
  static const std::map<std::string, std::string> keys{{"altitude", "altitude_deg"},
                                                       {"azimuth", "azimuth_deg"},
                                                       {"latitude", "latitude_deg"},
                                                       {"longitude", "longitude_deg"},
                                                       {"time", "time"},
                                                       {"lx", "illuminance_lx"},
                                                       {"color", "color"},
                                                       {"irradiance", "irradiance"},
                                                       {"angle", "angle_deg"}};
  Json sun = Json::object();
  for (const std::string& part : split(text, ',')) add_member(part, keys, "--sun", kSunAdvice, sun);
  return sun;
}

Json sky_object(const std::string& text) {
  static const std::map<std::string, std::string> keys{{"ground", "ground_reflectance"},
                                                       {"up", "up"},
                                                       {"north", "north"},
                                                       {"scale", "scale"},
                                                       {"rotation", "rotation_deg"},
                                                       {"color", "color"},
                                                       {"direct", "direct_normal_W_m2"},
                                                       {"diffuse", "diffuse_horizontal_W_m2"}};
  const std::vector<std::string> parts = split(text, ',');
  const std::size_t colon = parts[0].find(':');
  const std::string kind = parts[0].substr(0, colon);
  std::string strength = colon == std::string::npos ? "" : parts[0].substr(colon + 1);
  Json sky = Json::object();
  sky["type"] = kind;
  if (kind.starts_with("cie") && kind.size() > 3) {
    sky["type"] = "cie";
    sky["cie_type"] = static_cast<int>(number_of(kind.substr(3), "--sky", kSkyAdvice));
  }
  static const std::set<std::string> need_strength{"uniform", "overcast", "clear", "cie"};
  if (strength.empty() && need_strength.contains(sky["type"]))
    throw InputError("--sky", fmt::format("'{}' has no strength", kind), kSkyAdvice);
  if (kind == "image") {
    sky["file"] = strength;
  } else if (!strength.empty()) {
    if (take_suffix(strength, "lx"))
      sky["illuminance_lx"] = number_of(strength, "--sky", kSkyAdvice);
    else if (take_suffix(strength, "cd/m2"))
      sky["zenith_luminance_cd_m2"] = number_of(strength, "--sky", kSkyAdvice);
    else if (take_suffix(strength, "W/m2"))
      sky["irradiance"] = values_of(strength, "--sky", kSkyAdvice);
    else
      throw InputError("--sky", fmt::format("'{}' has no unit", strength), kSkyAdvice);
  }
  for (std::size_t i = 1; i < parts.size(); ++i) add_member(parts[i], keys, "--sky", kSkyAdvice, sky);
  return sky;
}

}  // namespace

void add_sky(const std::string& sky, const std::string& sun, Scene& scene) {
  if (scene.sky)
    scene.notes.push_back("The sky of the file is replaced by that of the options --sky and --sun.");
  Json object = sky.empty() ? Json{{"type", "none"}} : sky_object(sky);
  if (!sun.empty()) object["sun"] = sun_object(sun);
  if (sky.empty() && !object["sun"].contains("illuminance_lx") && !object["sun"].contains("irradiance"))
    throw InputError("--sun", "there is neither sky nor sun, for it has no strength",
                     "Add ,lx=80000, or give a --sky.");
  const std::string option = sky.empty() ? "--sun" : "--sky";
  read_sky(JsonCursor(object, option), {}, scene);
}

std::string with_absolute_path(const std::string& sky) {
  constexpr std::string_view kImage = "image:";
  if (!sky.starts_with(kImage)) return sky;
  const std::size_t end = std::min(sky.find(','), sky.size());
  const std::filesystem::path file = sky.substr(kImage.size(), end - kImage.size());
  return std::string(kImage) + std::filesystem::absolute(file).lexically_normal().string() + sky.substr(end);
}

}  // namespace reemit
