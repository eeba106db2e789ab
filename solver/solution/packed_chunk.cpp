#include "solver/solution/packed_chunk.h"

#include <new>

#include <zlib.h>

namespace reemit {
namespace {

/// First bytes of all values, then second ones: of numbers alike, many of these are the same.
std::vector<std::byte> shuffled(std::span<const std::byte> chunk, std::size_t value_size) {
  const std::size_t count = chunk.size() / value_size;
  std::vector<std::byte> bytes(chunk.size());
  for (std::size_t k = 0; k < value_size; ++k)
    for (std::size_t i = 0; i < count; ++i) bytes[k * count + i] = chunk[i * value_size + k];
  return bytes;
}

}  // namespace

std::vector<std::byte> packed_chunk(std::span<const std::byte> chunk, std::size_t value_size) {
  const std::vector<std::byte> bytes = shuffled(chunk, value_size);
  uLongf size = compressBound(bytes.size());
  std::vector<std::byte> packed(size);
  // The room that compressBound asks for is always enough, so that only memory can be short.
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), static_cast<int>(kDeflateLevel)) != Z_OK)
    throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

}  // namespace reemit
