#pragma once
#include "mesh/zones/side_cell.h"
#include "solver/shoot/ray_lanes.h"

namespace reemit {

/// Where 16 rays leave one cell of a curved patch (normalised space).
struct alignas(64) CurvedStarts {
  float origin[3][16];
  float normal[3][16];  ///< Of the side that they leave; unit.
};

/// Starts at the uniform points (u[0], u[1]) of the cell: lane by lane those of sample_triangle, cell_point
/// and RayTracer::ray_origin. Pre: the cell lies on a curved shape that touches no others
/// (RayTracer::touches_others).
void curved_starts(const RayTracer& rays, const SideCell& cell, const UniformLanes& numbers,
                   CurvedStarts& to);

/// Puts their normals, with tangents, into lanes first .. last-1, so that start_rays finds directions about
/// them; the origins that it makes there are not theirs.
void put_normals(const CurvedStarts& starts, int first, int last, ZoneLanes& lanes);

}  // namespace reemit
