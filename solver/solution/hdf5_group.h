#pragma once
#include <concepts>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "solver/solution/packing.h"

namespace reemit {

/// A failed HDF5 call, with the reason HDF5 gives. Callers turn it into an error about their file.
class Hdf5Error : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Owner of an HDF5 identifier.
class Hdf5Id {
 public:
  using Closer = herr_t (*)(hid_t);

  /// Throws Hdf5Error naming `what` if `id` is the result of a failed call.
  Hdf5Id(hid_t id, Closer closer, const std::string& what);
  ~Hdf5Id() { close_quietly(); }
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), closer_(other.closer_) {}
  Hdf5Id& operator=(Hdf5Id&& other) noexcept;

  hid_t get() const { return id_; }
  void close(const std::string& what);  ///< Throws Hdf5Error if closing fails.

 private:
  void close_quietly();

  hid_t id_;
  Closer closer_;
};

/// Throws Hdf5Error naming `what` and HDF5's reason if the result of a call says that it failed.
void check_hdf5(herr_t result, const std::string& what);

/// Keeps HDF5 from printing its error stack while in scope: we report errors ourselves.
class Hdf5Quiet {
 public:
  Hdf5Quiet();
  ~Hdf5Quiet();
  Hdf5Quiet(const Hdf5Quiet&) = delete;
  Hdf5Quiet& operator=(const Hdf5Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

template <class T>
concept Hdf5Number = std::same_as<T, float> || std::same_as<T, double> || std::same_as<T, std::uint8_t> ||
    std::same_as<T, std::int32_t> || std::same_as<T, std::uint32_t> || std::same_as<T, std::int64_t> ||
    std::same_as<T, std::uint64_t>;

/// Identifier of the little-endian file type of a number.
template <Hdf5Number T>
hid_t hdf5_type();

using Hdf5Shape = std::vector<std::uint64_t>;

/// A group of an HDF5 file. Every dataset is compressed and carries a checksum, but for chunks that are
/// written after packing has ended; a unit and a description. Strings are stored as fixed-length UTF-8,
/// padded with zeros.
class Hdf5Group {
 public:
  /// `path` for messages, as in "/mesh".
  /// `packing` (may be null: always) holds for groups that are created in this one, and must outlive them.
  Hdf5Group(Hdf5Id id, std::string path, const Packing* packing = nullptr)
      : id_(std::move(id)), path_(std::move(path)), packing_(packing) {}

  Hdf5Group create_group(const std::string& name) const;
  Hdf5Group open_group(const std::string& name) const;

  void write_attribute(const std::string& name, const std::string& text) const;
  template <Hdf5Number T>
  void write_attribute(const std::string& name, T value) const;
  bool has_attribute(const std::string& name) const;
  std::string read_text_attribute(const std::string& name) const;
  template <Hdf5Number T>
  T read_attribute(const std::string& name) const;

  /// Writes values in row-major order; their number must be the product of the shape.
  template <Hdf5Number T>
  void write(const std::string& name, std::span<const T> values, const Hdf5Shape& shape,
             const std::string& unit, const std::string& description) const;
  void write(const std::string& name, std::span<const std::string> texts,
             const std::string& description) const;

  bool has_dataset(const std::string& name) const;
  /// Shape of a dataset.
  Hdf5Shape shape(const std::string& name) const;
  /// Reads a dataset of the given shape and kind of number. Throws Hdf5Error for another shape, and when the
  /// file is too small to hold that many values, before anything is allocated.
  template <Hdf5Number T>
  std::vector<T> read(const std::string& name, const Hdf5Shape& expected) const;
  std::vector<std::string> read_texts(const std::string& name) const;

 private:
  bool packs() const { return packing_ == nullptr || packing_->goes_on(); }
  Hdf5Id create_dataset(const std::string& name, hid_t type, std::size_t value_size, const Hdf5Shape& shape,
                        const std::string& unit, const std::string& description) const;
  Hdf5Id open_dataset(const std::string& name) const;
  void write_raw_attribute(const std::string& name, hid_t type, const void* value) const;
  void read_raw_attribute(const std::string& name, hid_t type, void* value) const;
  std::string full_name(const std::string& name) const;

  Hdf5Id id_;
  std::string path_;
  const Packing* packing_;
};

}  // namespace reemit
