#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace reemit {

/// How values behind the header are written.
enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
/// Types of values, by either of the names that a header may use: "char" or "int8".
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

std::size_t size_of(PlyType type);  ///< [byte]

struct PlyProperty {
  std::string name;
  PlyType type;  ///< Of the value, or of the values of a list.
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< Of the length of a list.
};

struct PlyElement {
  std::string name;
  std::uint64_t count;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format;
  std::vector<PlyElement> elements;
  std::size_t size;   ///< Bytes up to and including the line end_header.
  std::size_t lines;  ///< Of the header.
};

/// Parses the header. Throws InputError; a count that the rest of the file cannot hold is one.
PlyHeader read_ply_header(const std::string& bytes, const std::string& file);

}  // namespace reemit
