#include "solver/solution/shape_rows.h"

#include <cmath>
#include <stdexcept>

namespace reemit {
namespace {

using Row = std::array<double, kShapeRow>;

Row make_row(double kind, const Vec3& p, const Vec3& q, double a, double b, bool inward) {
  return {kind, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), a, b, inward ? 1.0 : 0.0};
}

struct RowOf {
  Row operator()(const Sphere& s) const { return make_row(0, s.centre, Vec3::Zero(), s.radius, 0, s.inward); }
  Row operator()(const Disk& d) const {
    return make_row(1, d.centre, d.normal, d.radius, d.inner_radius, false);
  }
  Row operator()(const Cylinder& c) const { return make_row(2, c.base, c.top, c.radius, 0, c.inward); }
  Row operator()(const Cone& c) const {
    return make_row(3, c.base, c.top, c.base_radius, c.top_radius, c.inward);
  }
};

CurvedShape unchecked(const double* row) {
  const Vec3 p(row[1], row[2], row[3]);
  const Vec3 q(row[4], row[5], row[6]);
  const bool inward = row[9] != 0;
  if (row[0] == 0) return Sphere{p, row[7], inward};
  if (row[0] == 1) return Disk{p, q, row[7], row[8]};
  if (row[0] == 2) return Cylinder{p, q, row[7], inward};
  if (row[0] == 3) return Cone{p, q, row[7], row[8], inward};
  throw std::invalid_argument("a shape of unknown kind");
}

bool is_sound(const CurvedShape& shape) {
  const auto [low, high] = shape_bounds(shape);
  if (!low.allFinite() || !high.allFinite() || !(shape_area(shape) > 0)) return false;
  if (const auto* disk = std::get_if<Disk>(&shape))
    return std::abs(disk->normal.norm() - 1) < 1e-6 && disk->inner_radius >= 0 &&
           disk->inner_radius < disk->radius;
  if (const auto* cone = std::get_if<Cone>(&shape)) return cone->base_radius >= 0 && cone->top_radius >= 0;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return cylinder->radius > 0;
  return std::get<Sphere>(shape).radius > 0;
}

}  // namespace

std::array<double, kShapeRow> row_of(const CurvedShape& shape) {
  return std::visit(RowOf{}, shape);
}

CurvedShape shape_of(const double* row) {
  const CurvedShape shape = unchecked(row);
  if (!is_sound(shape)) throw std::invalid_argument("a shape without an area or with numbers out of range");
  return shape;
}

}  // namespace reemit
