#include "solver/solution/hdf5_group.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

#include <tbb/parallel_for.h>

#include "solver/solution/hdf5_chunks.h"
#include "solver/solution/packed_chunk.h"

namespace reemit {
namespace {

// The innermost message of HDF5's error stack: the reason, where the outer ones only say who passed it on.
std::string last_reason() {
  std::string reason;
  const auto take_first = [](unsigned /*depth*/, const H5E_error2_t* error, void* out) -> herr_t {
    auto& text = *static_cast<std::string*>(out);
    if (text.empty() && error->desc != nullptr) text = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &reason);
  H5Eclear2(H5E_DEFAULT);
  return reason;
}

[[noreturn]] void raise(const std::string& what) {
  const std::string reason = last_reason();
  throw Hdf5Error(reason.empty() ? what : what + " (" + reason + ")");
}

std::uint64_t value_count(const Hdf5Shape& shape) {
  std::uint64_t count = 1;
  for (const std::uint64_t n : shape) {
    if (n != 0 && count > std::numeric_limits<std::uint64_t>::max() / n)
      throw Hdf5Error("a shape that overflows");
    count *= n;
  }
  return count;
}

Hdf5Id make_space(const Hdf5Shape& shape) {
  const std::vector<hsize_t> dims(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose,
          "cannot make a dataspace"};
}

Hdf5Id scalar_space() {
  return {H5Screate(H5S_SCALAR), H5Sclose, "cannot make a dataspace"};
}

Hdf5Id text_type(std::size_t length) {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose, "cannot make a string type");
  check_hdf5(H5Tset_size(type.get(), std::max<std::size_t>(length, 1)), "cannot make a string type");
  check_hdf5(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "cannot make a string type");
  check_hdf5(H5Tset_cset(type.get(), H5T_CSET_UTF8), "cannot make a string type");
  return type;
}

// Length of the strings of a type; 0 if it is none of fixed length.
std::size_t text_length(hid_t type) {
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return 0;
  return H5Tget_size(type);
}

std::string without_padding(const char* text, std::size_t length) {
  return {text, static_cast<std::size_t>(std::find(text, text + length, '\0') - text)};
}

template <class T>
constexpr H5T_class_t kClass = std::is_floating_point_v<T> ? H5T_FLOAT : H5T_INTEGER;

// Properties of a new object without the times that HDF5 would put into it: the same solution must give the
// same bytes.
Hdf5Id timeless_properties(hid_t kind) {
  const char* what = "cannot make object properties";
  Hdf5Id properties(H5Pcreate(kind), H5Pclose, what);
  check_hdf5(H5Pset_obj_track_times(properties.get(), false), what);
  return properties;
}

Hdf5Id dataset_properties(const Hdf5Shape& shape, std::size_t value_size) {
  Hdf5Id properties = timeless_properties(H5P_DATASET_CREATE);
  if (value_count(shape) == 0) return properties;  // nothing to cut into chunks
  const Hdf5Shape of_chunk = Hdf5Chunks(shape, value_size).shape();
  const std::vector<hsize_t> chunk(of_chunk.begin(), of_chunk.end());
  const char* what = "cannot set dataset properties";
  check_hdf5(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), what);
  check_hdf5(H5Pset_shuffle(properties.get()), what);
  check_hdf5(H5Pset_deflate(properties.get(), kDeflateLevel), what);
  return properties;
}

// What H5Dwrite_chunk is told of the filters that were left out.
constexpr std::uint32_t kAllFilters = 0;
constexpr std::uint32_t kNoFilters = 0xffffffff;
// Packed at once: enough for many threads, few enough to be done in the moment that Packing allows.
constexpr std::uint64_t kChunksAtOnce = 16;

// Writes a dataset chunk by chunk, packed side by side; those for which `packs` is false without filters.
template <class Packs>
void write_chunks(hid_t dataset, std::span<const std::byte> bytes, const Hdf5Shape& shape,
                  std::size_t value_size, const Packs& packs, const std::string& what) {
  const Hdf5Chunks chunks(shape, value_size);
  const auto whole_chunk = [&](std::uint64_t c) {
    const auto found = chunks.part(bytes, c);
    std::vector<std::byte> whole(chunks.bytes());  // may be larger than what is left
    std::copy(found.begin(), found.end(), whole.begin());
    return whole;
  };
  std::vector<std::vector<std::byte>> stored(kChunksAtOnce);
  for (std::uint64_t first = 0; first < chunks.count(); first += kChunksAtOnce) {
    const std::uint64_t end = std::min(first + kChunksAtOnce, chunks.count());
    const bool is_packed = packs();
    tbb::parallel_for(first, end, [&](std::uint64_t c) {
      std::vector<std::byte> whole = whole_chunk(c);
      stored[c - first] = is_packed ? packed_chunk(whole, value_size) : std::move(whole);
    });
    for (std::uint64_t c = first; c < end; ++c) {
      const Hdf5Shape place = chunks.place(c);
      const std::vector<hsize_t> at(place.begin(), place.end());
      const std::vector<std::byte>& chunk = stored[c - first];
      check_hdf5(H5Dwrite_chunk(dataset, H5P_DEFAULT, is_packed ? kAllFilters : kNoFilters, at.data(),
                                chunk.size(), chunk.data()),
                 what);
    }
  }
}

// Deflate packs at most 1032 bytes into one, so a larger claim comes from a damaged file.
void check_plausible(hid_t dataset, std::uint64_t values, std::size_t value_size, const std::string& name) {
  constexpr std::uint64_t kLargestRatio = 1032;
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  if (values > 0 && values / kLargestRatio > stored / value_size)
    throw Hdf5Error(name + " claims more values than the file holds");
}

}  // namespace

Hdf5Id::Hdf5Id(hid_t id, Closer closer, const std::string& what) : id_(id), closer_(closer) {
  if (id_ < 0) raise(what);
}

Hdf5Id& Hdf5Id::operator=(Hdf5Id&& other) noexcept {
  if (this != &other) {
    close_quietly();
    id_ = std::exchange(other.id_, H5I_INVALID_HID);
    closer_ = other.closer_;
  }
  return *this;
}

void Hdf5Id::close(const std::string& what) {
  if (id_ >= 0) check_hdf5(closer_(std::exchange(id_, H5I_INVALID_HID)), what);
}

void Hdf5Id::close_quietly() {
  if (id_ >= 0) closer_(std::exchange(id_, H5I_INVALID_HID));
}

void check_hdf5(herr_t result, const std::string& what) {
  if (result < 0) raise(what);
}

Hdf5Quiet::Hdf5Quiet() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Quiet::~Hdf5Quiet() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

template <Hdf5Number T>
hid_t hdf5_type() {
  if constexpr (std::same_as<T, float>) return H5T_IEEE_F32LE;
  if constexpr (std::same_as<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::same_as<T, std::uint8_t>) return H5T_STD_U8LE;
  if constexpr (std::same_as<T, std::int32_t>) return H5T_STD_I32LE;
  if constexpr (std::same_as<T, std::uint32_t>) return H5T_STD_U32LE;
  if constexpr (std::same_as<T, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::same_as<T, std::uint64_t>) return H5T_STD_U64LE;
}

std::string Hdf5Group::full_name(const std::string& name) const {
  return path_ == "/" ? "/" + name : path_ + "/" + name;
}

Hdf5Group Hdf5Group::create_group(const std::string& name) const {
  const std::string full = full_name(name);
  const Hdf5Id properties = timeless_properties(H5P_GROUP_CREATE);
  return {Hdf5Id(H5Gcreate2(id_.get(), name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Gclose,
                 "cannot create the group " + full),
          full, packing_};
}

Hdf5Group Hdf5Group::open_group(const std::string& name) const {
  const std::string full = full_name(name);
  return {Hdf5Id(H5Gopen2(id_.get(), name.c_str(), H5P_DEFAULT), H5Gclose, "no group " + full), full};
}

void Hdf5Group::write_raw_attribute(const std::string& name, hid_t type, const void* value) const {
  const std::string what = "cannot write the attribute " + name + " of " + path_;
  const Hdf5Id space = scalar_space();
  const Hdf5Id attribute(H5Acreate2(id_.get(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, what);
  check_hdf5(H5Awrite(attribute.get(), type, value), what);
}

void Hdf5Group::write_attribute(const std::string& name, const std::string& text) const {
  const Hdf5Id type = text_type(text.size());
  write_raw_attribute(name, type.get(), text.c_str());
}

template <Hdf5Number T>
void Hdf5Group::write_attribute(const std::string& name, T value) const {
  write_raw_attribute(name, hdf5_type<T>(), &value);
}

bool Hdf5Group::has_attribute(const std::string& name) const {
  return H5Aexists(id_.get(), name.c_str()) > 0;
}

bool Hdf5Group::has_dataset(const std::string& name) const {
  return H5Lexists(id_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

void Hdf5Group::read_raw_attribute(const std::string& name, hid_t type, void* value) const {
  const std::string what = "no usable attribute " + name + " of " + path_;
  const Hdf5Id attribute(H5Aopen(id_.get(), name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const Hdf5Id space(H5Aget_space(attribute.get()), H5Sclose, what);
  const Hdf5Id stored(H5Aget_type(attribute.get()), H5Tclose, what);
  if (H5Sget_simple_extent_npoints(space.get()) != 1 || H5Tget_class(stored.get()) != H5Tget_class(type))
    raise(what);
  check_hdf5(H5Aread(attribute.get(), type, value), what);
}

std::string Hdf5Group::read_text_attribute(const std::string& name) const {
  const std::string what = "no usable attribute " + name + " of " + path_;
  const Hdf5Id attribute(H5Aopen(id_.get(), name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const Hdf5Id stored(H5Aget_type(attribute.get()), H5Tclose, what);
  constexpr std::size_t kLongestText = 1 << 20;
  const std::size_t length = text_length(stored.get());
  if (length == 0 || length > kLongestText) raise(what);
  std::string text(length, '\0');
  const Hdf5Id type = text_type(length);
  read_raw_attribute(name, type.get(), text.data());
  return without_padding(text.data(), length);
}

template <Hdf5Number T>
T Hdf5Group::read_attribute(const std::string& name) const {
  T value{};
  read_raw_attribute(name, hdf5_type<T>(), &value);
  return value;
}

Hdf5Id Hdf5Group::create_dataset(const std::string& name, hid_t type, std::size_t value_size,
                                 const Hdf5Shape& shape, const std::string& unit,
                                 const std::string& description) const {
  const std::string full = full_name(name);
  const Hdf5Id space = make_space(shape);
  const Hdf5Id properties = dataset_properties(shape, value_size);
  Hdf5Id dataset(
      H5Dcreate2(id_.get(), name.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
      H5Dclose, "cannot create the dataset " + full);
  check_hdf5(H5Iinc_ref(dataset.get()),
             "cannot write the dataset " + full);  // shared with the group object below
  const Hdf5Group notes(Hdf5Id(dataset.get(), H5Dclose, full), full);
  if (!unit.empty()) notes.write_attribute("unit", unit);
  notes.write_attribute("description", description);
  return dataset;
}

template <Hdf5Number T>
void Hdf5Group::write(const std::string& name, std::span<const T> values, const Hdf5Shape& shape,
                      const std::string& unit, const std::string& description) const {
  if (values.size() != value_count(shape))
    throw std::invalid_argument(full_name(name) + ": the number of values does not fit the shape");
  Hdf5Id dataset = create_dataset(name, hdf5_type<T>(), sizeof(T), shape, unit, description);
  const std::string what = "cannot write the dataset " + full_name(name);
  static_assert(std::endian::native == std::endian::little, "chunks are stored as they are");
  if (!values.empty())
    write_chunks(
        dataset.get(), std::as_bytes(values), shape, sizeof(T), [&] { return packs(); }, what);
  dataset.close(what);
}

void Hdf5Group::write(const std::string& name, std::span<const std::string> texts,
                      const std::string& description) const {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  std::string padded;
  padded.reserve(length * texts.size());
  for (const std::string& text : texts) {
    padded += text;
    padded.append(length - text.size(), '\0');
  }
  const Hdf5Id type = text_type(length);
  Hdf5Id dataset = create_dataset(name, type.get(), length, {texts.size()}, "", description);
  const std::string what = "cannot write the dataset " + full_name(name);
  if (!texts.empty())
    write_chunks(
        dataset.get(), std::as_bytes(std::span(padded)), {texts.size()}, length, [&] { return packs(); },
        what);
  dataset.close(what);
}

Hdf5Id Hdf5Group::open_dataset(const std::string& name) const {
  return {H5Dopen2(id_.get(), name.c_str(), H5P_DEFAULT), H5Dclose, "no dataset " + full_name(name)};
}

Hdf5Shape Hdf5Group::shape(const std::string& name) const {
  const Hdf5Id dataset = open_dataset(name);
  const Hdf5Id space(H5Dget_space(dataset.get()), H5Sclose, "no usable dataset " + full_name(name));
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 1 || rank > 3) raise("the dataset " + full_name(name) + " has an unknown shape");
  std::vector<hsize_t> dims(static_cast<std::size_t>(rank));
  if (H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr) != rank)
    raise("no usable dataset " + full_name(name));
  return {dims.begin(), dims.end()};
}

template <Hdf5Number T>
std::vector<T> Hdf5Group::read(const std::string& name, const Hdf5Shape& expected) const {
  const std::string full = full_name(name);
  if (shape(name) != expected) raise("the dataset " + full + " has an unexpected shape");
  const Hdf5Id dataset = open_dataset(name);
  const Hdf5Id stored(H5Dget_type(dataset.get()), H5Tclose, "no usable dataset " + full);
  if (H5Tget_class(stored.get()) != kClass<T>) raise("the dataset " + full + " has an unexpected type");
  const std::uint64_t count = value_count(expected);
  check_plausible(dataset.get(), count, sizeof(T), full);
  std::vector<T> values(count);
  if (count > 0)
    check_hdf5(H5Dread(dataset.get(), hdf5_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
               "cannot read the dataset " + full);
  return values;
}

std::vector<std::string> Hdf5Group::read_texts(const std::string& name) const {
  const std::string full = full_name(name);
  const Hdf5Shape dims = shape(name);
  const Hdf5Id dataset = open_dataset(name);
  const Hdf5Id stored(H5Dget_type(dataset.get()), H5Tclose, "no usable dataset " + full);
  const std::size_t length = text_length(stored.get());
  if (dims.size() != 1 || length == 0) raise("the dataset " + full + " is not a list of texts");
  check_plausible(dataset.get(), dims[0], length, full);
  std::string padded(value_count({dims[0], length}), '\0');
  const Hdf5Id type = text_type(length);
  if (dims[0] > 0)
    check_hdf5(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()),
               "cannot read the dataset " + full);
  std::vector<std::string> texts;
  texts.reserve(dims[0]);
  for (std::size_t i = 0; i < dims[0]; ++i)
    texts.push_back(without_padding(padded.data() + i * length, length));
  return texts;
}

#define REEMIT_HDF5_NUMBER(T)                                                                 \
  template void Hdf5Group::write_attribute<T>(const std::string&, T) const;                   \
  template T Hdf5Group::read_attribute<T>(const std::string&) const;                          \
  template void Hdf5Group::write<T>(const std::string&, std::span<const T>, const Hdf5Shape&, \
                                    const std::string&, const std::string&) const;            \
  template std::vector<T> Hdf5Group::read<T>(const std::string&, const Hdf5Shape&) const;
REEMIT_HDF5_NUMBER(float)
REEMIT_HDF5_NUMBER(double)
REEMIT_HDF5_NUMBER(std::uint8_t)
REEMIT_HDF5_NUMBER(std::int32_t)
REEMIT_HDF5_NUMBER(std::uint32_t)
REEMIT_HDF5_NUMBER(std::int64_t)
REEMIT_HDF5_NUMBER(std::uint64_t)
#undef REEMIT_HDF5_NUMBER

}  // namespace reemit
