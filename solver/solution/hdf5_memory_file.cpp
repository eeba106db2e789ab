#include "solver/solution/hdf5_memory_file.h"

#include <cstdlib>
#include <cstring>

namespace reemit {

// Receives the memory of the file when HDF5 closes it. H5Fget_file_image would copy it, and spoils the
// checksum of the superblock (seen in HDF5 1.10.8).
struct Hdf5MemoryFile::Image {
  struct Free {
    void operator()(void* block) const { std::free(block); }
  };
  std::unique_ptr<void, Free> memory;
  std::size_t size = 0;  // of the memory that grew last, which is that of the file

  static void* allocate(std::size_t bytes, H5FD_file_image_op_t /*op*/, void* /*image*/) {
    return std::malloc(bytes);
  }
  static void* copy(void* to, const void* from, std::size_t bytes, H5FD_file_image_op_t /*op*/,
                    void* /*image*/) {
    return std::memcpy(to, from, bytes);
  }
  static void* reallocate(void* memory, std::size_t bytes, H5FD_file_image_op_t /*op*/, void* image) {
    static_cast<Image*>(image)->size = bytes;
    return std::realloc(memory, bytes);
  }
  static herr_t release(void* memory, H5FD_file_image_op_t op, void* image) {
    if (op == H5FD_FILE_IMAGE_OP_FILE_CLOSE)
      static_cast<Image*>(image)->memory.reset(memory);
    else
      std::free(memory);
    return 0;
  }
  static void* share(void* image) { return image; }
  static herr_t unshare(void* /*image*/) { return 0; }
};

Hdf5MemoryFile::Hdf5MemoryFile() : image_(std::make_unique<Image>()) {
  constexpr std::size_t kGrowth = std::size_t{8} << 20;
  const char* what = "cannot set file properties";
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  check_hdf5(H5Pset_fapl_core(access.get(), kGrowth, false), what);
  H5FD_file_image_callbacks_t callbacks{Image::allocate, Image::copy,    Image::reallocate, Image::release,
                                        Image::share,    Image::unshare, image_.get()};
  check_hdf5(H5Pset_file_image_callbacks(access.get(), &callbacks), what);
  // Metadata of this version carry checksums, so damage is found before it is believed.
  check_hdf5(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), what);
  check_hdf5(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), what);
  const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, what);
  check_hdf5(H5Pset_obj_track_times(creation.get(), false), what);  // of the root group; see hdf5_group.cpp
  file_.emplace(H5Fcreate("reemit solution in memory", H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose,
                "cannot create the file");
}

Hdf5MemoryFile::~Hdf5MemoryFile() = default;

Hdf5Group Hdf5MemoryFile::root(const Packing* packing) const {
  return {Hdf5Id(H5Gopen2(file_->get(), "/", H5P_DEFAULT), H5Gclose, "cannot open the root"), "/", packing};
}

std::string_view Hdf5MemoryFile::close() {
  file_->close("cannot close the file");
  // The memory grows in large steps; where the file ends in it stands in the superblock (HDF5 file format,
  // version 3).
  constexpr std::size_t kEndOfFile = 28;
  std::uint64_t size = 0;
  if (image_->size < kEndOfFile + sizeof size) throw Hdf5Error("HDF5 did not hand over the file");
  const char* bytes = static_cast<const char*>(image_->memory.get());
  std::memcpy(&size, bytes + kEndOfFile, sizeof size);
  if (size > image_->size) throw Hdf5Error("HDF5 handed over only a part of the file");
  return {bytes, size};
}

}  // namespace reemit
