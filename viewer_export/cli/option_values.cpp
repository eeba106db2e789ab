#include "viewer_export/cli/option_values.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/model/limits.h"

namespace reemit::cli {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// The whole text as a finite number; locale does not matter.
std::optional<double> finite_number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

/// The whole text as decimal digits.
std::optional<std::uint64_t> whole_number(std::string_view text) {
  text = trimmed(text);
  std::uint64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const std::string& text, std::string_view expected) {
  throw std::invalid_argument(fmt::format("'{}' is not {}", text, expected));
}

/// Splits "1.5min" into "1.5" and "min".
std::pair<std::string_view, std::string_view> split_unit(std::string_view text) {
  text = trimmed(text);
  const auto digit = text.find_last_of("0123456789.");
  if (digit == std::string_view::npos) return {{}, text};
  return {text.substr(0, digit + 1), trimmed(text.substr(digit + 1))};
}

}  // namespace

double parse_share(const std::string& text) {
  const auto [number, unit] = split_unit(text);
  const auto value = finite_number(number);
  if (value && (unit.empty() || unit == "%")) {
    const double share = unit.empty() ? *value : *value / 100;
    if (share > 0 && share < 1) return share;
  }
  refuse(text, "a share between 0 and 1; write 1% or 0.01");
}

std::string parse_word(const std::string& text) {
  if (trimmed(text).empty())
    throw std::invalid_argument("nothing is given; leave the option out, or say what is meant");
  return text;
}

double parse_seconds(const std::string& text) {
  static constexpr std::pair<std::string_view, double> kUnits[] = {
      {"", 1}, {"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}};
  const auto [number, unit] = split_unit(text);
  const auto value = finite_number(number);
  for (const auto& [name, seconds] : kUnits) {
    if (value && unit == name && *value > 0 && std::isfinite(*value * seconds)) return *value * seconds;
  }
  refuse(text, "a time above 0; write 90, 90s, 500ms, 2min or 1h");
}

std::uint64_t parse_count(const std::string& text) {
  constexpr std::uint64_t kLargest = 1'000'000'000'000'000'000;
  const auto whole = whole_number(text);
  if (whole && *whole >= 1 && *whole <= kLargest) return *whole;
  const auto value = finite_number(text);
  if (!whole && value && *value >= 1 && *value <= 1e18 && *value == std::floor(*value)) {
    return static_cast<std::uint64_t>(*value);
  }
  refuse(text, "a whole number from 1 to 1e18; write 250000 or 1e6");
}

std::uint64_t parse_integer(const std::string& text, std::uint64_t least, std::uint64_t most) {
  const auto whole = whole_number(text);
  if (!whole || *whole < least || *whole > most) {
    refuse(text, fmt::format("a whole number from {} to {}", least, most));
  }
  return *whole;
}

double parse_positive(const std::string& text) {
  const auto value = finite_number(text);
  if (!value || *value <= 0) refuse(text, "a number above 0");
  return *value;
}

double parse_exposure(const std::string& text) {
  constexpr double kMost = 100;
  const auto value = finite_number(text);
  if (!value || !(std::abs(*value) <= kMost))
    refuse(text, fmt::format("a number of stops from -{0} to {0}", kMost));
  return *value;
}

Vec3 parse_direction(const std::string& text) {
  Vec3 point{0, 0, 0};
  std::string_view rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const auto comma = rest.find(',');
    const auto value = finite_number(rest.substr(0, comma));
    if (!value || (axis < 2) != (comma != std::string_view::npos)) {
      refuse(text, "three numbers X,Y,Z; write 2.78,2.73,-8");
    }
    point[axis] = *value;
    if (axis < 2) rest.remove_prefix(comma + 1);
  }
  return point;
}

Vec3 parse_point(const std::string& text) {
  const Vec3 point = parse_direction(text);
  if (point.cwiseAbs().maxCoeff() > limits::kFarthest)
    refuse(text, fmt::format("a place; no coordinate may exceed {:g} m", limits::kFarthest));
  return point;
}

std::string joined_point(std::span<const std::string> words) {
  if (words.size() < 3) return "";
  std::string point;
  for (std::string word : words.first(3)) {
    if (word.ends_with(',')) word.pop_back();
    if (!finite_number(word)) return "";
    point += (point.empty() ? "" : ",") + word;
  }
  return point;
}

PixelSize parse_size(const std::string& text) {
  using limits::kMostPixels;
  const auto side = [](std::string_view digits) {
    const auto value = digits.starts_with(' ') || digits.ends_with(' ') ? std::nullopt : whole_number(digits);
    return value && *value <= kMostPixels ? static_cast<int>(*value) : 0;
  };
  const std::string_view all = trimmed(text);
  const auto cross = all.find('x');
  if (cross != std::string_view::npos) {
    const PixelSize size{side(all.substr(0, cross)), side(all.substr(cross + 1))};
    if (size.width > 0 && size.height > 0) return size;
  }
  refuse(text, fmt::format("a picture size WxH in pixels, sides from 1 to {}; write 640x480", kMostPixels));
}

}  // namespace reemit::cli
