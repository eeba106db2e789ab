#pragma once
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include "mesh/zones/zone_mesh.h"

namespace reemit {

struct ZoneTopologyTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Normal);
  FaceAttributes(OpenMesh::Attributes::Normal);
};

/// Half-edge mesh of the cells: face i is cell i of ZoneCells, wound counter-clockwise seen from its side.
/// A cell beside finer ones is a polygon with the finer ones' vertices on its straight sides, so neighbours
/// always share edges. Vertices are shared within smooth parts only: split at creases, at borders between
/// surfaces or materials, between front and back, and where something else stands on an edge, which light
/// does not cross. Vertex normals are the shading normals (towards the side of the cell).
using ZoneTopology = OpenMesh::PolyMesh_ArrayKernelT<ZoneTopologyTraits>;

/// Of all cells of the mesh. Flat faces that meet along an edge share its vertices where their normals are at
/// most this angle [degree] apart, as MeshSettings::crease_angle_deg [0, 180]; round shapes are smooth in
/// themselves whatever it is.
ZoneTopology make_zone_topology(const ZoneMesh& mesh, double crease_angle_deg);

}  // namespace reemit
