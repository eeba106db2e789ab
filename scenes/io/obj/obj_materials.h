#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenes/io/common/texture_images.h"
#include "scenes/model/scene.h"

namespace reemit {

/// The materials of the MTL files a room names. In linear Rec.709: Kd is the diffuse reflectance, Ke the
/// radiance in W/(m2 sr) of the front; surfaces reflect on both sides. What Ks, d, Tr, Tf and illum take of
/// the light goes to the non-diffuse part (obj_light_shares.h). A map_Kd stands for Kd: exporters write Kd
/// beside it as a mean, a default or a leftover, so it is not multiplied in. map_Ke is multiplied by Ke,
/// map_d by d. Files that Blender wrote are read by its conventions (blender_mtl.h).
class ObjMaterials {
 public:
  /// Reads one MTL file; `name` is relative to `folder`, `where` says which line asked for it. A file that is
  /// not there leaves a warning. Names that were asked for before are defined by it as well. Throws
  /// InputError with file and line.
  void read(const std::filesystem::path& folder, const std::string& name, const std::string& where);
  /// A name that no file has defined becomes grey; the empty one stands for no material.
  std::size_t index_of(const std::string& name, const std::string& where);
  /// Of all that was read and asked for; one for all names that are not defined.
  std::vector<std::string> warnings() const;

  std::vector<Material> materials;
  KindCounts refused, not_modelled;  ///< As in Scene.
  std::vector<std::string> notes;    ///< Of what was assumed, and images that were made smaller.

 private:
  struct Undefined {
    std::string shown;  // as messages show it
    std::string at;     // where it was first asked for
    std::size_t material;
  };

  /// Where the material of a definition goes: a new place, or that of a name asked for before. Null if the
  /// name is defined already.
  Material* place_of(const std::string& name);

  TextureImages images_;
  std::map<std::string, std::size_t> index_;
  std::vector<std::string> warnings_;
  std::vector<Undefined> undefined_;  // in the order in which they were asked for
};

}  // namespace reemit
