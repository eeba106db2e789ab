#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenes/model/material.h"

namespace reemit {

/// The materials of the MTL files a room names. In linear Rec.709: Kd is the diffuse reflectance, Ke the
/// radiance in W/(m2 sr) of the front; surfaces reflect on both sides. Ks, Ns, d, Tr, Tf and Ni go to the
/// non-diffuse part. A map_Kd stands for Kd by its average colour: exporters write Kd beside it as a mean, a
/// default or a leftover, so it is not multiplied in.
class ObjMaterials {
 public:
  /// Reads one MTL file. Throws InputError with file and line; `where` says which line asked for it.
  void read(const std::filesystem::path& file, const std::string& where);
  bool contains(const std::string& name) const { return index_.contains(name); }
  std::size_t index_of(const std::string& name) const { return index_.at(name); }

  std::vector<Material> materials;
  std::vector<std::string> warnings;

 private:
  std::map<std::string, std::size_t> index_;
};

}  // namespace reemit
