#pragma once
#include <filesystem>
#include <vector>

#include "bench/hit_paths/opening_hit.h"
#include "bench/hit_paths/path_random.h"
#include "bench/hit_paths/polygon_room.h"
#include "bench/hit_paths/sky_dome.h"
#include "scenes/model/camera.h"
#include "scenes/model/scene.h"

namespace reemit::hit_paths {

/// Radiance of pixels by paths that go on by chance, spread or over mirrors and through glass, until they
/// leave or are absorbed, and count emission where they hit it: no luminaire is ever sampled. Openings of
/// measured luminaires, which are not seen, count where a path crosses them that was spread before. Only
/// lights that no path can hit (points, lines, spots, parallel light, the sun) are asked for with one shadow
/// ray each, which panes and clear sheets let through; their light over mirrors, and where rough bodies of
/// glass refract it, is missing. A sky is seen where paths leave the room. Radiance inside glass is that
/// outside of it (over n^2). Slow, and without anything in common with what it checks.
class HitPathTracer {
 public:
  using Random = PathRandom;

  /// `photometry`: IES file of all measured luminaires, which is read anew by a reader of the reference; if
  /// it is empty, the tables of the scene. Throws std::invalid_argument for what the reference does not know,
  /// or if an opening is not as large as the file says.
  HitPathTracer(const Scene& scene, const Camera& camera, int width, int height,
                const std::filesystem::path& photometry = {});

  /// Adds the radiance [W/(m2 sr)] of one path through a uniform point of pixel (x, y) to sum[band].
  void add_path(int x, int y, Random& random, double* sum) const;

 private:
  void add_emission(const RoomHit& hit, const Vec3& direction, const Spectrum& weight, double* sum) const;
  void add_openings(const RayStart& start, const Vec3& direction, double far, const Spectrum& weight,
                    double* sum) const;
  void add_lights(const RoomHit& hit, const Vec3& direction, const Spectrum& weight, Random& random,
                  double* sum) const;
  /// By band, the share of light from a point that comes straight to another: all, or what panes let through.
  Spectrum left_between(RayStart start, const Vec3& target) const;

  /// A measured luminaire and what one candela of its file stands for.
  struct Measured {
    OpeningHit opening;
    const Spectrum* per_candela;
  };

  const Scene* scene_;
  PolygonRoom room_;
  SkyDome sky_;
  double clearance_;                  // of light off openings [m]
  std::vector<Measured> openings_;    // those that paths can hit
  std::vector<Measured> lines_;       // points and lines
  Vec3 eye_, corner_, right_, down_;  // a pixel (x, y) looks along corner_ + x right_ + y down_
};

}  // namespace reemit::hit_paths
