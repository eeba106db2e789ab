// Datasets of any shape are cut into chunks of a size that HDF5 can hold and readers like.

#include "solver/solution/hdf5_chunks.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/solution/hdf5_memory_file.h"

namespace reemit {
namespace {

using testing::ElementsAre;

constexpr std::uint64_t kMostBytes = Hdf5Chunks::kMostBytes;

TEST(Hdf5Chunks, ASmallDatasetIsOne) {
  const Hdf5Chunks chunks({100, 3}, 8);
  EXPECT_THAT(chunks.shape(), ElementsAre(100, 3));
  EXPECT_EQ(chunks.count(), 1U);
}

TEST(Hdf5Chunks, SmallRowsStayWhole) {
  const Hdf5Chunks chunks({16, 8000, 3}, 4);
  EXPECT_THAT(chunks.shape(), ElementsAre(2, 8000, 3));
  EXPECT_EQ(chunks.count(), 8U);
  EXPECT_THAT(chunks.place(5), ElementsAre(10, 0, 0));
}

/// HDF5 refuses chunks of 4 GiB; a row of these has 12.
TEST(Hdf5Chunks, LargeRowsAreCut) {
  constexpr std::uint64_t kZones = std::uint64_t{1} << 28;
  const Hdf5Chunks chunks({16, kZones, 12}, 4);
  const std::uint64_t zones = chunks.shape()[1];
  EXPECT_THAT(chunks.shape(), ElementsAre(1, zones, 12));
  EXPECT_LE(chunks.bytes(), kMostBytes);
  EXPECT_GT(chunks.bytes(), kMostBytes / 2);
  const std::uint64_t of_row = (kZones + zones - 1) / zones;
  EXPECT_EQ(chunks.count(), 16 * of_row);
  EXPECT_THAT(chunks.place(of_row - 1), ElementsAre(0, (of_row - 1) * zones, 0));
  EXPECT_THAT(chunks.place(of_row + 2), ElementsAre(1, 2 * zones, 0));
}

TEST(Hdf5Chunks, SoAreLargeSlicesOfRows) {
  const Hdf5Chunks chunks({2, 3, kMostBytes}, 4);
  EXPECT_THAT(chunks.shape(), ElementsAre(1, 1, kMostBytes / 4));
  EXPECT_EQ(chunks.count(), 24U);
  EXPECT_THAT(chunks.place(4 * 5 + 3), ElementsAre(1, 2, 3 * kMostBytes / 4));
}

/// Long texts are values of one chunk each.
TEST(Hdf5Chunks, ALargeValueIsOne) {
  const Hdf5Chunks chunks({3}, 2 * kMostBytes);
  EXPECT_THAT(chunks.shape(), ElementsAre(1));
  EXPECT_EQ(chunks.bytes(), 2 * kMostBytes);
}

TEST(Hdf5Chunks, TheyHoldAllBytesInOrder) {
  const std::vector<std::byte> bytes(std::size_t{3} * 100'003 * 5);
  const Hdf5Chunks chunks({3, 100'003, 5}, 1);
  EXPECT_GT(chunks.count(), 3U);
  std::size_t end = 0;
  for (std::uint64_t c = 0; c < chunks.count(); ++c) {
    const std::span<const std::byte> part = chunks.part(bytes, c);
    const Hdf5Shape at = chunks.place(c);
    EXPECT_EQ(part.data(), bytes.data() + end);
    EXPECT_EQ((at[0] * 100'003 + at[1]) * 5 + at[2], end);
    EXPECT_LE(part.size(), chunks.bytes());
    end += part.size();
  }
  EXPECT_EQ(end, bytes.size());
}

TEST(Hdf5Chunks, CutRowsComeBack) {
  const Hdf5MemoryFile file;
  std::vector<float> values(std::size_t{3} * 100'003 * 2);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  const Hdf5Shape shape{3, 100'003, 2};
  file.root().write<float>("rows", values, shape, "", "values");
  EXPECT_EQ(file.root().read<float>("rows", shape), values);
}

}  // namespace
}  // namespace reemit
