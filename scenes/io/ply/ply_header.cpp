#include "scenes/io/ply/ply_header.h"

#include <charconv>
#include <map>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "scenes/model/error.h"

namespace reemit {

namespace {

PlyType type_named(const std::string& name, const std::string& where) {
  static const std::map<std::string, PlyType> types{
      {"char", PlyType::kInt8},     {"int8", PlyType::kInt8},     {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},   {"short", PlyType::kInt16},   {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16}, {"uint16", PlyType::kUint16}, {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},   {"uint", PlyType::kUint32},   {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat},   {"float32", PlyType::kFloat}, {"double", PlyType::kDouble},
      {"float64", PlyType::kDouble}};
  const auto it = types.find(name);
  if (it == types.end()) {
    throw InputError(where, fmt::format("\"{}\" is no PLY type", name),
                     "Use char ... double or int8 ... float64.");
  }
  return it->second;
}

PlyFormat format_named(const std::string& name, const std::string& where) {
  if (name == "ascii") return PlyFormat::kAscii;
  if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (name == "binary_big_endian") return PlyFormat::kBigEndian;
  throw InputError(where, fmt::format("\"{}\" is no PLY format", name),
                   "Known are: ascii, binary_little_endian, binary_big_endian.");
}

std::uint64_t read_count(const std::string& text, const std::string& where) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
    throw InputError(where, fmt::format("\"{}\" is no count of elements", text), "Write a whole number.");
  }
  return count;
}

/// The fewest bytes that one element takes; in ASCII at least a digit and a separator for each value.
std::uint64_t least_size(const PlyElement& element, PlyFormat format) {
  std::uint64_t size = 0;
  for (const PlyProperty& property : element.properties) {
    size += format == PlyFormat::kAscii ? 2 : size_of(property.is_list ? property.count_type : property.type);
  }
  return size;
}

void check_counts(const PlyHeader& header, std::size_t file_size, const std::string& file) {
  const std::uint64_t available =
      file_size - header.size + 1;  // The last value of a text needs no separator.
  std::uint64_t needed = 0;
  for (const PlyElement& element : header.elements) {
    const std::uint64_t each = least_size(element, header.format);
    if (each == 0) {
      if (element.count == 0) continue;
      throw InputError(file, fmt::format("the element \"{}\" has no properties", element.name),
                       "Write the file anew.");
    }
    if (element.count > available / each || (needed += element.count * each) > available) {
      throw InputError(
          file, fmt::format("{} elements \"{}\" do not fit into the file", element.count, element.name),
          "The file is damaged or cut off; write it anew.");
    }
  }
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat:
      return 4;
    case PlyType::kDouble:
      break;
  }
  return 8;
}

PlyHeader read_ply_header(const std::string& bytes, const std::string& file) {
  PlyHeader header{PlyFormat::kAscii, {}, 0, 0};
  std::optional<PlyFormat> format;
  while (true) {
    const std::string where = fmt::format("{}:{}", file, header.lines + 1);
    const std::size_t end = bytes.find('\n', header.size);
    if (end == std::string::npos)
      throw InputError(where, "the PLY header does not end", "The file is cut off.");
    std::istringstream line(bytes.substr(header.size, end - header.size));
    header.size = end + 1;
    ++header.lines;
    std::string keyword;
    line >> keyword;
    if (header.lines == 1) {
      if (keyword != "ply")
        throw InputError(where, "the file does not start with \"ply\"", "This is no PLY file.");
    } else if (keyword == "format") {
      std::string name;
      line >> name;
      format = format_named(name, where);
    } else if (keyword == "element") {
      std::string name, count;
      line >> name >> count;
      header.elements.push_back({name, read_count(count, where), {}});
    } else if (keyword == "property") {
      if (header.elements.empty())
        throw InputError(where, "a property before any element", "Write the file anew.");
      std::string type, count_type, name;
      line >> type;
      const bool is_list = type == "list";
      if (is_list) line >> count_type >> type;
      line >> name;
      header.elements.back().properties.push_back(
          {name, type_named(type, where), is_list,
           is_list ? type_named(count_type, where) : PlyType::kUint8});
    } else if (keyword == "end_header") {
      break;
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty() &&
               !header.elements.empty()) {  // before them old programs say who they are
      throw InputError(where, "a line that is no part of a PLY header",
                       "The file is damaged; write it anew.");
    }
  }
  if (!format) throw InputError(file, "the PLY header names no format", "Add \"format ascii 1.0\".");
  header.format = *format;
  check_counts(header, bytes.size(), file);
  return header;
}

}  // namespace reemit
