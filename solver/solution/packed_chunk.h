#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace reemit {

/// A chunk of a dataset as HDF5 stores it, made by the filters that it would run itself, to the same bytes:
/// shuffle, deflate, Fletcher's checksum. HDF5 packs one chunk after the other in one thread; these may be
/// packed side by side, and most of saving a large solution is packing.
struct PackedChunk {
  std::vector<unsigned char> bytes;
  std::uint32_t skipped = 0;  ///< Filters that were not applied, as H5Dwrite_chunk takes them.
};

/// Packs `size` bytes, the whole of a chunk, of numbers of `value_size` bytes each.
PackedChunk pack_chunk(const unsigned char* bytes, std::size_t size, std::size_t value_size,
                       int deflate_level);

}  // namespace reemit
