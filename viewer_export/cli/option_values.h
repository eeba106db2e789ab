#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "scenes/model/vec.h"

namespace reemit::cli {

// Values of options, read strictly: the whole text must be the value. All throw std::invalid_argument with a
// message that names the text and shows a right one.

/// Share of one in (0,1): "1%", "0.5 %" or "0.01".
double parse_share(const std::string& text);
/// Any text but none.
std::string parse_word(const std::string& text);
/// Time [s] > 0: "60", "60s", "500ms", "2min" or "1h".
double parse_seconds(const std::string& text);
/// Whole number in [1, 1e18]: "250000", "1e6" or "2.5e6".
std::uint64_t parse_count(const std::string& text);
/// Whole number in [least, most].
std::uint64_t parse_integer(const std::string& text, std::uint64_t least, std::uint64_t most);
/// Finite number > 0.
double parse_positive(const std::string& text);
/// Stops in [-100, 100].
double parse_exposure(const std::string& text);
/// Three finite numbers "X,Y,Z".
Vec3 parse_direction(const std::string& text);
/// The same within limits::kFarthest [m].
Vec3 parse_point(const std::string& text);

/// "1,2,3" where the three numbers are the first of `words`, with or without commas behind them; else empty.
std::string joined_point(std::span<const std::string> words);

struct PixelSize {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
};
/// "640x480", each side in [1, limits::kMostPixels].
PixelSize parse_size(const std::string& text);

}  // namespace reemit::cli
