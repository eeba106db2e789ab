#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

/// Points under one name at which irradiance is asked for.
struct PointSet {
  std::string name;
  std::vector<Vec3> places;   ///< [m]
  std::vector<Vec3> normals;  ///< Unit; as many.

  std::size_t size() const { return places.size(); }
};

/// A parallelogram that is divided into equal fields.
struct PointGrid {
  Vec3 corner{0, 0, 0};  ///< [m]
  Vec3 along{1, 0, 0};   ///< From the corner, one side [m].
  Vec3 across{0, 0, 1};  ///< The other.
  int columns = 1;       ///< Fields along the first, >= 1.
  int rows = 1;          ///< Fields along the other, >= 1.
};

/// The middles of its fields, row by row. They face along x across, or the other way where that leads down:
/// grids that do not stand upright are lit from above. Throws InputError where the sides span no
/// area or there are no fields, ResourceError for more points than memory holds.
PointSet grid_points(const std::string& name, const PointGrid& grid, const Vec3& up);

/// Points of a text file: in each line x, y, z [m] and the way the point faces, three numbers each of any
/// length above 0, divided by blanks, commas or semicolons. Lines that begin with # count for nothing, nor
/// does a first line of words. The set is called like the file. Throws InputError with file and line.
PointSet read_points(const std::filesystem::path& file);

}  // namespace reemit
