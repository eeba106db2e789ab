#include "scenes/io/photometry/ies_reader.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "tests/scenes/type_c.h"
#include "tests/support/refusal.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::replaced;
using test::type_c;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kGood = R"(IESNA:LM-63-2002
[TEST] 1
[LUMINAIRE] A lamp
TILT=NONE
1 800 2.0 3 2 1 2 0.5 0.25 0
0.5 1.0 40
0 45 90
0 90
100 80 0
100 60 20
)";

class IesReader : public ::testing::Test {
 protected:
  MeasuredLuminaire read(const std::string& text) { return read_ies_file(folder_.write("lamp.ies", text)); }
  std::string refusal(const std::string& text) {
    return test::refusal_of([&] { read(text); });
  }
  static std::string source(const char* file) {
    return std::string(REEMIT_SOURCE_DIR "/bench/validation/luminaires/") + file;
  }
  test::TempFolder folder_;
};

TEST_F(IesReader, ReadsNameFactorsAndOpening) {
  const MeasuredLuminaire l = read(kGood);
  EXPECT_EQ(l.name, "A lamp");
  EXPECT_THAT(l.warnings, IsEmpty());
  // Candela multiplier 2 and ballast factor 0.5, each once.
  EXPECT_NEAR(l.table->intensity(type_c(45, 0)), 80, 1e-12);
  EXPECT_NEAR(l.table->intensity(type_c(45, 90)), 60, 1e-12);
  EXPECT_NEAR(l.lamp_lumens, 400, 1e-12);
  EXPECT_EQ(l.opening.shape, LuminousOpening::Shape::kBox);
  EXPECT_EQ(l.opening.width, 0.5);
  EXPECT_EQ(l.opening.length, 0.25);
  EXPECT_NEAR(read(replaced(kGood, " 1 2 0.5", " 1 1 0.5")).opening.width, 0.1524, 1e-15);
}

TEST_F(IesReader, ClosedFormsOfTheValidationTables) {
  const MeasuredLuminaire axial = read_ies_file(source("axial.ies"));
  EXPECT_EQ(axial.name, "axial");
  EXPECT_EQ(axial.opening.shape, LuminousOpening::Shape::kPoint);
  EXPECT_EQ(axial.lamp_lumens, 0) << "absolute photometry";
  EXPECT_NEAR(axial.table->total_flux(), 3134.23604473515, 1e-9);
  const auto illuminance = [](const IntensityTable& table, double x, double y, double h) {
    const Vec3 d(x, y, -h);
    return table.intensity(d) * h / std::pow(d.norm(), 3);
  };
  const double radii[] = {0, 0.5, 1, 2, 4};
  const double e_axial[] = {160, 147.7064216059042, 118.67463389143396, 59.37664852330748,
                            12.593179278118981};
  for (int i = 0; i < 5; ++i)
    for (const double turn : {0.0, 1.0, 4.0})
      EXPECT_NEAR(
          illuminance(*axial.table, radii[i] * std::cos(turn), radii[i] * std::sin(turn), 2.5) / e_axial[i],
          1, 1e-12);
  const MeasuredLuminaire planes = read_ies_file(source("planes.ies"));
  EXPECT_NEAR(planes.table->total_flux(), 2508.47521269804, 1e-9);
  const double points[][3] = {{0, 0, 88.88888888888889},   {1, 0, 72.99077339921196},
                              {0, 1, 78.22652091720406},   {1, 1, 65.483944007406},
                              {2, 0.5, 41.45624206297351}, {3, 4, 6.588269208019499}};
  for (const auto& p : points)
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0})
        EXPECT_NEAR(illuminance(*planes.table, sx * p[0], sy * p[1], 3) / p[2], 1, 1e-12);
}

TEST_F(IesReader, AllEditionsAndLineEnds) {
  const double flux = read(kGood).table->total_flux();
  std::string crlf = "\xEF\xBB\xBF";
  for (const char* c = kGood; *c != 0; ++c) crlf += *c == '\n' ? "  \r\n" : std::string(1, *c);
  EXPECT_EQ(read(crlf + "\x1a").table->total_flux(), flux);
  EXPECT_EQ(read(crlf).name, "A lamp");
  for (const char* header : {"IESNA91", "IESNA:LM-63-1995", "IES:LM-63-2019", "IESNA86"})
    EXPECT_EQ(read(replaced(kGood, "IESNA:LM-63-2002", header)).table->total_flux(), flux) << header;
  const MeasuredLuminaire old =
      read(replaced(kGood, "IESNA:LM-63-2002\n[TEST] 1\n[LUMINAIRE] A lamp", "Acme\nA lamp"));
  EXPECT_EQ(old.table->total_flux(), flux);
  EXPECT_EQ(old.name, "Acme");
  EXPECT_EQ(
      read(replaced(kGood, "0 45 90\n0 90\n100 80 0\n", "0,45\n90,0\n\n90 100\n80, 0 ")).table->total_flux(),
      flux);
}

TEST_F(IesReader, TheSecondFactorCountsInOldEditionsOnly) {
  const double flux = read(kGood).table->total_flux();
  const std::string text = replaced(kGood, "0.5 1.0 40", "0.5 0.25 40");
  EXPECT_NEAR(read(replaced(text, "IESNA:LM-63-2002", "IESNA91")).table->total_flux(), flux / 4, 1e-12);
  EXPECT_EQ(read(replaced(text, "IESNA:LM-63-2002", "IES:LM-63-2019")).table->total_flux(), flux);
  const MeasuredLuminaire l = read(text);
  EXPECT_EQ(l.table->total_flux(), flux);
  ASSERT_THAT(l.warnings, SizeIs(1));
  EXPECT_THAT(l.warnings[0], HasSubstr("lamp.ies:6"));
}

TEST_F(IesReader, Symmetries) {
  const auto at = [](const MeasuredLuminaire& l, double c) { return l.table->intensity(type_c(45, c)); };
  const auto with = [&](const std::string& angles, const std::string& rows) {
    const auto count = std::count(angles.begin(), angles.end(), ' ') + 1;
    return read("IESNA91\nTILT=NONE\n1 -1 1 3 " + std::to_string(count) + " 1 2 0 0 0\n1 1 0\n0 45 90\n" +
                angles + "\n" + rows);
  };
  const MeasuredLuminaire quadrant = with("0 45 90", "9 1 0 9 2 0 9 4 0");
  for (const double c : {22.5, 157.5, 202.5, 337.5, -22.5}) EXPECT_NEAR(at(quadrant, c), 1.5, 1e-12) << c;
  const MeasuredLuminaire half = with("0 90 180", "9 1 0 9 2 0 9 4 0");
  for (const double c : {135.0, 225.0}) EXPECT_NEAR(at(half, c), 3, 1e-12) << c;
  for (const double c : {45.0, 315.0}) EXPECT_NEAR(at(half, c), 1.5, 1e-12) << c;
  const MeasuredLuminaire across = with("90 180 270", "9 1 0 9 2 0 9 4 0");
  for (const double c : {180.0, 0.0, 360.0}) EXPECT_NEAR(at(across, c), 2, 1e-12) << c;
  for (const double c : {225.0, 315.0}) EXPECT_NEAR(at(across, c), 3, 1e-12) << c;
  const MeasuredLuminaire all = with("0 90 180 360", "9 1 0 9 2 0 9 4 0 9 1 0");
  EXPECT_NEAR(at(all, 270), 2.5, 1e-12);
  EXPECT_NEAR(at(with("0", "9 1 0"), 123), 1, 1e-12);
  const MeasuredLuminaire open = with("0 90 180 270", "9 1 0 9 2 0 9 4 0 9 3 0");
  EXPECT_NEAR(at(open, 315), 2, 1e-12);
  EXPECT_THAT(open.warnings, SizeIs(1));
}

TEST_F(IesReader, TypesAAndB) {
  const auto table = [&](int type, const std::string& horizontal) {
    const auto count = std::count(horizontal.begin(), horizontal.end(), ' ') + 1;
    std::string rows;
    for (int i = 0; i < count; ++i) rows += std::to_string(i + 1) + " 10 0\n";
    return read("IESNA91\nTILT=NONE\n1 -1 1 3 " + std::to_string(count) + " " + std::to_string(type) +
                " 2 0 0 0\n1 1 0\n-90 0 90\n" + horizontal + "\n" + rows);
  };
  // Type A: the beam (0, 0) is x, positive horizontal angles are clockwise seen from above.
  const MeasuredLuminaire a = table(3, "-90 0 90");
  EXPECT_NEAR(a.table->intensity({1, 0, 0}), 10, 1e-12);
  EXPECT_EQ(a.table->intensity({-1, 0, 0}), 0);
  const double s = std::sqrt(0.5);
  EXPECT_NEAR(a.table->intensity({s * s, -s * s, -s}), 6.25, 1e-12);  // vertical -45, horizontal 45
  EXPECT_NEAR(a.table->intensity({s * s, s * s, -s}), 5.75, 1e-12);
  EXPECT_NEAR(table(3, "0 90").table->intensity({s * s, s * s, -s}), 5.75, 1e-12) << "mirrored";
  // Type B: (0, 0) is the nadir, vertical 90 is x; latitudes run to -y.
  const MeasuredLuminaire b = table(2, "-90 0 90");
  EXPECT_NEAR(b.table->intensity({0, 0, -1}), 10, 1e-12);
  EXPECT_NEAR(b.table->intensity({-s, 0, -s}), 6, 1e-12);              // vertical -45
  EXPECT_NEAR(b.table->intensity({-s * s, -s, -s * s}), 6.25, 1e-12);  // horizontal 45
  EXPECT_NEAR(b.table->intensity({-s * s, s, -s * s}), 5.75, 1e-12);
  // Independent flux: midpoint rule over vertical and horizontal angle.
  double flux = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double v = -90 + 180 * (i + 0.5) / kSteps;
      const double h = -90 + 180 * (j + 0.5) / kSteps;
      const double low = h < 0 ? 2 + h / 90 : 2 + h / 90;
      const double i_vh = v < 0 ? 10 + (10 - low) * v / 90 : 10 - 10 * v / 90;
      flux += i_vh * std::cos(h * pi / 180) * std::pow(pi / kSteps, 2);
    }
  EXPECT_NEAR(b.table->total_flux() / flux, 1, 1e-5);
}

TEST_F(IesReader, TiltDataAreReadAndTheUprightFactorTaken) {
  const double flux = read(kGood).table->total_flux();
  const std::string tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n0.5 0.9 0.8";
  const MeasuredLuminaire l = read(replaced(kGood, "TILT=NONE", tilt));
  EXPECT_NEAR(l.table->total_flux(), flux / 2, 1e-12);
  EXPECT_THAT(l.notes, SizeIs(1));
  folder_.write("lamp.tlt", "2 2 0 90\n1 1\n");
  const MeasuredLuminaire m = read(replaced(kGood, "TILT=NONE", "TILT=lamp.tlt"));
  EXPECT_EQ(m.table->total_flux(), flux);
  EXPECT_THAT(m.notes, IsEmpty());
}

TEST_F(IesReader, OpeningsBySign) {
  using Shape = LuminousOpening::Shape;
  using Axis = LuminousOpening::Axis;
  const auto opening = [&](const std::string& header, const std::string& sizes) {
    return read(replaced(replaced(kGood, "IESNA:LM-63-2002", header), "0.5 0.25 0", sizes)).opening;
  };
  const auto expect = [&](const std::string& header, const std::string& sizes, Shape shape, Axis axis,
                          double l, double w, double h) {
    const LuminousOpening o = opening(header, sizes);
    EXPECT_EQ(o.shape, shape) << header << ": " << sizes;
    EXPECT_EQ(o.axis, axis) << header << ": " << sizes;
    EXPECT_TRUE(o.size().isApprox(Vec3(l, w, h))) << header << ": " << sizes;
  };
  for (const char* any : {"IESNA91", "IESNA:LM-63-2002"}) {
    expect(any, "0 0 0", Shape::kPoint, Axis::kHeight, 0, 0, 0);
    expect(any, "2 3 0", Shape::kBox, Axis::kHeight, 3, 2, 0);
    expect(any, "2 3 4", Shape::kBox, Axis::kHeight, 3, 2, 4);
    expect(any, "-2 0 0", Shape::kCylinder, Axis::kHeight, 2, 2, 0);
    expect(any, "-2 -2 0", Shape::kCylinder, Axis::kHeight, 2, 2, 0);
    expect(any, "-2 -3 0", Shape::kCylinder, Axis::kHeight, 3, 2, 0);
    expect(any, "-2 -3 4", Shape::kCylinder, Axis::kHeight, 3, 2, 4);
    expect(any, "-2 0 4", Shape::kCylinder, Axis::kHeight, 2, 2, 4);
    expect(any, "-2 -2 -2", Shape::kEllipsoid, Axis::kHeight, 2, 2, 2);
    expect(any, "-2 -3 -4", Shape::kEllipsoid, Axis::kHeight, 3, 2, 4);
    expect(any, "0 3 -2", Shape::kCylinder, Axis::kLength, 3, 2, 2);
    expect(any, "3 0 -2", Shape::kCylinder, Axis::kWidth, 2, 3, 2);
  }
  expect("IESNA:LM-63-2002", "-2 3 -2", Shape::kCylinder, Axis::kLength, 3, 2, 2);
  expect("IESNA:LM-63-2002", "3 -2 -4", Shape::kCylinder, Axis::kWidth, 2, 3, 4);
  expect("IESNA:LM-63-2002", "-2 0 -4", Shape::kCylinder, Axis::kLength, 0, 2, 4);
  expect("IESNA:LM-63-1995", "-2 3 -2", Shape::kEllipsoid, Axis::kHeight, 3, 2, 2);
  expect("IESNA:LM-63-1995", "-2 0 -2", Shape::kEllipsoid, Axis::kHeight, 2, 2, 2);
  const MeasuredLuminaire odd = read(replaced(kGood, "0.5 0.25 0", "1 1 -1"));
  EXPECT_THAT(odd.warnings, SizeIs(1));
}

TEST_F(IesReader, WarnsOfMoreLightThanTheLampsGive) {
  EXPECT_THAT(read(replaced(kGood, "1 800 2.0", "1 100 2.0")).warnings, SizeIs(1));
  EXPECT_THAT(read(replaced(kGood, "1 800 2.0", "1 -1 2.0")).warnings, IsEmpty());
  EXPECT_THAT(read(replaced(kGood, "1 800 2.0", "1 1e6 2.0")).warnings, SizeIs(1));
}

TEST_F(IesReader, TextAfterTheLastValueIsLeft) {
  const double flux = read(kGood).table->total_flux();
  for (const char* rest : {"END\n", "\r\nEND", " 92.5  paint reflectance\n", "\n[MORE] 1\n2 3\n"}) {
    const MeasuredLuminaire l = read(std::string(kGood) + rest);
    EXPECT_EQ(l.table->total_flux(), flux) << rest;
    ASSERT_THAT(l.warnings, SizeIs(1)) << rest;
    EXPECT_THAT(l.warnings[0], HasSubstr("lamp.ies:1")) << rest;
  }
}

TEST_F(IesReader, IsDarkOutsideOfAnglesThatCoverLess) {
  // An uplight whose table begins a little below the horizon.
  const MeasuredLuminaire up =
      read(replaced(replaced(kGood, "1 800", "1 1200"), "0 45 90\n", "85 135 180\n"));
  ASSERT_THAT(up.warnings, SizeIs(1));
  EXPECT_THAT(up.warnings[0], HasSubstr("from 85 to 180 degrees only"));
  EXPECT_NEAR(up.table->intensity(type_c(85, 0)), 100, 1e-9);
  EXPECT_NEAR(up.table->intensity(type_c(135, 90)), 60, 1e-9);
  EXPECT_EQ(up.table->intensity(type_c(84, 0)), 0);
  const MeasuredLuminaire spot = read(replaced(kGood, "0 45 90\n", "0 10 25\n"));
  EXPECT_EQ(spot.table->intensity(type_c(26, 0)), 0);
  EXPECT_THAT(spot.warnings, SizeIs(1));
  // Floodlights of type B are measured around their beam only.
  const std::string flood =
      replaced(replaced(kGood, "3 2 1 2", "3 2 2 2"), "0 45 90\n0 90", "-30 0 30\n-20 20");
  const MeasuredLuminaire b = read(flood);
  EXPECT_THAT(b.warnings, SizeIs(1));
  EXPECT_NEAR(b.table->intensity({0, 0, -1}), 70, 1e-9);
  EXPECT_EQ(b.table->intensity({0, std::sin(21 * pi / 180), -std::cos(21 * pi / 180)}), 0);
}

TEST_F(IesReader, RemarksAboveTheEditionDoNotHideIt) {
  const double flux = read(kGood).table->total_flux();
  const std::string second_factor = replaced(kGood, "0.5 1.0 40", "0.5 0.5 40");
  for (const char* above : {"\n", "made by hand\n", "\n\n  \n"})
    EXPECT_EQ(read(above + second_factor).table->total_flux(), flux) << "of 1986 half";
  EXPECT_NEAR(read(replaced(second_factor, "IESNA:LM-63-2002", "IESNA:LM-63-1991 (R)")).table->total_flux(),
              flux / 2, 1e-9);
}

TEST_F(IesReader, WhatOnlyServesForChecksRefusesNothing) {
  const double flux = read(kGood).table->total_flux();
  for (const char* lamps : {"0 800 2.0", "1 -2 2.0", "1 0 2.0"}) {
    const MeasuredLuminaire l = read(replaced(kGood, "1 800 2.0", lamps));
    EXPECT_EQ(l.table->total_flux(), flux) << lamps;
    EXPECT_EQ(l.lamp_lumens, 0) << lamps;
    EXPECT_THAT(l.warnings, ElementsAre(HasSubstr("unchecked"))) << lamps;
  }
  EXPECT_EQ(read(replaced(kGood, "0.5 1.0 40", "0.5 1.0 -1")).table->total_flux(), flux);
}

TEST_F(IesReader, NoiseBelowZeroIsDarkness) {
  const MeasuredLuminaire l = read(replaced(kGood, "100 80 0", "100 80 -0.5"));
  EXPECT_EQ(l.table->total_flux(), read(kGood).table->total_flux());
  EXPECT_THAT(l.warnings, ElementsAre(HasSubstr("1 intensities slightly below 0")));
}

TEST_F(IesReader, RefusesBrokenFiles) {
  const struct {
    const char *from, *to, *at, *says;
  } cases[] = {
      {"TILT=NONE\n", "", "lamp.ies:9", "not an IES"},
      {"TILT=NONE", "TILT=", "lamp.ies:4", "TILT="},
      {"TILT=NONE", "TILT=nowhere.tlt", "lamp.ies:4", "nowhere.tlt"},
      {"TILT=NONE", "TILT=INCLUDE\n4\n1\n0\n1", "lamp.ies:5", "geometry"},
      {"TILT=NONE", "TILT=INCLUDE\n1\n2\n0 0\n1 1", "lamp.ies:7", "do not increase"},
      {"TILT=NONE", "TILT=INCLUDE\n1\n2\n0 1\n1 -1", "lamp.ies:8", "tilt factor"},
      {"1 800 2.0", "1 800 0", "lamp.ies:5", "multiplier is 0"},
      {"1 800 2.0", "1 800 -1", "lamp.ies:5", "multiplier is -1"},
      {"1 800 2.0", "1 800 nan", "lamp.ies:5", "'nan' is not a number"},
      {"3 2 1 2", "3.5 2 1 2", "lamp.ies:5", "vertical angles is 3.5"},
      {"3 2 1 2", "1 2 1 2", "lamp.ies:5", "vertical angles is 1"},
      {"3 2 1 2", "2000000000 2 1 2", "lamp.ies:5", "vertical angles"},
      {"3 2 1 2", "9999 9999 1 2", "lamp.ies:5", "9999 x 9999"},
      {"3 2 1 2", "900 900 1 2", "lamp.ies:6", "too short"},
      {"3 2 1 2", "3 2 4 2", "lamp.ies:5", "photometric type is 4"},
      {"3 2 1 2", "3 2 1 0", "lamp.ies:5", "units type is 0"},
      {"3 2 1 2", "4 2 1 2", "lamp.ies:8", "do not increase"},
      {"3 2 1 2", "2 2 1 2", "lamp.ies:8", "do not increase"},
      {"0.5 1.0 40", "0 1.0 40", "lamp.ies:6", "ballast factor is 0"},
      {"0.5 1.0 40\n", "", "lamp.ies:6", "input watts missing"},
      {"0 45 90\n", "0 90 45\n", "lamp.ies:7", "do not increase"},
      {"0 45 90\n", "-10 45 90\n", "lamp.ies:7", "-10 to 90"},
      {"0 45 90\n", "0 45 190\n", "lamp.ies:7", "0 to 190"},
      {"\n0 90\n", "\n0 80\n", "lamp.ies:8", "0 to 80"},
      {"\n0 90\n", "\n90 180\n", "lamp.ies:8", "90 to 180"},
      {"100 60 20", "100 60", "lamp.ies:10", "number 6 of 6 candela"},
      {"100 60 20", "100 -60 20", "lamp.ies:10", "negative"},
      {"100 60 20", "100 inf 20", "lamp.ies:10", "'inf'"},
      {"100 60 20", "100 60 20 7", "lamp.ies:10", "'7' comes after the last value"},
      {"100 60 20\n", "100 60 20\n7 8\nEND\n", "lamp.ies:11", "'7 8' comes after the last value"},
      {"100 80 0\n100 60 20", "0 0 0\n0 0 0", "lamp.ies:10", "gives no light"},
      {"100 60 20", "100 1.7e308 20", "lamp.ies:10", "no number"},
  };
  for (const auto& c : cases) {
    const std::string message = refusal(replaced(kGood, c.from, c.to));
    EXPECT_THAT(message, HasSubstr(c.at)) << c.to;
    EXPECT_THAT(message, HasSubstr(c.says)) << c.to;
  }
  EXPECT_THAT(refusal("just some text\n"), HasSubstr("not an IES"));
  EXPECT_THAT(refusal("IESNA91\nTILT=NONE\n"), HasSubstr("the file ends before the number of lamps"));
  EXPECT_THROW(read_ies_file(folder_ / "none.ies"), InputError);
}

TEST_F(IesReader, CutAnywhereItIsRefusedOrRead) {
  const std::string text = kGood;
  int refused = 0;
  for (std::size_t size = 1; size < text.size(); ++size) {
    try {
      read(text.substr(0, size));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GE(refused, static_cast<int>(text.size()) - 5);
}

TEST_F(IesReader, LibraryReadsEachFileOnce) {
  const auto file = folder_.write("a.ies", replaced(kGood, "1 800 2.0", "1 100 2.0"));
  LuminaireLibrary library;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;
  const auto* first = library.load(file, warnings, notes).table.get();
  EXPECT_EQ(library.load(file.parent_path() / "." / "a.ies", warnings, notes).table.get(), first);
  EXPECT_THAT(warnings, SizeIs(1));
}

}  // namespace
}  // namespace reemit
