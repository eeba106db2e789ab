// Mirrors, panes and bodies of glass against Fresnel's equations and against themselves.

#include "solver/reflect/specular.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/reflect/fresnel.h"

namespace reemit {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Material material_of(double reflectance, const NonDiffusePart& part) {
  Material m;
  m.reflectance = Spectrum::Constant(1, reflectance);
  m.emitted_radiance = Spectrum::Zero(1);
  m.non_diffuse = part;
  return m;
}

NonDiffusePart glass(double ior, bool solid, double once = 1) {
  NonDiffusePart part;
  part.angle_law = AngleLaw::kDielectric;
  part.index_of_refraction = ior;
  part.specular_transmittance = Spectrum::Constant(1, once);
  part.is_solid = solid;
  return part;
}

NonDiffusePart mirror(double share, AngleLaw law = AngleLaw::kConstant) {
  NonDiffusePart part;
  part.specular_reflectance = Spectrum::Constant(1, share);
  part.angle_law = law;
  return part;
}

/// A point seen at an angle to its normal (z) [degrees].
SurfacePoint seen_at(double angle, bool front = true) {
  SurfacePoint x;
  x.front = front;
  x.normal = {0, 0, 1};
  x.towards = Vec3(std::sin(angle * kDegree), 0, std::cos(angle * kDegree)).cast<float>();
  return x;
}

SpecularStep shares_at(const SpecularSurface& surface, double angle, bool front = true) {
  SpecularStep step(1);
  surface.shares(static_cast<float>(std::cos(angle * kDegree)), front, step);
  return step;
}

TEST(SpecularSurface, MostSharesAreNeverLessThanTheShares) {
  std::vector<SpecularSurface> surfaces;
  for (const double share : {0.01, 0.3, 0.9})
    for (const AngleLaw law : {AngleLaw::kConstant, AngleLaw::kSchlick}) {
      surfaces.emplace_back(material_of(0.1, mirror(share, law)), 1);
      NonDiffusePart pane = mirror(0.5 * share, law);
      pane.specular_transmittance = Spectrum::Constant(1, 0.8 * (1 - share));
      surfaces.emplace_back(material_of(0, pane), 1);
      pane.is_solid = true;
      surfaces.emplace_back(material_of(0, pane), 1);
      NonDiffusePart opal = mirror(share, law);
      opal.diffuse_transmittance = Spectrum::Constant(1, 0.5 * (1 - share));
      surfaces.emplace_back(material_of(0.1 * (1 - share), opal), 1);
    }
  surfaces.emplace_back(material_of(0, glass(1.5, false)), 1);
  surfaces.emplace_back(material_of(0, glass(1.5, true)), 1);
  NonDiffusePart metal = mirror(1, AngleLaw::kConductor);
  metal.metal_eta = Spectrum::Constant(1, 0.2);
  metal.metal_k = Spectrum::Constant(1, 3);
  surfaces.emplace_back(material_of(0, metal), 1);
  SpecularStep step(1);
  int told = 0;
  for (const SpecularSurface& surface : surfaces)
    for (const bool front : {true, false})
      for (float cosine = 1e-4F; cosine <= 1; cosine += 1e-3F) {
        // Roulette compares with a cosine that rounding may have changed.
        const float most = surface.most_shares(std::min(1.0F, cosine + 1e-6F));
        const float sum = surface.shares(cosine, front, step);
        EXPECT_TRUE(most >= sum || most >= 1) << cosine;
        told += most < 1 && most < sum + 0.05F ? 1 : 0;
      }
  EXPECT_GT(told, 10'000) << "the bound says little";
}

TEST(SpecularSurface, SendsNarrowlyUnlessAllThatGoesOnIsWide) {
  const auto sends_narrowly = [](const NonDiffusePart& part) {
    return SpecularSurface(material_of(0.2, part), 1).sends_narrowly();
  };
  EXPECT_FALSE(sends_narrowly({}));
  EXPECT_TRUE(sends_narrowly(mirror(0.5)));
  EXPECT_TRUE(sends_narrowly(glass(1.5, true)));
  NonDiffusePart gloss = mirror(0.3);
  gloss.roughness = 0.9 * SpecularSurface::kWide;
  EXPECT_TRUE(sends_narrowly(gloss));
  gloss.roughness = 1.1 * SpecularSurface::kWide;
  EXPECT_FALSE(sends_narrowly(gloss));
  gloss.diffuse_transmittance = Spectrum::Constant(1, 0.2);
  EXPECT_FALSE(sends_narrowly(gloss)) << "into all directions is wide";
  NonDiffusePart sheet = gloss;
  sheet.specular_transmittance = Spectrum::Constant(1, 0.2);
  EXPECT_TRUE(sends_narrowly(sheet)) << "what goes straight through is not";
  sheet.transmission_roughness = 0.5;
  EXPECT_FALSE(sends_narrowly(sheet));
}

TEST(Fresnel, OfASurfaceOfGlass) {
  // Closed form, n = 1.5.
  const std::array<std::array<double, 2>, 6> truth{{{0, 0.04},
                                                    {30, 0.0415226259758215},
                                                    {45, 0.0502399110122359},
                                                    {60, 0.0891867128022128},
                                                    {75, 0.25306056299032},
                                                    {85, 0.612799645264827}}};
  for (const auto& [angle, reflectance] : truth)
    EXPECT_NEAR(fresnel(1.5, std::cos(angle * kDegree)).mean(), reflectance, 1e-13) << angle;
  EXPECT_EQ(fresnel(1 / 1.5, std::cos(42 * kDegree)).mean(), 1)
      << "beyond the critical angle of 41.8 degrees";
  EXPECT_EQ(fresnel(1.5, 0).mean(), 1) << "grazing";
}

TEST(Fresnel, IsTheSameFromBothSides) {
  for (double angle = 0; angle < 90; angle += 7) {
    const double cosine = std::cos(angle * kDegree);
    const double beyond = refracted_cosine(1.5, cosine);
    EXPECT_NEAR(fresnel(1.5, cosine).s, fresnel(1 / 1.5, beyond).s, 1e-14);
    EXPECT_NEAR(fresnel(1.5, cosine).p, fresnel(1 / 1.5, beyond).p, 1e-14);
  }
}

TEST(Fresnel, OfMetals) {
  // Amplitudes with a complex refracted wave [BW99, sec. 14.2].
  for (const std::complex<double> n :
       {std::complex(0.958, -6.69), std::complex(3.0, -3.3), std::complex(0.2, -3.4)})
    for (const double angle : {0.0, 30.0, 60.0, 80.0, 89.0}) {
      const double c = std::cos(angle * kDegree);
      const auto wave = std::sqrt(n * n - std::pow(std::sin(angle * kDegree), 2));
      const FresnelShares f = fresnel_of_metal(n.real(), -n.imag(), c);
      EXPECT_NEAR(f.s, std::norm((c - wave) / (c + wave)), 1e-12) << n << angle;
      EXPECT_NEAR(f.p, std::norm((n * n * c - wave) / (n * n * c + wave)), 1e-12) << n << angle;
    }
  EXPECT_NEAR(fresnel_of_metal(1.5, 0, 0.6).p, fresnel(1.5, 0.6).p, 1e-12) << "glass";
  EXPECT_NEAR(fresnel_of_metal(0.958, 6.69, 0).mean(), 1, 1e-12) << "grazing";
}

TEST(SpecularSurface, PanesReflectAndTransmitAsTheirTwoSurfacesTogether) {
  // Clear slab, n = 1.5, and one of n = 1.52 with an optical thickness of 0.1; closed form.
  const SpecularSurface clear(material_of(0, glass(1.5, false)), 1);
  const std::array<std::array<double, 3>, 5> clear_truth{{{0, 0.923076923076923, 0.0769230769230769},
                                                          {30, 0.920734443869002, 0.0792655561309985},
                                                          {60, 0.8481284097288, 0.1518715902712},
                                                          {75, 0.618148516254709, 0.381851483745291},
                                                          {85, 0.246930580386571, 0.753069419613429}}};
  const auto compare = [](const SpecularSurface& pane, const auto& truth) {
    for (const auto& [angle, t, r] : truth) {
      const SpecularStep step = shares_at(pane, angle);
      EXPECT_NEAR(step.transmitted[0], t, 2e-6) << angle;
      EXPECT_NEAR(step.reflected[0], r, 2e-6) << angle;
    }
  };
  compare(clear, clear_truth);
  const SpecularSurface grey(material_of(0, glass(1.52, false, std::exp(-0.1))), 1);
  const std::array<std::array<double, 3>, 4> grey_truth{{{0, 0.83065502172055, 0.0745834489612865},
                                                         {40, 0.813912941293186, 0.08216999124423},
                                                         {60, 0.744553524027133, 0.142323976036058},
                                                         {80, 0.384797136332192, 0.502359516509637}}};
  compare(grey, grey_truth);
}

TEST(SpecularSurface, NothingIsGainedAtAnyAngle) {
  std::vector<Material> materials{material_of(0, glass(1.5, false)),
                                  material_of(0, glass(1.5, true)),
                                  material_of(0.3, glass(1.5, false)),
                                  material_of(0.3, glass(2.4, true)),
                                  material_of(0.4, mirror(0.5, AngleLaw::kSchlick)),
                                  material_of(0, mirror(0.9, AngleLaw::kSchlick))};
  NonDiffusePart both = mirror(0.2, AngleLaw::kSchlick);
  both.specular_transmittance = Spectrum::Constant(1, 0.5);
  materials.push_back(material_of(0.3, both));
  for (const Material& m : materials) {
    const SpecularSurface surface(m, 1);
    for (const bool front : {true, false})
      for (double angle = 0; angle <= 90; angle += 0.5) {
        const SpecularStep step = shares_at(surface, angle, front);
        EXPECT_GE(step.reflected[0], 0);
        EXPECT_GE(step.transmitted[0], 0);
        EXPECT_LE(static_cast<double>(step.reflected[0] + step.transmitted[0]) + m.reflectance[0], 1 + 2e-6);
      }
  }
  // Clear glass loses nothing either.
  for (std::size_t k = 0; k < 2; ++k)
    for (double angle = 0; angle < 90; angle += 3) {
      const SpecularStep step = shares_at(SpecularSurface(materials[k], 1), angle);
      EXPECT_NEAR(step.reflected[0] + step.transmitted[0], 1, 2e-6);
    }
}

TEST(SpecularSurface, MetalsReflectMoreAtGrazingAngles) {
  const SpecularSurface metal(material_of(0.1, mirror(0.6, AngleLaw::kSchlick)), 1);
  EXPECT_NEAR(shares_at(metal, 0).reflected[0], 0.6, 1e-6);
  EXPECT_NEAR(shares_at(metal, 90).reflected[0], 0.9, 1e-6) << "what diffuse reflection leaves";
  EXPECT_NEAR(shares_at(metal, 60).reflected[0], 0.6 + 0.3 / 32, 1e-6);
}

TEST(SpecularSurface, MetalsReflectWhatTheirIndexOfRefractionSays) {
  constexpr double kEta = 0.958, kK = 6.69, kDiffuse = 0.1;
  NonDiffusePart part = mirror(1, AngleLaw::kConductor);
  part.metal_eta = Spectrum::Constant(1, kEta);
  part.metal_k = Spectrum::Constant(1, kK);
  const SpecularSurface metal(material_of(kDiffuse, part), 1);
  const double normal = ((kEta - 1) * (kEta - 1) + kK * kK) / ((kEta + 1) * (kEta + 1) + kK * kK);
  EXPECT_NEAR(shares_at(metal, 0).reflected[0], (1 - kDiffuse) * normal, 2e-6);
  EXPECT_NEAR(shares_at(metal, 90).reflected[0], 1 - kDiffuse, 2e-6);
  for (const double angle : {30.0, 60.0, 80.0}) {
    const double truth = fresnel_of_metal(kEta, kK, std::cos(angle * kDegree)).mean();
    EXPECT_NEAR(shares_at(metal, angle).reflected[0], (1 - kDiffuse) * truth, 2e-6) << angle;
  }
}

TEST(SpecularSurface, RaysAreBentBySnellsLawAndComeBackTheSameWay) {
  const SpecularSurface body(material_of(0, glass(1.5, true)), 1);
  for (const double angle : {0.0, 20.0, 50.0, 80.0}) {
    SpecularStep step(1);
    ASSERT_TRUE(body.choose(seen_at(angle), 0.9999F, {}, Survival::kCertain, step));
    ASSERT_TRUE(step.crosses() && step.bends);
    EXPECT_FALSE(step.front) << "it leaves from the other side";
    EXPECT_NEAR(step.direction.norm(), 1, 1e-6);
    EXPECT_NEAR(-step.direction.x(), std::sin(angle * kDegree) / 1.5, 1e-6);
    // Seen from where it went, light comes from where it was seen.
    SurfacePoint inside = seen_at(0, false);
    inside.normal = {0, 0, -1};
    inside.towards = step.direction;
    SpecularStep back(1);
    ASSERT_TRUE(body.choose(inside, 0.9999F, {}, Survival::kCertain, back));
    ASSERT_TRUE(back.crosses());
    EXPECT_NEAR((back.direction - seen_at(angle).towards).norm(), 0, 2e-6);
    EXPECT_NEAR(back.transmitted[0], step.transmitted[0], 2e-6) << "reciprocity";
  }
  SpecularStep inside(1);
  ASSERT_TRUE(body.choose(seen_at(50, false), 0.9999F, {}, Survival::kCertain, inside));
  EXPECT_FALSE(inside.crosses()) << "total reflection";
  EXPECT_EQ(inside.reflected[0], 1);
}

TEST(SpecularSurface, PanesLetLightStraightOnAndMirrorsTurnIt) {
  SpecularStep step(1);
  const SpecularSurface pane(material_of(0, glass(1.5, false)), 1);
  ASSERT_TRUE(pane.choose(seen_at(40), 0.9F, {}, Survival::kRoulette, step));
  EXPECT_TRUE(step.crosses());
  EXPECT_FALSE(step.bends);
  EXPECT_EQ((step.direction + seen_at(40).towards).norm(), 0);
  const SpecularSurface silver(material_of(0, mirror(0.9)), 1);
  ASSERT_TRUE(silver.choose(seen_at(40), 0.2F, {}, Survival::kRoulette, step));
  EXPECT_FALSE(step.crosses());
  EXPECT_TRUE(step.front && step.bends);
  const Vec3f& towards = seen_at(40).towards;
  EXPECT_NEAR((step.direction - Vec3f(-towards.x(), 0, towards.z())).norm(), 0, 1e-6);
}

// Each way is chosen as often as it says, whatever may be spent on it, and in the mean carries its share.
TEST(SpecularSurface, ChancesAddUp) {
  NonDiffusePart part = mirror(0.3);
  part.specular_transmittance = Spectrum::Constant(1, 0.5);
  const SpecularSurface surface(material_of(0, part), 1);
  for (const Survival survival : {Survival::kRoulette, Survival::kCertain})
    for (const float most : {1.0F, 0.6F}) {
      constexpr int kNumbers = 100'000;
      std::array<double, 2> carried{};
      for (int i = 0; i < kNumbers; ++i) {
        SpecularStep step(1);
        const float u = most * (static_cast<float>(i) + 0.5F) / kNumbers;
        if (!surface.choose(seen_at(30), u, {}, survival, step, most)) continue;
        carried[step.crosses() ? 1 : 0] +=
            static_cast<double>(step.share()[0] / step.chance * most) / kNumbers;
      }
      EXPECT_NEAR(carried[0], 0.3, 1e-4);
      EXPECT_NEAR(carried[1], 0.5, 1e-4);
    }
}

/// Of light seen at an angle, the share that each way on carries in the mean, reflected and transmitted.
std::array<double, 2> carried(const Material& m, double angle, bool front = true) {
  const SpecularSurface surface(m, 1);
  SpecularStep step(1);
  std::array<double, 2> sum{};
  constexpr int kPoints = 1 << 18;
  for (int i = 0; i < kPoints; ++i) {
    // A lattice by powers of the root of x^4 = x + 1.
    const auto at = [i](double root) { return static_cast<float>(i * root - std::floor(i * root)); };
    if (surface.choose(seen_at(angle, front), at(0.8191725134), {at(0.6710436067), at(0.5497004779)},
                       Survival::kRoulette, step))
      sum[step.crosses() ? 1 : 0] += static_cast<double>(step.share()[0] / step.chance);
  }
  for (double& share : sum) share /= kPoints;
  return sum;
}

TEST(SpecularSurface, RoughSheetsSendOnWhatTheirLobesSay) {
  // Albedos by quadrature (gloss_test.cpp).
  NonDiffusePart part = mirror(0.3);
  part.specular_transmittance = Spectrum::Constant(1, 0.5);
  part.roughness = 0.4;
  part.transmission_roughness = 0.2;
  const std::array<std::array<double, 3>, 3> albedo{{{0.78657, 0.94766}, {0.84031, 0.96}, {1, 1}}};
  for (const GlossLobe lobe : {GlossLobe::kGgx, GlossLobe::kWard, GlossLobe::kPhong}) {
    part.lobe = lobe;
    const std::array<double, 2> shares = carried(material_of(0.2, part), 0);
    EXPECT_NEAR(shares[0], 0.3 * albedo[static_cast<std::size_t>(lobe)][0], 2e-3);
    EXPECT_NEAR(shares[1], 0.5 * albedo[static_cast<std::size_t>(lobe)][1], 3e-3);
  }
}

TEST(SpecularSurface, RoughGlassKeepsMostLight) {
  // What facets hide is lost.
  NonDiffusePart part = glass(1.5, true);
  part.roughness = part.transmission_roughness = 0.3;
  for (const bool front : {true, false})
    for (const double angle : {0.0, 30.0, 60.0}) {
      const std::array<double, 2> shares = carried(material_of(0, part), angle, front);
      EXPECT_LT(shares[0] + shares[1], 1.001) << angle;
      EXPECT_GT(shares[0] + shares[1], front ? 0.93 : 0.77) << front << ' ' << angle;
    }
  part.roughness = part.transmission_roughness = 0.0201;
  const std::array<double, 2> smooth = carried(material_of(0, part), 40);
  EXPECT_NEAR(smooth[0], fresnel(1.5, std::cos(40 * kDegree)).mean(), 2e-3);
  EXPECT_NEAR(smooth[0] + smooth[1], 1, 3e-3);
}

TEST(SpecularSurface, LobesAreTheSameForRaysAndForShadowRays) {
  NonDiffusePart part = mirror(0.3, AngleLaw::kSchlick);
  part.specular_transmittance = Spectrum::Constant(1, 0.2);
  part.diffuse_transmittance = Spectrum::Constant(1, 0.2);
  part.roughness = part.transmission_roughness = 0.3;
  const SpecularSurface surface(material_of(0.1, part), 1);
  SpecularStep ray(1), value(1);
  const SurfacePoint x = seen_at(35);
  for (const SpecularWayOn way : {SpecularWayOn::kMirror, SpecularWayOn::kAcross, SpecularWayOn::kDiffuse})
    for (float u = 0.05F; u < 1; u += 0.1F) {
      if (!surface.take(x, way, {u, 0.3F}, ray)) continue;
      ASSERT_TRUE(surface.value(x, way, ray.direction, value));
      EXPECT_EQ(value.crosses(), ray.direction.dot(x.normal) < 0);
      EXPECT_NEAR(value.pdf_per_sr, ray.pdf_per_sr, 1e-3F * ray.pdf_per_sr);
      const float cosine = std::fabs(ray.direction.z());
      EXPECT_NEAR(value.share()[0] * cosine, ray.share()[0] * ray.pdf_per_sr,
                  2e-3F * ray.share()[0] * ray.pdf_per_sr);
    }
  NonDiffusePart smooth = mirror(0.5);
  smooth.roughness = NonDiffusePart::kSmooth;
  EXPECT_FALSE(SpecularSurface(material_of(0.2, smooth), 1).is_rough());
}

TEST(SpecularSurface, GlassAbsorbsAlongTheWayInside) {
  NonDiffusePart part = glass(1.5, true);
  part.absorption_per_m = Spectrum::Constant(1, 2.0);
  const SpecularSurface body(material_of(0, part), 3);  // 3 m per unit
  ASSERT_TRUE(body.absorbs_inside());
  EXPECT_NEAR(body.left_inside(0, 0.1F), std::exp(-0.6), 1e-6);
}

}  // namespace
}  // namespace reemit
