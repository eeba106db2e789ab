#include "scenes/io/common/json_cursor.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {

using nlohmann::json;

namespace {

constexpr int kDeepestNesting = 64;
constexpr std::size_t kNamesShown = 40;

std::size_t line_of(const std::string& text, std::size_t byte) {
  byte = std::min(byte, text.size());
  return 1 + static_cast<std::size_t>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(byte), '\n'));
}

std::string escaped(const std::string& key) {
  std::string token;
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

/// Watches the parser, so that what a finished json value cannot tell any more (a key given twice) is
/// refused.
class ParseGuard {
 public:
  explicit ParseGuard(const std::string& file) : file_(file) {}

  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    using Event = json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        if (depth >= kDeepestNesting) {
          throw InputError(path(), fmt::format("values are nested deeper than {} levels", kDeepestNesting),
                           "Flatten the file; no room needs that.");
        }
        levels_.push_back({event == Event::array_start, 0, {}, {}});
        break;
      case Event::key: {
        const auto& key = parsed.get_ref<const std::string&>();
        if (!levels_.back().keys.insert(key).second) {
          levels_.back().last_key.clear();
          throw InputError(path(), fmt::format("the key \"{}\" is given twice", key), "Keep one of the two.");
        }
        levels_.back().last_key = key;
        break;
      }
      case Event::object_end:
      case Event::array_end:
        levels_.pop_back();
        [[fallthrough]];
      case Event::value:
        if (!levels_.empty()) ++levels_.back().index;
        break;
    }
    return true;
  }

  /// File and JSON pointer of the value being read.
  std::string path() const {
    std::string path = file_ + "#";
    for (const Level& level : levels_) {
      if (level.is_array) {
        path += fmt::format("/{}", level.index);
      } else if (!level.last_key.empty()) {
        path += '/';
        path += escaped(level.last_key);
      }
    }
    return path;
  }

 private:
  struct Level {
    bool is_array;
    std::size_t index;  // Of the value being read, in an array.
    std::set<std::string> keys;
    std::string last_key;
  };

  const std::string& file_;
  std::vector<Level> levels_;
};

/// Insertions, deletions, substitutions and exchanges of neighbours that lead from a to b, upper and lower
/// case being the same (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); };
  std::vector<std::size_t> before_last, last, row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = std::move(last);
    last = std::move(row);
    row.assign(b.size() + 1, i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({row[j - 1] + 1, last[j] + 1, last[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1)});
      const bool exchanged = i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]);
      if (exchanged) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

bool find_path(const json& from, const json& wanted, std::string& path) {
  if (&from == &wanted) return true;
  const std::size_t length = path.size();
  if (from.is_object()) {
    for (const auto& [key, value] : from.items()) {
      path += '/';
      path += escaped(key);
      if (find_path(value, wanted, path)) return true;
      path.resize(length);
    }
  } else if (from.is_array()) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      path += fmt::format("/{}", i);
      if (find_path(from[i], wanted, path)) return true;
      path.resize(length);
    }
  }
  return false;
}

}  // namespace

json parse_json(const std::string& text, const std::string& file) {
  ParseGuard guard(file);
  try {
    return json::parse(text, std::ref(guard), true, true);
  } catch (const json::parse_error& error) {
    std::string problem = error.what();
    if (const auto start = problem.find("syntax error"); start != std::string::npos) problem.erase(0, start);
    // What the parser quotes may be binary; only printable text goes into a message.
    std::erase_if(problem, [](unsigned char c) { return c < 0x20 || c >= 0x7f; });
    throw InputError(fmt::format("{}:{}", file, line_of(text, error.byte)), problem,
                     "The file must be JSON (comments are allowed, trailing commas are not).");
  } catch (const json::out_of_range& error) {
    std::string problem = error.what();
    if (const auto start = problem.find("number"); start != std::string::npos) problem.erase(0, start);
    throw InputError(guard.path(), problem, "Numbers must fit a double, that is lie below 1.8e308.");
  }
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& choices) {
  constexpr std::size_t kLongest = 64;
  if (word.size() > kLongest) return "";
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& choice : choices) {
    if (choice.size() > kLongest) continue;
    const std::size_t distance = edit_distance(word, choice);
    if (distance < best_distance) {
      best = choice;
      best_distance = distance;
    }
  }
  return best;
}

std::string known_names(std::string_view word, const std::vector<std::string>& choices) {
  std::string advice;
  if (const std::string near = nearest_name(word, choices); !near.empty()) {
    advice = fmt::format("Did you mean \"{}\"? ", near);
  }
  const std::size_t shown = std::min(choices.size(), kNamesShown);
  const std::vector<std::string> first(choices.begin(), choices.begin() + static_cast<std::ptrdiff_t>(shown));
  advice += fmt::format("Known are: {}{}", fmt::join(first, ", "), shown < choices.size() ? ", ..." : ".");
  return advice;
}

bool JsonCursor::is_object() const {
  return value_->is_object();
}
bool JsonCursor::is_array() const {
  return value_->is_array();
}
bool JsonCursor::is_number() const {
  return value_->is_number();
}
bool JsonCursor::is_string() const {
  return value_->is_string();
}

void JsonCursor::expect_object() const {
  if (!value_->is_object())
    fail(fmt::format("expected an object, found {}", value_->type_name()), "Write { ... }.");
}

void JsonCursor::expect_object(std::initializer_list<const char*> keys) const {
  expect_object();
  const std::vector<std::string> known(keys.begin(), keys.end());
  for (const auto& [key, value] : value_->items()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      JsonCursor(*this, value).fail(fmt::format("unknown key \"{}\"", key), known_names(key, known));
    }
  }
}

void JsonCursor::expect_array(std::size_t least, std::size_t most) const {
  if (!value_->is_array())
    fail(fmt::format("expected an array, found {}", value_->type_name()), "Write [ ... ].");
  if (value_->size() < least || value_->size() > most) {
    const std::string wanted = least == most ? fmt::format("{}", least)
                               : most == std::numeric_limits<std::size_t>::max()
                                   ? fmt::format("at least {}", least)
                                   : fmt::format("{} to {}", least, most);
    fail(fmt::format("the array has {} values, expected {}", value_->size(), wanted), "Correct the array.");
  }
}

std::optional<JsonCursor> JsonCursor::find(const char* key) const {
  expect_object();
  const auto it = value_->find(key);
  if (it == value_->end()) return std::nullopt;
  return JsonCursor(*this, *it);
}

JsonCursor JsonCursor::at(const char* key) const {
  if (const auto found = find(key)) return *found;
  fail(fmt::format("the key \"{}\" is missing", key), "Add it; docs/room_format.md lists the fields.");
}

std::size_t JsonCursor::size() const {
  expect_array(0);
  return value_->size();
}

JsonCursor JsonCursor::operator[](std::size_t i) const {
  return {*this, (*value_)[i]};
}

std::vector<std::pair<std::string, JsonCursor>> JsonCursor::members() const {
  expect_object();
  std::vector<std::pair<std::string, JsonCursor>> found;
  for (const auto& [key, value] : value_->items()) found.emplace_back(key, JsonCursor(*this, value));
  return found;
}

double JsonCursor::number() const {
  if (!value_->is_number())
    fail(fmt::format("expected a number, found {}", value_->type_name()), "Write a number.");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) fail("the number is not finite", "Write a finite number.");
  return number;
}

double JsonCursor::number_in(double least, double most) const {
  const double value = number();
  if (value < least || value > most) {
    fail(fmt::format("{} is out of range", value), fmt::format("It must lie from {} to {}.", least, most));
  }
  return value;
}

double JsonCursor::strength() const {
  const double value = number();
  if (value < 0) fail(fmt::format("{} is out of range", value), "It must be above 0.");
  return value;
}

double JsonCursor::length() const {
  const double value = number();
  if (value <= 0) fail(fmt::format("{} is out of range", value), "It must be greater than 0.");
  return number_in(0, limits::kFarthest);
}

int JsonCursor::integer_in(int least, int most) const {
  const double value = number();
  if (value != std::floor(value) || value < least || value > most) {
    fail(fmt::format("{} is not a valid count", value),
         fmt::format("Write a whole number from {} to {}.", least, most));
  }
  return static_cast<int>(value);
}

bool JsonCursor::boolean() const {
  if (!value_->is_boolean())
    fail(fmt::format("expected true or false, found {}", value_->type_name()), "Write one.");
  return value_->get<bool>();
}

const std::string& JsonCursor::string() const {
  if (!value_->is_string())
    fail(fmt::format("expected a string, found {}", value_->type_name()), "Put it in quotes.");
  return value_->get_ref<const std::string&>();
}

const std::string& JsonCursor::choice(const std::vector<std::string>& choices) const {
  const std::string& word = string();
  if (std::find(choices.begin(), choices.end(), word) == choices.end()) {
    fail(fmt::format("\"{}\" is not known here", word), known_names(word, choices));
  }
  return word;
}

Vec3 JsonCursor::vec3() const {
  expect_array(3, 3);
  return {(*this)[0].number(), (*this)[1].number(), (*this)[2].number()};
}

Vec3 JsonCursor::place() const {
  expect_array(3, 3);
  const auto coordinate = [this](std::size_t i) {
    return (*this)[i].number_in(-limits::kFarthest, limits::kFarthest);
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

std::vector<double> JsonCursor::numbers() const {
  std::vector<double> values(size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = (*this)[i].number();
  return values;
}

std::string JsonCursor::where() const {
  std::string path;
  find_path(*document_, *value_, path);
  return *file_ + "#" + path;
}

void JsonCursor::fail(const std::string& problem, const std::string& advice) const {
  throw InputError(where(), problem, advice);
}

}  // namespace reemit
