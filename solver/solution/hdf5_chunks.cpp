#include "solver/solution/hdf5_chunks.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace reemit {

Hdf5Chunks::Hdf5Chunks(const Hdf5Shape& dataset, std::size_t value_size)
    : dataset_(dataset), chunk_(dataset) {
  slice_bytes_ =
      std::accumulate(dataset.begin() + 1, dataset.end(), std::uint64_t{value_size}, std::multiplies<>());
  count_ = 1;
  while (slice_bytes_ > kMostBytes && cut_ + 1 < dataset.size()) {
    chunk_[cut_] = 1;
    count_ *= dataset[cut_];
    slice_bytes_ /= dataset[++cut_];
  }
  // Pieces of nearly one size: HDF5 stores the last one as if it were whole.
  const std::uint64_t length = dataset[cut_];
  const std::uint64_t most = std::clamp<std::uint64_t>(kMostBytes / slice_bytes_, 1, length);
  const std::uint64_t fewest = (length + most - 1) / most;
  chunk_[cut_] = (length + fewest - 1) / fewest;
  pieces_ = (length + chunk_[cut_] - 1) / chunk_[cut_];
  count_ *= pieces_;
}

Hdf5Shape Hdf5Chunks::place(std::uint64_t chunk) const {
  Hdf5Shape at(dataset_.size(), 0);
  at[cut_] = chunk % pieces_ * chunk_[cut_];
  std::uint64_t slice = chunk / pieces_;
  for (std::size_t d = cut_; d-- > 0; slice /= dataset_[d]) at[d] = slice % dataset_[d];
  return at;
}

std::span<const std::byte> Hdf5Chunks::part(std::span<const std::byte> dataset, std::uint64_t chunk) const {
  const std::uint64_t from = chunk % pieces_ * chunk_[cut_];
  const std::uint64_t length = std::min(chunk_[cut_], dataset_[cut_] - from);
  return dataset.subspan((chunk / pieces_ * dataset_[cut_] + from) * slice_bytes_, length * slice_bytes_);
}

}  // namespace reemit
