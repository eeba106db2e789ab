#include "solver/solution/packed_chunk.h"

#include <cstring>
#include <random>

#include <gtest/gtest.h>
#include <hdf5.h>

namespace reemit {
namespace {

constexpr unsigned kLevel = 2;

/// What HDF5 itself makes of one chunk of `count` values.
std::vector<unsigned char> packed_by_hdf5(const void* values, hsize_t count, hid_t type,
                                          std::uint32_t& skipped) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, 1 << 20, 0);
  const hid_t file = H5Fcreate("in memory", H5F_ACC_TRUNC, H5P_DEFAULT, access);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(properties, 1, &count);
  H5Pset_shuffle(properties);
  H5Pset_deflate(properties, kLevel);
  H5Pset_fletcher32(properties);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t dataset = H5Dcreate2(file, "values", type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Fflush(file, H5F_SCOPE_LOCAL);
  const hsize_t offset = 0;
  hsize_t size = 0;
  H5Dget_chunk_storage_size(dataset, &offset, &size);
  std::vector<unsigned char> bytes(size);
  H5Dread_chunk(dataset, H5P_DEFAULT, &offset, &skipped, bytes.data());
  H5Dclose(dataset);
  H5Sclose(space);
  H5Pclose(properties);
  H5Fclose(file);
  H5Pclose(access);
  return bytes;
}

template <class T>
void expect_same(const std::vector<T>& values, hid_t type) {
  std::uint32_t skipped = 77;
  const std::vector<unsigned char> expected = packed_by_hdf5(values.data(), values.size(), type, skipped);
  std::vector<unsigned char> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  const PackedChunk chunk = pack_chunk(bytes.data(), bytes.size(), sizeof(T), kLevel);
  EXPECT_EQ(chunk.skipped, skipped);
  EXPECT_TRUE(chunk.bytes == expected);
}

TEST(PackedChunk, has_the_bytes_that_hdf5_would_write) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {1U, 3U, 359U, 720U, 4097U, 30'000U}) {
    std::vector<double> doubles(count, 0.0);
    expect_same(doubles, H5T_IEEE_F64LE);
    for (std::size_t i = 0; i < count; i += 3) doubles[i] = 1.5 + static_cast<double>(i % 100);
    expect_same(doubles, H5T_IEEE_F64LE);
    std::vector<std::uint64_t> noise(count);
    for (std::uint64_t& n : noise) n = random();
    expect_same(noise, H5T_STD_U64LE);
    std::vector<float> floats(count);
    for (std::size_t i = 0; i < count; ++i) floats[i] = static_cast<float>(i) / 7;
    expect_same(floats, H5T_IEEE_F32LE);
    std::vector<std::uint8_t> flags(count);
    for (std::size_t i = 0; i < count; ++i) flags[i] = i % 5 == 0 ? 1 : 0;
    expect_same(flags, H5T_STD_U8LE);
  }
}

}  // namespace
}  // namespace reemit
