#pragma once
#include <memory>
#include <optional>
#include <string_view>

#include "solver/solution/hdf5_group.h"

namespace reemit {

/// A new HDF5 file that is built in memory. HDF5 cannot recover when a disk is full: a file that it failed to
/// close haunts it until the program ends, and crashes it then. So the bytes are written by code that can
/// fail.
class Hdf5MemoryFile {
 public:
  Hdf5MemoryFile();  ///< Throws Hdf5Error.
  ~Hdf5MemoryFile();
  Hdf5MemoryFile(const Hdf5MemoryFile&) = delete;
  Hdf5MemoryFile& operator=(const Hdf5MemoryFile&) = delete;

  /// `packing` as Hdf5Group has it.
  Hdf5Group root(const Packing* packing = nullptr) const;
  /// Finishes the file; its bytes live as long as this object. Throws Hdf5Error.
  std::string_view close();

 private:
  struct Image;
  std::unique_ptr<Image> image_;  // outlives the file, which hands its memory over when it closes
  std::optional<Hdf5Id> file_;
};

}  // namespace reemit
