#include "solver/solution/packed_chunk.h"

#include <algorithm>
#include <cmath>
#include <new>

#include <zlib.h>

namespace reemit {
namespace {

/// Place of the filters in the pipeline, as bits of PackedChunk::skipped.
constexpr std::uint32_t kDeflateFilter = 1U << 1;

/// The first bytes of all values, then the second ones, and so on.
std::vector<unsigned char> shuffled(const unsigned char* bytes, std::size_t size, std::size_t value_size) {
  std::vector<unsigned char> out(size);
  const std::size_t count = size / value_size;
  for (std::size_t k = 0; k < value_size; ++k)
    for (std::size_t i = 0; i < count; ++i) out[k * count + i] = bytes[i * value_size + k];
  return out;
}

/// As H5_checksum_fletcher32: 16-bit words, high byte first.
std::uint32_t fletcher32(const std::vector<unsigned char>& bytes) {
  constexpr std::size_t kWordsBetweenFolds = 360;
  std::uint32_t sum1 = 0;
  std::uint32_t sum2 = 0;
  const auto fold = [&] {
    sum1 = (sum1 & 0xffffU) + (sum1 >> 16);
    sum2 = (sum2 & 0xffffU) + (sum2 >> 16);
  };
  std::size_t words = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    sum1 += static_cast<std::uint32_t>(bytes[i]) << 8 | bytes[i + 1];
    sum2 += sum1;
    if (++words % kWordsBetweenFolds == 0) fold();
  }
  if (words % kWordsBetweenFolds != 0) fold();
  if (bytes.size() % 2 != 0) {
    sum1 += static_cast<std::uint32_t>(bytes.back()) << 8;
    sum2 += sum1;
    fold();
  }
  fold();
  return sum2 << 16 | sum1;
}

}  // namespace

PackedChunk pack_chunk(const unsigned char* bytes, std::size_t size, std::size_t value_size,
                       int deflate_level) {
  PackedChunk chunk;
  const std::vector<unsigned char> ordered = shuffled(bytes, size, value_size);
  // The room that HDF5 gives it; what needs more stays as it is.
  auto packed = static_cast<uLongf>(std::ceil(static_cast<double>(size) * 1.001) + 12);
  chunk.bytes.resize(packed);
  const int result =
      compress2(chunk.bytes.data(), &packed, ordered.data(), static_cast<uLong>(size), deflate_level);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  if (result == Z_OK) {
    chunk.bytes.resize(packed);
  } else {
    chunk.bytes = ordered;
    chunk.skipped |= kDeflateFilter;
  }
  const std::uint32_t sum = fletcher32(chunk.bytes);
  for (int shift = 0; shift < 32; shift += 8) chunk.bytes.push_back(static_cast<unsigned char>(sum >> shift));
  return chunk;
}

}  // namespace reemit
