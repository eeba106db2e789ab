#include "scenes/io/gltf/gltf_model.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/json_cursor.h"
#include "scenes/io/common/text_file.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/io/gltf/gltf_document.h"
#include "scenes/io/gltf/gltf_draco.h"
#include "scenes/io/gltf/gltf_extensions.h"
#include "scenes/io/gltf/gltf_meshopt.h"
#include "scenes/model/error.h"

namespace reemit {

namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

std::uint32_t word_at(const std::string& bytes, std::size_t offset) {
  std::array<unsigned char, 4> b;
  std::memcpy(b.data(), bytes.data() + offset, b.size());
  return b[0] | (std::uint32_t{b[1]} << 8) | (std::uint32_t{b[2]} << 16) | (std::uint32_t{b[3]} << 24);
}

/// The JSON text of a GLB file, after a check of all chunk lengths.
std::string json_of_glb(const std::string& bytes, const std::string& file) {
  const auto fail = [&](const std::string& problem) {
    throw InputError(file, problem, "The GLB file is damaged or cut off; export it anew.");
  };
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader + kChunkHeader) fail("the file is too short for a GLB header");
  if (word_at(bytes, 4) != 2) {
    throw InputError(file, fmt::format("GLB version {}", word_at(bytes, 4)), "Export glTF 2.0.");
  }
  const std::size_t length = word_at(bytes, 8);
  if (length > bytes.size()) {
    fail(fmt::format("the header promises {} bytes, the file has {}", length, bytes.size()));
  }
  const std::size_t json_length = word_at(bytes, kHeader);
  if (word_at(bytes, kHeader + 4) != kJsonChunk) fail("the first chunk is not JSON");
  if (json_length > length || kHeader + kChunkHeader + json_length > length) {
    fail(fmt::format("the JSON chunk of {} bytes does not fit", json_length));
  }
  const std::size_t next = kHeader + kChunkHeader + json_length;
  if (next + kChunkHeader <= length) {
    const std::size_t binary_length = word_at(bytes, next);
    if (word_at(bytes, next + 4) == kBinaryChunk && next + kChunkHeader + binary_length > length) {
      fail(fmt::format("the binary chunk of {} bytes does not fit", binary_length));
    }
  }
  return bytes.substr(kHeader + kChunkHeader, json_length);
}

bool file_exists(const std::string& path, void*) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

/// No expansion of ~ or $VARIABLES: a room file must not depend on who reads it.
std::string same_path(const std::string& path, void*) {
  return path;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& path, void*) {
  try {
    const std::string bytes = load_file(path, kLargestGltf);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const InputError& problem) {
    *error = problem.what();
    return false;
  }
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

/// Keeps the encoded bytes. Those in a buffer view are left where they are: the view has not been checked
/// yet.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

std::string word(std::size_t value) {
  std::string bytes(4, '\0');
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i));
  return bytes;
}

/// A GLB file with another JSON chunk. Pre: json_of_glb accepts it.
std::string with_json(const std::string& glb, std::string json) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t rest = kHeader + kChunkHeader + word_at(glb, kHeader);
  return glb.substr(0, 8) + word(kHeader + kChunkHeader + json.size() + glb.size() - rest) +
         word(json.size()) + word(kJsonChunk) + json + glb.substr(rest);
}

/// Messages of the parser on one line, without bytes that a terminal cannot show, and cut.
std::string tidy(const std::string& text) {
  constexpr std::size_t kLongest = 300;
  std::string line;
  for (const unsigned char c : text) {
    if (c >= 0x20 && c < 0x7f) line += static_cast<char>(c);
    if (c == '\n' && !line.empty() && line.back() != ' ') line += ' ';
    if (line.size() >= kLongest) return line + "...";
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

/// Pre: the file is no GLB.
void refuse_other_formats(const std::filesystem::path& file, const std::string& bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (lower_case_extension(file) == ".glb" && (start == std::string::npos || bytes[start] != '{'))
    throw InputError(file.string(), "it is no GLB file, which begins with 'glTF'",
                     "Was it damaged on its way, or is it of another format?");
}

/// Of glTF before 2.0, where lists were objects.
void refuse_earlier_versions(const nlohmann::json& document, const std::string& file) {
  const auto buffers = document.find("buffers");
  if (buffers == document.end() || !buffers->is_object()) return;
  throw InputError(file, "it is glTF 1.0", "Export glTF 2.0, or convert the file: gltf-pipeline does.");
}

/// Names the file of a buffer that is not there; one whose name has escaped characters is left to others.
void refuse_missing_buffers(const JsonCursor& document, const std::filesystem::path& folder) {
  const auto buffers = document.find("buffers");
  for (std::size_t i = 0; buffers && i < buffers->size(); ++i) {
    const auto uri = (*buffers)[i].find("uri");
    if (!uri) continue;
    const std::string& name = uri->string();
    std::error_code ignored;
    if (!name.starts_with("data:") && name.find('%') == std::string::npos &&
        !std::filesystem::exists(folder / name, ignored))
      uri->fail(fmt::format("there is no file '{}', which holds the geometry", tidy(name)),
                "Put it beside the room, or export the room as one file (.glb).");
  }
}

}  // namespace

GltfModel load_gltf_model(const std::filesystem::path& file) {
  GltfModel loaded;
  loaded.file = file.string();
  std::string bytes = load_file(file, kLargestGltf);
  const bool binary = bytes.compare(0, 4, "glTF") == 0;
  if (!binary) refuse_other_formats(file, bytes);
  // Strict parse first: it bounds the nesting, which the library follows recursively.
  const nlohmann::json document = parse_json(binary ? json_of_glb(bytes, loaded.file) : bytes, loaded.file);
  JsonCursor(document, loaded.file).expect_object();
  refuse_earlier_versions(document, loaded.file);
  check_gltf_extensions(document, loaded.file);
  check_gltf_document(document, loaded.file);
  if (const auto simplified = simplified_for_parser(document, file.parent_path()))
    bytes = binary ? with_json(bytes, simplified->dump()) : simplified->dump();
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(keep_encoded, nullptr);
  parser.SetFsCallbacks({file_exists, same_path, read_whole_file, write_nothing, nullptr});
  std::string errors, warnings;
  bool parsed = false;
  try {
    const std::string folder = file.parent_path().empty() ? "." : file.parent_path().string();
    const auto size = static_cast<unsigned int>(bytes.size());
    parsed =
        binary
            ? parser.LoadBinaryFromMemory(&loaded.model, &errors, &warnings,
                                          reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
            : parser.LoadASCIIFromString(&loaded.model, &errors, &warnings, bytes.data(), size, folder);
  } catch (const std::exception& problem) {
    errors = problem.what();
  }
  if (!parsed) {
    refuse_missing_buffers(JsonCursor(document, loaded.file), file.parent_path());
    throw InputError(loaded.file, tidy(errors.empty() ? "not a valid glTF file" : errors),
                     "Check the file with the Khronos glTF validator, or export it anew.");
  }
  if (loaded.model.asset.version.substr(0, 2) != "2.") {
    throw InputError(loaded.file, fmt::format("glTF version \"{}\"", tidy(loaded.model.asset.version)),
                     "Export glTF 2.0.");
  }
  if (!warnings.empty()) loaded.warnings.push_back(tidy(warnings));
  decode_meshopt_views(document, loaded);
  decode_draco_primitives(document, loaded);
  take_extended_texture_sources(document, loaded);
  return loaded;
}

}  // namespace reemit
