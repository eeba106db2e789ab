#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/gather/direct_light.h"
#include "solver/gather/point_sampler.h"
#include "solver/gather/radiance_field.h"
#include "solver/sampling/warp.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// How far the light of the part of a zone that the room sees is from the zone's mean. A zone that runs on
/// under a desk or behind a panel is dark there, and no gather ray comes to it there either: all rays read
/// a mean that is too dark for what they see.
class SeenLight {
 public:
  /// `reflected`: of each zone, per band, the mean over the parts of the field [W/(m2 sr)]. `scale`: per
  /// band, the radiance that counts as 1 [W/(m2 sr)]; bands where it is 0 are left out. All must outlive it.
  SeenLight(const RadianceField& field, const DirectLight& direct, std::span<const float> reflected,
            std::span<const double> scale, std::uint64_t seed);

  /// Of one zone; the means are over bands.
  struct Zone {
    /// Share of cosine-distributed rays from the zone that end on lit surfaces farther away than
    /// GatherSettings::close_hit continues: by reciprocity, of rays that would read it [0,1].
    double open = 0;
    /// Mean reflected radiance over what such rays see less the mean over the zone, over `scale`: the
    /// covariance over the zone of openness and reflected radiance, over `open`.
    double misread = 0;
  };

  /// An estimate with four rays of each of sixteen points, seen twice; its noise is 0 on average. Zones with
  /// nothing nearby are not looked at twice and have 0 of `misread`, nor are those that see nothing but dark.
  /// What the zone itself has in `reflected` is not looked at: where packets are few, that would choose zones
  /// that have met more of them than they should.
  Zone look(ZoneId zone) const;
  /// Zones whose first rays are traced together.
  static constexpr std::size_t kTogether = 4;
  /// Of the zones from `first` on, at most kTogether: where all of four rays of each get far, that is all
  /// that is looked at, and `open` is what they tell; else each gets its own look.
  void look(ZoneId first, std::span<Zone> seen) const;

 private:
  static constexpr int kPoints = 16;     // of a zone; their rays are traced together
  static constexpr int kRays = 4;        // of a point in one look
  static constexpr int kShadowRays = 2;  // likewise
  /// A point of a zone, and how rays leave it.
  struct Start {
    SurfacePoint point;
    Vec3f origin{0, 0, 0};
    Frame frame{Vec3f(0, 0, 1)};

    /// One in this direction of the hemisphere of diffuse light.
    void set_ray(const std::array<float, 2>& u, int lane, Ray16& rays) const {
      rays.set(lane, origin, frame.to_world(sample_cosine_hemisphere(u[0], u[1])));
    }
  };
  using Points = std::array<Start, kPoints>;
  enum SamplerNumber : int { kPlaces, kGlance, kOneLook, kOtherLook };

  /// What one look finds, by point.
  struct Look {
    std::array<float, kPoints> open{};  // share of rays that end on lit surfaces far away
    std::vector<float> irradiance;      // by point, then by band [W/m2]
    float far = 0;                      // share of all rays that end far away, lit or dark, or leave the room
  };
  /// Over the zone.
  struct Half {
    double open;
    double covariance;  // of openness and irradiance [W/m2]
  };

  PointSampler sampler(ZoneId zone, SamplerNumber number) const;
  /// As what a ray ends on: by what the zone has in reflected_.
  bool is_dark_end(ZoneId zone) const;
  /// As a zone that is looked at: by what it reflects of the light that the glance found.
  bool is_dark_zone(ZoneId zone, const Look& glance) const;
  Start start_in(ZoneId zone, const std::array<float, 2>& u) const;
  Points points_of(ZoneId zone, const PointSampler& place) const;
  /// What rays end on, by lane.
  struct Ends {
    Hit16 hits;
    alignas(64) std::uint32_t zone[16];

    bool leaves(std::size_t lane) const { return hits.triangle[lane] == RayTracer::kMiss; }
    bool is_on_zone(std::size_t lane) const { return !leaves(lane) && zone[lane] != ZoneMesh::kNone; }
    /// Out of the room, or to a zone farther away than that [normalised units].
    bool gets_far(std::size_t lane, float reach) const {
      return leaves(lane) || (is_on_zone(lane) && hits.distance[lane] > reach);
    }
  };
  Ends trace(const Ray16& rays, std::size_t count) const;
  /// One ray of each point, the sampler's `ray` of `rays`.
  void look_out(ZoneId zone, const Points& points, const PointSampler& sampler, int ray, int rays,
                Look& look) const;
  /// Light of luminaires at each point by so many shadow rays.
  void add_direct(const Points& points, const PointSampler& sampler, int rays, Look& look) const;
  Look look_around(ZoneId zone, const Points& points, const PointSampler& sampler) const;
  static Half half_of(const std::array<float, kPoints>& open, const std::vector<float>& irradiance,
                      std::size_t band);

  const RadianceField* field_;
  const DirectLight* direct_;
  std::span<const float> reflected_;
  std::span<const double> scale_;
  std::uint64_t seed_;
};

}  // namespace reemit
