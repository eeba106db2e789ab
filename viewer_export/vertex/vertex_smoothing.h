#pragma once
#include "scenes/model/stop_token.h"
#include "viewer_export/vertex/vertex_data.h"
#include "viewer_export/vertex/vertex_gatherer.h"
#include "viewer_export/vertex/vertex_layers.h"
#include "viewer_export/vertex/vertex_ring.h"

namespace reemit {

/// Takes noise out of gathered vertices: the irradiance of a vertex becomes the value there of a surface of
/// second order fitted to those of the vertices around it, on its smooth part of a surface, some edges of the
/// mesh to each side. How many is chosen anew for each vertex and layer: those whose fits to one half of the
/// replicates miss the values of the other half least, over the vertices near by (as [BRM16] chooses among
/// filters). Edges lie closer where zones are small, so shadows that zones were cut for are kept. Standard
/// errors are those of the fits, with the share of noise that neighbours have in common, and what values of
/// 64 vertices that follow each other are off beyond noise (SmoothingErrors). Vertices of surfaces that
/// transmit diffusely stay as they are, all of them once `stop` is requested. Runs in the arena of the
/// caller, the same bits on any number of threads.
void smooth_vertices(const VertexGatherer& gatherer, const VertexRings& rings, const VertexLayers& layers,
                     const StopToken& stop, VertexData& data);

}  // namespace reemit
