#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenes/io/common/json_cursor.h"
#include "scenes/io/common/read_options.h"
#include "scenes/io/native/native_materials.h"
#include "scenes/io/native/native_shapes.h"

namespace reemit {

/// Turns the tree of objects of a room file (shapes, groups, arrays, referenced files) into surfaces in
/// metres.
class NativeObjects {
 public:
  /// `unit`: metres per unit of length of the room file. `groups`: the "groups" of the file, if it has any.
  /// All references must outlive this.
  NativeObjects(std::filesystem::path folder, const ReadOptions& options, double unit,
                std::optional<JsonCursor> groups, NativeMaterials& materials, Scene& scene);

  /// Appends what the array of objects describes to the scene. Throws InputError, among others for groups
  /// that contain themselves, and for more than 10 million faces or a million objects after the expansion of
  /// arrays.
  void read(const JsonCursor& objects);

 private:
  struct Placement {
    Eigen::Affine3d to_world;
    std::string prefix;                  // Of names: the groups around, each with a slash.
    std::optional<MaterialId> material;  // Inherited from the groups around.
    int depth = 0;
  };
  struct ReferencedFile {
    std::vector<Surface> surfaces;    // In the unit of the file.
    std::vector<Material> materials;  // Empty for formats without materials.
    std::vector<MaterialId> ids;      // Where imported, in the room.
    BandSet bands = BandSet::grey();
  };

  void read_list(const JsonCursor& objects, const Placement& placement);
  void read_object(const JsonCursor& at, std::size_t number, const Placement& placement);
  void read_content(const JsonCursor& at, const std::string& kind, const Placement& placement,
                    const std::string& name);
  void read_box_with_materials(const JsonCursor& at, Surface shape, const Placement& placement,
                               const std::string& name);
  void read_group(const JsonCursor& name, const Placement& placement);
  void read_file(const JsonCursor& at, const JsonCursor& object, const Placement& placement,
                 const std::string& name);
  ReferencedFile& load(const JsonCursor& path);
  MaterialId material_of_file(ReferencedFile& file, const Surface& surface, const JsonCursor& object);
  void append(Surface surface, const JsonCursor& at, const Placement& placement, const std::string& name);
  MaterialId demand_material(const JsonCursor& at, const Placement& placement) const;

  std::filesystem::path folder_;
  const ReadOptions& options_;
  double unit_;
  std::optional<JsonCursor> groups_;
  NativeMaterials& materials_;
  Scene& scene_;
  std::set<std::string> open_groups_;  // Being expanded: a group met again is a cycle.
  std::map<std::string, ReferencedFile> files_;
  std::map<std::string, int> names_;
  std::size_t faces_ = 0;
  std::size_t objects_ = 0;
};

/// Metres per unit of length: "m", "mm", "cm", "ft" or "in".
double read_unit(const JsonCursor& at);

}  // namespace reemit
