#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "solver/solution/hdf5_group.h"

namespace reemit {

/// How a dataset is cut into chunks: small enough to compress in cache, large enough to be few. Every chunk
/// is a run of values without a gap, so it is cut along one dimension: the first with slices that are not too
/// large. Pre: the dataset has values, and their bytes can be counted.
class Hdf5Chunks {
 public:
  static constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 18;  ///< Unless a single value has more.

  Hdf5Chunks(const Hdf5Shape& dataset, std::size_t value_size);

  /// Shape and size of a chunk.
  const Hdf5Shape& shape() const { return chunk_; }
  std::uint64_t bytes() const { return chunk_[cut_] * slice_bytes_; }
  std::uint64_t count() const { return count_; }

  /// Where in the dataset the first value of a chunk is.
  Hdf5Shape place(std::uint64_t chunk) const;
  /// Those of the bytes of the dataset that are in a chunk: fewer than bytes() where it reaches beyond the
  /// end of the dimension that is cut.
  std::span<const std::byte> part(std::span<const std::byte> dataset, std::uint64_t chunk) const;

 private:
  Hdf5Shape dataset_;
  Hdf5Shape chunk_;
  std::size_t cut_ = 0;  // the dimension that is cut; those before it have chunks of one, those behind none
  std::uint64_t slice_bytes_ = 0;  // of one step along it
  std::uint64_t pieces_ = 0;       // along it
  std::uint64_t count_ = 0;
};

}  // namespace reemit
