#include "scenes/io/photometry/eulumdat_reader.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/photometry/ies_reader.h"
#include "tests/support/refusal.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using test::replaced;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using OpeningShape = LuminousOpening::Shape;

/// Intensity [cd per 1000 lm] by C and gamma [degree].
using Distribution = std::function<double(double c, double gamma)>;

constexpr int kPlanes = 24, kAngles = 37;  // every 15 and 5 degrees
constexpr double kFlux = 2400;             // [lm]

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

Vec3 direction(double c, double gamma) {
  return {std::sin(radians(gamma)) * std::cos(radians(c)), std::sin(radians(gamma)) * std::sin(radians(c)),
          -std::cos(radians(gamma))};
}

struct Ldt {
  int symmetry = 0;
  bool repeats_plane_0 = false;  // as plane 360; without symmetry
  std::string lamp_sets = "1\n2\nT16\n2400\n840\n1B\n54\n";
  std::string opening = "1200\n300\n0\n0\n0\n0\n";
  std::string factors = "0\n0\n1\n0\n";  // downward share, output ratio, conversion factor, tilt
};

/// A file with the planes that its symmetry stores, by the description of the format.
std::string ldt_text(const Distribution& f, const Ldt& ldt = {}) {
  std::ostringstream text;
  text.precision(17);
  const int planes = kPlanes + (ldt.repeats_plane_0 ? 1 : 0);
  text << "Company\n2\n"
       << ldt.symmetry << "\n"
       << planes << "\n15\n"
       << kAngles << "\n5\nreport\nA lamp\n4711\n"
       << "lamp.ldt\n2024\n1250\n310\n80\n"
       << ldt.opening << ldt.factors << ldt.lamp_sets;
  for (int i = 0; i < 10; ++i) text << "0.5\n";
  for (int i = 0; i < planes; ++i) text << 15 * i << "\n";
  for (int k = 0; k < kAngles; ++k) text << 5 * k << "\n";
  constexpr int kFirst[] = {0, 0, 0, 3 * kPlanes / 4, 0};
  const int count[] = {planes, 1, kPlanes / 2 + 1, kPlanes / 2 + 1, kPlanes / 4 + 1};
  for (int i = 0; i < count[ldt.symmetry]; ++i)
    for (int k = 0; k < kAngles; ++k) text << f(15 * ((kFirst[ldt.symmetry] + i) % kPlanes), 5 * k) << "\n";
  return text.str();
}

/// The same luminaire as absolute photometry in LM-63 with all planes.
std::string ies_text(const Distribution& f) {
  std::ostringstream text;
  text.precision(17);
  text << "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 " << kAngles << " " << kPlanes + 1
       << " 1 2 1.2 0.3 0\n1 1 54\n";
  for (int k = 0; k < kAngles; ++k) text << 5 * k << " ";
  for (int i = 0; i <= kPlanes; ++i) text << "\n" << 15 * i;
  for (int i = 0; i <= kPlanes; ++i)
    for (int k = 0; k < kAngles; ++k) text << "\n" << f(15 * (i % kPlanes), 5 * k) * kFlux / 1000;
  return text.str();
}

double lobe(double gamma) {
  return 140 + 100 * std::cos(radians(gamma)) + 30 * std::cos(radians(3 * gamma));
}

const Distribution kDistributions[] = {
    [](double c, double g) {
      return lobe(g) * (2 + std::sin(radians(c - 20)) + 0.4 * std::cos(radians(2 * c)));
    },
    [](double, double g) { return lobe(g); },
    [](double c, double g) { return lobe(g) * (2 + std::cos(radians(c)) + 0.3 * std::cos(radians(2 * c))); },
    [](double c, double g) { return lobe(g) * (2 + std::sin(radians(c)) - 0.3 * std::cos(radians(2 * c))); },
    [](double c, double g) { return lobe(g) * (2 + std::cos(radians(2 * c))); },
};

class EulumdatReader : public ::testing::Test {
 protected:
  MeasuredLuminaire read(const std::string& text) {
    return read_luminaire_file(folder_.write("lamp.LDT", text));
  }
  std::string refusal(const std::string& text) {
    return test::refusal_of([&] { read(text); });
  }
  test::TempFolder folder_;
};

TEST_F(EulumdatReader, EverySymmetryEqualsItsTwinInLm63) {
  for (int symmetry = 0; symmetry <= 4; ++symmetry) {
    const Distribution& f = kDistributions[symmetry];
    const MeasuredLuminaire ldt = read(ldt_text(f, {.symmetry = symmetry}));
    const MeasuredLuminaire ies = read_ies_file(folder_.write("lamp.ies", ies_text(f)));
    EXPECT_EQ(ldt.name, "A lamp");
    EXPECT_THAT(ldt.warnings, IsEmpty()) << symmetry;
    EXPECT_EQ(ldt.lamp_lumens, kFlux);
    EXPECT_NEAR(ldt.table->total_flux() / ies.table->total_flux(), 1, 1e-12) << symmetry;
    for (double c = -180; c < 360; c += 7.3)
      for (double gamma = 1; gamma < 180; gamma += 9.7) {
        const double wanted = ies.table->intensity(direction(c, gamma));
        EXPECT_NEAR(ldt.table->intensity(direction(c, gamma)) / wanted, 1, 1e-9) << symmetry << " " << c;
      }
    EXPECT_EQ(ldt.opening.shape, ies.opening.shape);
    EXPECT_TRUE(ldt.opening.size().isApprox(ies.opening.size(), 1e-12)) << "length along C = 90";
  }
}

TEST_F(EulumdatReader, IntensitiesReferToTheFluxOfTheFirstLampSet) {
  const Distribution& f = kDistributions[1];
  const double flux = read(ldt_text(f)).table->total_flux();
  const auto with = [&](const std::string& sets) { return read(ldt_text(f, {.lamp_sets = sets})); };
  // Absolute photometry has a negative number of lamps; the flux is then that of the luminaire.
  const MeasuredLuminaire absolute = with("1\n-1\nLED\n1200\n830\n80\n11\n");
  EXPECT_NEAR(absolute.table->total_flux(), flux / 2, 1e-9);
  EXPECT_EQ(absolute.lamp_lumens, 0);
  EXPECT_THAT(absolute.warnings, IsEmpty());
  const MeasuredLuminaire several = with("2\n1\nT8\n2400\n840\n1B\n36\n2\nT8\n4800\n840\n1B\n72\n");
  EXPECT_NEAR(several.table->total_flux(), flux, 1e-9);
  EXPECT_THAT(several.warnings, ElementsAre(HasSubstr("4800 lm")));
  for (const char* unknown : {"0\n", "1\n1\nT8\n\n\n\n\n"}) {
    const MeasuredLuminaire unstated = with(unknown);
    EXPECT_NEAR(unstated.table->total_flux(), flux / kFlux * 1000, 1e-9);
    EXPECT_THAT(unstated.warnings, ElementsAre(HasSubstr("1000 lm is taken")));
  }
}

TEST_F(EulumdatReader, SaysWhereItsFactorsDisagree) {
  // 4 pi x 100 cd per 1000 lm: 125.66 % of the lamps, half of it downwards.
  const Distribution even = [](double, double) { return 100.0; };
  const auto with = [&](const char* factors) {
    return read(ldt_text(even, {.symmetry = 1, .factors = factors}));
  };
  EXPECT_THAT(with("50\n125,7\n1\n0\n").warnings, IsEmpty()) << "decimal comma";
  EXPECT_THAT(with("50\n80\n1\n0\n").warnings, ElementsAre(HasSubstr("80.0 %")));
  EXPECT_THAT(with("100\n0\n1\n0\n").warnings, ElementsAre(HasSubstr("goes downwards")));
  EXPECT_THAT(with("\n\n\n\n").warnings, IsEmpty());
  EXPECT_THAT(with("0\n0\n1\n15\n").warnings, ElementsAre(HasSubstr("tilt of 15")));
  const double flux = with("0\n0\n1\n0\n").table->total_flux();
  EXPECT_NEAR(with("0\n0\n0.5\n0\n").table->total_flux(), flux / 2, 1e-9);
  EXPECT_THAT(with("0\n0\n0\n0\n").warnings, ElementsAre(HasSubstr("conversion factor")));
}

TEST_F(EulumdatReader, OpeningsByTheSizesOfTheLuminousArea) {
  const auto opening = [&](const char* sizes) {
    return read(ldt_text(kDistributions[1], {.symmetry = 1, .opening = sizes}));
  };
  const auto expect = [&](const char* sizes, OpeningShape shape, double along_c0, double along_c90,
                          double height) {
    const LuminousOpening o = opening(sizes).opening;
    EXPECT_EQ(o.shape, shape) << sizes;
    EXPECT_NEAR((o.size() - Vec3(along_c0, along_c90, height)).norm(), 0, 1e-12) << sizes;
  };
  expect("0\n0\n0\n0\n0\n0\n", OpeningShape::kPoint, 0, 0, 0);
  expect("600\n150\n0\n0\n0\n0\n", OpeningShape::kBox, 0.15, 0.6, 0);
  expect("600\n150\n40\n40\n40\n40\n", OpeningShape::kBox, 0.15, 0.6, 0.04);
  expect("200\n0\n0\n0\n0\n0\n", OpeningShape::kCylinder, 0.2, 0.2, 0);
  expect("200\n0\n50\n50\n50\n50\n", OpeningShape::kCylinder, 0.2, 0.2, 0.05);
  expect("600\n150\n40\n0\n40\n0\n", OpeningShape::kBox, 0.15, 0.6, 0.02);
  EXPECT_THAT(opening("600\n150\n40\n0\n40\n0\n").notes, ElementsAre(HasSubstr("0 to 40 mm")));
}

TEST_F(EulumdatReader, PlaneZeroMayBeListedAgainAsPlane360) {
  const std::string once = ldt_text(kDistributions[0], {});
  const double flux = read(once).table->total_flux();
  EXPECT_EQ(read(ldt_text(kDistributions[0], {.repeats_plane_0 = true})).table->total_flux(), flux);
}

TEST_F(EulumdatReader, RefusesBrokenFilesWithTheirLine) {
  const std::string good = ldt_text(kDistributions[4], {.symmetry = 4});
  const struct {
    const char *from, *to, *at, *says;
  } cases[] = {
      {"Company\n2\n4", "Company\n2\n5", "lamp.LDT:3", "symmetry indicator is 5"},
      {"\n24\n15\n", "\n22\n15\n", "lamp.LDT:7", "divisible by 4"},
      {"\n24\n15\n", "\n0\n15\n", "lamp.LDT:4", "number of C planes is 0"},
      {"\n24\n15\n", "\n\n15\n", "lamp.LDT:4", "missing"},
      {"1200\n300", "1200\n-300", "lamp.LDT:17", "width of the luminous area is -300"},
      {"1200\n300", "1200\nwide", "lamp.LDT:17", "'wide' is not a number"},
      {"\n0\n15\n30\n", "\n0\n30\n15\n", "lamp.LDT", "C angles do not increase"},
      {"\n0\n15\n30\n45\n60\n75\n90\n", "\n0\n15\n30\n45\n60\n75\n95\n", "lamp.LDT",
       "do not fit the symmetry 4"},
  };
  for (const auto& c : cases) {
    const std::string message = refusal(replaced(good, c.from, c.to));
    EXPECT_THAT(message, HasSubstr(c.at)) << c.to;
    EXPECT_THAT(message, HasSubstr(c.says)) << c.to;
  }
  EXPECT_THAT(refusal(good + "7\n"), HasSubstr("'7' comes after the last value"));
  EXPECT_THAT(refusal(ldt_text([](double, double) { return -1.0; })), HasSubstr("negative"));
  EXPECT_THAT(refusal(ldt_text([](double, double) { return 0.0; })), HasSubstr("gives no light"));
  EXPECT_THAT(refusal("IESNA91\nTILT=NONE\n"), HasSubstr("the file ends before"));
}

TEST_F(EulumdatReader, CutAnywhereItIsRefused) {
  const std::string good = ldt_text(kDistributions[1], {.symmetry = 1});
  const std::size_t last_line = good.find_last_of('\n', good.size() - 2) + 1;
  for (std::size_t size = 1; size < last_line; size += 3)
    EXPECT_NE(refusal(good.substr(0, size)), "accepted");
}

}  // namespace
}  // namespace reemit
