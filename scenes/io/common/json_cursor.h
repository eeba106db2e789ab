#pragma once
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scenes/model/vec.h"

namespace reemit {

/// Parses JSON text, in which // and /* */ comments are allowed. Throws InputError with file and line for a
/// syntax error, a number beyond the range of double, a key that stands twice in one object, or more than 64
/// levels of nesting (what follows may then safely recurse).
nlohmann::json parse_json(const std::string& text, const std::string& file);

/// The name of `choices` that is nearest to `word` by edit distance, or "" if none is near.
std::string nearest_name(std::string_view word, const std::vector<std::string>& choices);

/// Advice for a name that is not known: the nearest known one, and all of them (cut after 40).
std::string known_names(std::string_view word, const std::vector<std::string>& choices);

/// A value inside a JSON document. Every access checks type and range and throws an InputError that names
/// file and JSON pointer. The document and the file name must outlive the cursor.
class JsonCursor {
 public:
  JsonCursor(const nlohmann::json& document, const std::string& file)
      : file_(&file), document_(&document), value_(&document) {}

  bool is_object() const;
  bool is_array() const;
  bool is_number() const;
  bool is_string() const;

  /// Demands an object all of whose keys are in `keys`.
  void expect_object(std::initializer_list<const char*> keys) const;
  /// Demands an object, whose keys are names chosen by the user.
  void expect_object() const;
  /// Demands an array of at least `least` and at most `most` values.
  void expect_array(std::size_t least, std::size_t most = std::numeric_limits<std::size_t>::max()) const;

  /// Nothing if the object does not have the key.
  std::optional<JsonCursor> find(const char* key) const;
  JsonCursor at(const char* key) const;  ///< The key is required.
  std::size_t size() const;              ///< Of an array; demands one.
  JsonCursor operator[](std::size_t i) const;
  std::vector<std::pair<std::string, JsonCursor>> members() const;  ///< Of an object, sorted by key.

  double number() const;                              ///< Any finite number.
  double number_in(double least, double most) const;  ///< In [least, most].
  double strength() const;                    ///< Of light: not below 0. Who needs more than nothing looks.
  double length() const;                      ///< Above 0, at most limits::kFarthest.
  int integer_in(int least, int most) const;  ///< In [least, most].
  bool boolean() const;
  const std::string& string() const;
  /// One of `choices`.
  const std::string& choice(const std::vector<std::string>& choices) const;
  Vec3 vec3() const;   ///< A direction or factors: any finite numbers.
  Vec3 place() const;  ///< A place or an offset: within limits::kFarthest.
  std::vector<double> numbers() const;

  /// File and JSON pointer, as in room.json#/objects/3/box/min.
  std::string where() const;
  /// Throws an InputError about this value.
  [[noreturn]] void fail(const std::string& problem, const std::string& advice) const;

 private:
  JsonCursor(const JsonCursor& from, const nlohmann::json& value)
      : file_(from.file_), document_(from.document_), value_(&value) {}

  const std::string* file_;
  const nlohmann::json* document_;  // The pointer of a value is searched from here, only when it fails.
  const nlohmann::json* value_;
};

}  // namespace reemit
