// Chunks that are packed outside of HDF5 are those that it would write, and damage in them is noticed.

#include "solver/solution/packed_chunk.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "solver/solution/hdf5_memory_file.h"

namespace reemit {
namespace {

/// A dataset of one chunk with the filters of solution files, in a file in memory.
class OneChunk {
 public:
  /// `name` tells files apart that are open at the same time.
  OneChunk(const char* name, hid_t type, hsize_t count)
      : type_(type), file_(file_in_memory(name)), dataset_(new_dataset(file_.get(), type, count)) {}
  void write_by_hdf5(const void* values) const {
    ASSERT_GE(H5Dwrite(dataset_.get(), type_, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0);
    ASSERT_GE(H5Dflush(dataset_.get()), 0);
  }
  void write_packed(std::span<const std::byte> packed) const {
    const hsize_t first = 0;
    ASSERT_GE(H5Dwrite_chunk(dataset_.get(), H5P_DEFAULT, 0, &first, packed.size(), packed.data()), 0);
  }
  std::vector<std::byte> stored() const {
    const hsize_t first = 0;
    hsize_t size = 0;
    EXPECT_GE(H5Dget_chunk_storage_size(dataset_.get(), &first, &size), 0);
    std::vector<std::byte> bytes(size);
    std::uint32_t mask = 0;
    EXPECT_GE(H5Dread_chunk(dataset_.get(), H5P_DEFAULT, &first, &mask, bytes.data()), 0);
    return bytes;
  }
  bool reads_as(void* values) const {
    return H5Dread(dataset_.get(), type_, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  }

 private:
  static Hdf5Id file_in_memory(const char* name) {
    const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "access");
    H5Pset_fapl_core(access.get(), 1 << 16, false);
    return {H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose, "file"};
  }
  static Hdf5Id new_dataset(hid_t file, hid_t type, hsize_t count) {
    const Hdf5Id space(H5Screate_simple(1, &count, nullptr), H5Sclose, "space");
    const Hdf5Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "properties");
    H5Pset_chunk(properties.get(), 1, &count);
    H5Pset_shuffle(properties.get());
    H5Pset_deflate(properties.get(), kDeflateLevel);
    return {H5Dcreate2(file, "values", type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
            H5Dclose, "dataset"};
  }

  hid_t type_;
  Hdf5Id file_;
  Hdf5Id dataset_;
};

template <class T>
std::vector<T> smooth_values(std::size_t count) {
  std::vector<T> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] = static_cast<T>(100 + 50 * std::sin(0.01 * static_cast<double>(i)));
  return values;
}

template <class T>
void expect_like_hdf5(hid_t type) {
  const std::vector<T> values = smooth_values<T>(5001);
  const std::vector<std::byte> packed = packed_chunk(std::as_bytes(std::span(values)), sizeof(T));
  EXPECT_LT(packed.size(), values.size() * sizeof(T));
  const OneChunk by_hdf5("by HDF5", type, values.size());
  by_hdf5.write_by_hdf5(values.data());
  EXPECT_EQ(by_hdf5.stored(), packed);
  const OneChunk ours("ours", type, values.size());
  ours.write_packed(packed);
  std::vector<T> read(values.size());
  ASSERT_TRUE(ours.reads_as(read.data()));
  EXPECT_EQ(read, values);
}

TEST(PackedChunk, IsWhatHdf5Stores) {
  expect_like_hdf5<std::uint8_t>(H5T_STD_U8LE);
  expect_like_hdf5<float>(H5T_IEEE_F32LE);
  expect_like_hdf5<double>(H5T_IEEE_F64LE);
}

/// More chunks than are packed at once, the last of them not full; and rows of several chunks each.
TEST(PackedChunk, ManyOfThemComeBack) {
  const Hdf5MemoryFile file;
  const Hdf5Group root = file.root();
  const std::vector<float> values = smooth_values<float>(3'000'003);
  root.write<float>("long", values, {values.size()}, "", "values");
  EXPECT_EQ(root.read<float>("long", {values.size()}), values);
  root.write<float>("rows", values, {3, values.size() / 3}, "", "values");
  EXPECT_EQ(root.read<float>("rows", {3, values.size() / 3}), values);
}

TEST(PackedChunk, DamageIsNoticed) {
  const Hdf5Quiet quiet;
  const std::vector<float> values = smooth_values<float>(5001);
  const std::vector<std::byte> packed = packed_chunk(std::as_bytes(std::span(values)), sizeof(float));
  std::vector<float> read(values.size());
  for (std::size_t i = 0; i < packed.size(); i += 97) {
    std::vector<std::byte> damaged = packed;
    damaged[i] ^= std::byte{4};
    const OneChunk chunk("damaged", H5T_IEEE_F32LE, values.size());
    chunk.write_packed(damaged);
    EXPECT_FALSE(chunk.reads_as(read.data()) && read != values) << "byte " << i;
  }
}

}  // namespace
}  // namespace reemit
