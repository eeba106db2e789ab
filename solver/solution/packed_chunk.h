#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace reemit {

inline constexpr unsigned kDeflateLevel = 2;

/// A chunk of values of this size as HDF5's filters shuffle and deflate would store it; unlike HDF5's own, it
/// may be made on any thread. Deflated data end in a checksum of their own (Adler-32), which readers check.
/// Throws std::bad_alloc. Pre: the chunk has whole values.
std::vector<std::byte> packed_chunk(std::span<const std::byte> chunk, std::size_t value_size);

}  // namespace reemit
