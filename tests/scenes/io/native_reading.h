#pragma once
#include <string>

#include "scenes/io/native/native_reader.h"
#include "tests/scenes/io/expect_input_error.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {

/// A room of the given fields; format and version are added.
inline std::string room(const std::string& fields) {
  return R"({"format": "reemit-room", "version": 1, )" + fields + "}";
}

/// A room with the materials white and lamp and the given objects.
inline std::string room_of(const std::string& objects) {
  return room(R"("materials": {"white": {"reflectance": 0.5}, "lamp": {"reflectance": 0, "radiance": 2}}, )"
              R"("objects": [)" +
              objects + "]");
}

inline Scene read_text(const std::string& text) {
  const TempFolder folder;
  return read_native_scene(folder.write("room.json", text), {});
}

inline void expect_refused(const std::string& text, std::initializer_list<const char*> parts) {
  expect_input_error([&] { read_text(text); }, parts);
}

}  // namespace reemit::test
