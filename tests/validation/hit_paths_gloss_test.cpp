// The lobes of the reference: what they send in all against numbers that are known, and what is drawn against
// the formulas.
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "bench/hit_paths/gloss_lobe.h"
#include "bench/hit_paths/hit_path_tracer.h"
#include "bench/hit_paths/rough_ways.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit::hit_paths {
namespace {

using test::MeanTest;

constexpr double kPi = std::numbers::pi;
const Vec3 kUp(0, 0, 1);

Vec3 at_angle(double degrees) {
  return {std::sin(degrees * kPi / 180), 0, std::cos(degrees * kPi / 180)};
}

/// What a lobe sends in all, by the midpoint rule in angle squared and azimuth.
double sent(GlossLobe lobe, double alpha, const Vec3& from) {
  constexpr int kSteps = 600;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double sine2 = (i + 0.5) / kSteps;  // cos dw = d(sine2) dphi / 2
      const double phi = 2 * kPi * (j + 0.5) / kSteps;
      const double sine = std::sqrt(sine2);
      const Vec3 to(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1 - sine2));
      sum += lobe_value(lobe, alpha, kUp, from, to);
    }
  return sum * kPi / (kSteps * kSteps);
}

TEST(GlossLobes, send_what_docs_materials_says) {
  struct Row {
    GlossLobe lobe;
    double alpha, at_normal, at_60;
  };
  for (const auto& [lobe, alpha, at_normal, at_60] :
       {Row{GlossLobe::kGgx, 0.2, 0.948, 0.895}, Row{GlossLobe::kGgx, 0.5, 0.688, 0.698},
        Row{GlossLobe::kWard, 0.2, 0.960, 0.898}, Row{GlossLobe::kWard, 0.5, 0.755, 0.708},
        Row{GlossLobe::kPhong, 0.2, 1.000, 0.500}, Row{GlossLobe::kPhong, 0.8, 1.000, 0.601}}) {
    EXPECT_NEAR(sent(lobe, alpha, at_angle(0)), at_normal, 0.001) << alpha;
    EXPECT_NEAR(sent(lobe, alpha, at_angle(60)), at_60, 0.001) << alpha;
  }
}

TEST(GlossLobes, are_the_same_from_either_end) {
  const Vec3 a = Vec3(0.3, 0.5, 0.4).normalized();
  const Vec3 b = Vec3(-0.1, -0.6, 0.2).normalized();
  for (const GlossLobe lobe : {GlossLobe::kGgx, GlossLobe::kWard, GlossLobe::kPhong})
    EXPECT_NEAR(lobe_value(lobe, 0.4, kUp, a, b), lobe_value(lobe, 0.4, kUp, b, a), 1e-12);
}

TEST(GlossLobes, are_drawn_with_the_density_that_is_said) {
  PathRandom random(3);
  for (const GlossLobe lobe : {GlossLobe::kGgx, GlossLobe::kWard, GlossLobe::kPhong})
    for (const double angle : {0.0, 60.0}) {
      const double alpha = 0.3;
      const Vec3 from = at_angle(angle);
      MeanTest mean;
      for (int round = 0; round < 100; ++round) {
        double sum = 0;
        for (int i = 0; i < 2000; ++i) {
          const LobeDraw draw = draw_about_lobe(lobe, alpha, kUp, from, random);
          if (draw.direction.z() > 0)
            sum += lobe_value(lobe, alpha, kUp, from, draw.direction) * draw.direction.z() / draw.pdf;
        }
        mean.add(sum / 2000);
      }
      EXPECT_TRUE(mean.agrees_with(sent(lobe, alpha, from))) << angle;
      EXPECT_TRUE(mean.would_notice(0.05, sent(lobe, alpha, from))) << angle;
    }
}

/// The facets that are seen from anywhere have the projected area of the surface.
TEST(GlossLobes, facets_cover_the_surface) {
  PathRandom random(4);
  for (const double angle : {0.0, 50.0, 80.0}) {
    const Vec3 from = at_angle(angle);
    MeanTest mean;
    for (int round = 0; round < 100; ++round) {
      double sum = 0;
      for (int i = 0; i < 2000; ++i) {
        const Vec3 facet = draw_facet(0.4, kUp, random);
        const double seen = facet.dot(from);
        if (seen > 0) sum += seen / facet.z() * unhidden(0.4, kUp, from);
      }
      mean.add(sum / 2000 / from.z());
    }
    EXPECT_TRUE(mean.agrees_with(1)) << angle;
    EXPECT_TRUE(mean.would_notice(0.05, 1)) << angle;
  }
}

/// A level surface in a sky of radiance 1, with all its ways on.
MeanTest seen_of(const NonDiffusePart& part, double angle) {
  test::RoomBuilder room;
  const MaterialId sky = room.material("sky", 0, kPi);
  const MaterialId surface = room.material("surface", 0, 0, true);
  room.scene().materials[surface.index()].non_diffuse = part;
  constexpr double kSky = 1e4;
  room.box({-kSky, -kSky, -kSky}, {kSky, kSky, kSky}, {sky, sky, sky, sky, sky, sky}, 1);
  room.quad(surface, {Vec3(-99, -99, 0), Vec3(99, -99, 0), Vec3(99, 99, 0), Vec3(-99, 99, 0)}, 1);
  Camera camera;
  camera.eye = at_angle(angle);
  camera.look_at = Vec3::Zero();
  camera.vertical_fov_deg = 0.01;
  const HitPathTracer tracer(room.scene(), camera, 1, 1);
  PathRandom random(5);
  MeanTest mean;
  for (int round = 0; round < 100; ++round) {
    double sum = 0;
    for (int i = 0; i < 1000; ++i) tracer.add_path(0, 0, random, &sum);
    mean.add(sum / 1000);
  }
  return mean;
}

TEST(HitPathsOverGloss, a_sky_is_seen_as_bright_as_the_lobe_says) {
  NonDiffusePart part;
  part.specular_reflectance = Spectrum::Constant(1, 0.5);
  part.specular_transmittance = Spectrum::Constant(1, 0.3);
  part.roughness = 0.2;
  part.transmission_roughness = 0.5;
  for (const GlossLobe lobe : {GlossLobe::kGgx, GlossLobe::kWard}) {
    part.lobe = lobe;
    EXPECT_TRUE(seen_of(part, 60).agrees_with(0.5 * sent(lobe, 0.2, at_angle(60)) +
                                              0.3 * sent(lobe, 0.5, at_angle(60))));
  }
}

/// With roughness that is next to none rough glass is clear glass.
TEST(HitPathsOverGloss, rough_glass_becomes_clear_glass) {
  for (const bool solid : {false, true}) {
    NonDiffusePart part;
    part.angle_law = AngleLaw::kDielectric;
    part.index_of_refraction = 1.5;
    part.specular_transmittance = Spectrum::Constant(1, 0.5);
    part.is_solid = solid;
    const double clear = seen_of(part, 60).mean();
    part.roughness = part.transmission_roughness = 0.021;
    const MeanTest rough = seen_of(part, 60);
    EXPECT_NEAR(rough.mean(), clear, 5 * rough.standard_error() + 0.01) << solid;
    EXPECT_LT(rough.standard_error(), 0.01);
  }
}

}  // namespace
}  // namespace reemit::hit_paths
