#pragma once
#include <string>
#include <vector>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit::cli {

/// What a material does with light besides reflecting it as Lambert does, each in a word or two.
std::vector<std::string> models_of(const Material& material);

/// How much of a room is of one of these.
struct ModelShare {
  std::string model;
  double area = 0;   ///< Share of the area of all surfaces, one side.
  double power = 0;  ///< Share of the light that arrives at surfaces in all, by a few packets: to about 1 %.
};

/// In order of area; empty where all surfaces are Lambertian. Shoots packets if there are any.
std::vector<ModelShare> model_shares(const Scene& scene, const MeshResult& meshed);

}  // namespace reemit::cli
