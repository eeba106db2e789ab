// A short form of the validation (docs/validation.md): some cases of every family, with the limit of five
// standard errors, and proof that each of these checks would notice a bias of 2 %.

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/validation/families.h"
#include "bench/validation/reference_cases.h"

namespace reemit::validation {
namespace {

/// Odds of a false alarm per row: 5e-6 (Student's t, 63 degrees of freedom); kMostOdds holds for each test.
constexpr double kRowLimit = 5;
constexpr double kMostOdds = 2e-3;
constexpr double kPlanted = 1.02;

bool is_beyond(const ValidationRow& r) {
  return std::fabs(r.deviation()) > kRowLimit;
}

/// Cases by name, or by the id of their first value.
std::vector<ReferenceCase> pick(const std::vector<std::string>& names) {
  static const std::vector<ReferenceCase> all = read_reference_cases(reference_cases_path());
  std::vector<ReferenceCase> picked;
  for (const std::string& name : names) {
    const std::size_t before = picked.size();
    for (const ReferenceCase& c : all)
      if (c.name == name || c.values.front().id == name) picked.push_back(c);
    EXPECT_GT(picked.size(), before) << "no reference case " << name;
  }
  return picked;
}

const Family& family(const std::string& name) {
  static const std::vector<Family> all = families();
  return *std::find_if(all.begin(), all.end(), [&](const Family& f) { return f.name == name; });
}

/// All rows agree with the reference, and with 2 % on top every kind of case has one that does not.
void expect_valid(const std::string& family_name, const std::vector<std::string>& names, double work) {
  const std::vector<ReferenceCase> cases = pick(names);
  const std::vector<ValidationRow> rows = family(family_name).evaluate(cases, Effort{work});
  std::map<std::string, bool> notices;
  double odds = 0;
  for (const ValidationRow& r : rows) {
    EXPECT_FALSE(is_beyond(r)) << r.id << " by " << r.method << ": " << r.measured << " +- "
                               << r.standard_error << ", reference " << r.expected << ": off by "
                               << r.deviation() << " standard errors";
    odds += r.odds_beyond(kRowLimit);
    ValidationRow biased = r;
    biased.measured *= kPlanted;
    notices[r.kind] = notices[r.kind] || is_beyond(biased);
  }
  for (const ReferenceCase& c : cases)
    EXPECT_TRUE(notices[c.kind]) << "a bias of 2 % in " << c.kind << " would pass";
  EXPECT_LT(odds, kMostOdds);
}

TEST(Validation, form_factors) {
  expect_valid("form factors",
               {"vf.parsq.1", "vf.perp.gap", "vf.disks.1", "vf.sphere.disk", "vf.cylinder", "lroom.F16.PB",
                "flux.split", "irr.mean"},
               0.5);
}

TEST(Validation, direct_light) {
  expect_valid("direct light",
               {"irr.rect.corner", "irr.rect.tilted", "irr.rect.horizon", "irr.rect.near", "irr.rect.far",
                "irr.tri.1", "irr.disk.off", "irr.disk.clip", "irr.sphere.partly", "irr.cyl.B31",
                "occ.rect.half", "occ.rect.two", "cornelldirect.(100,0,60)", "cornelldirect.(150,0,320)",
                "cornelldirect.(520,0,250)", "cornelldirect.(260,165,200)", "point.room", "sky.roof"},
               1);
}

TEST(Validation, measured_luminaires) {
  expect_valid("measured luminaires", {"ies.axial.total_flux_lm", "ies.planes.total_flux_lm"}, 1);
}

TEST(Validation, enclosures) {
  expect_valid("enclosures",
               {"furnace.0.5", "furnace.var", "sphere.0.5", "energy.closed", "conc.spheres", "conc.cyl"},
               0.05);
}

TEST(Validation, continuous_rooms) {
  expect_valid("continuous rooms",
               {"cube1.rho0.5", "goral.R", "goral.G", "goral.B", "ward1990.grey", "cie58.rho0.8",
                "plates.h0.25", "lroom.rho0.5"},
               0.15);
}

TEST(Validation, mirrors) {
  expect_valid("mirrors",
               {"mirror.one", "mirror.double", "mirror.corner", "mirror.parallel", "mirror.finite", "pipe.1",
                "pipe.0.5", "plates.inf", "crease.inf.one", "mirrorcube.rs0.9.rho0.5"},
               0.2);
}

TEST(Validation, glass) {
  expect_valid("glass",
               {"slab.direct", "slab.1.5.0", "slab.1.5.60", "slab.1.5.85", "slab.abs.0", "slab.abs.80",
                "slab.hemi", "slab.hemi.abs"},
               0.2);
}

TEST(Validation, zonal_systems) {
  expect_valid("zonal systems",
               {"zone6.cube.0.5", "zone6.goral.R", "cubetri12.rho0.8", "ico0.rho0.5", "zone3.cylinder"}, 0.2);
}

/// Every case of the family has a row beyond the limit.
void expect_noticed(const std::string& family_name, const std::vector<ReferenceCase>& cases, double work) {
  std::set<std::string> noticed;
  for (const ValidationRow& r : family(family_name).evaluate(cases, Effort{work}))
    if (is_beyond(r)) noticed.insert(r.id);
  for (const ReferenceCase& c : cases)
    EXPECT_TRUE(std::any_of(c.values.begin(), c.values.end(),
                            [&](const ReferenceValue& v) { return noticed.count(v.id) > 0; }))
        << c.name << " does not notice the planted input";
}

/// Multiplies every number below a parameter.
void multiply(nlohmann::json& value, double factor) {
  if (value.is_number()) value = value.get<double>() * factor;
  if (value.is_structured())
    for (nlohmann::json& part : value) multiply(part, factor);
}

TEST(ValidationPower, reflectance_2_percent_too_high_is_noticed) {
  const std::map<std::string, std::vector<std::string>> names{
      {"enclosures", {"furnace.0.5", "energy.closed"}},
      {"continuous rooms", {"cube1.rho0.8", "lroom.rho0.8"}},
      {"zonal systems", {"zone6.cube.0.8", "cubetri12.rho0.8", "ico0.rho0.9"}}};
  for (const auto& [family_name, list] : names) {
    std::vector<ReferenceCase> cases = pick(list);
    for (ReferenceCase& c : cases) multiply(c.parameters["rho"], kPlanted);
    // The twelve triangles of a cube are cases of one value each; not all of them move by much.
    cases.erase(std::unique(cases.begin(), cases.end(),
                            [](const ReferenceCase& a, const ReferenceCase& b) { return a.name == b.name; }),
                cases.end());
    expect_noticed(family_name, cases, 0.05);
  }
}

TEST(ValidationPower, mirror_2_percent_too_good_is_noticed) {
  std::vector<ReferenceCase> cases = pick({"pipe.1", "pipe.0.5"});
  for (ReferenceCase& c : cases) multiply(c.parameters["rho_s"], kPlanted);
  expect_noticed("mirrors", cases, 1);
}

TEST(ValidationPower, index_of_refraction_2_percent_too_high_is_noticed) {
  std::vector<ReferenceCase> cases = pick({"slab.1.5.30", "slab.hemi"});
  for (ReferenceCase& c : cases) multiply(c.parameters["n"], kPlanted);
  expect_noticed("glass", cases, 0.3);
}

TEST(ValidationPower, luminaire_area_2_percent_too_large_is_noticed) {
  std::vector<ReferenceCase> cases = pick({"irr.rect.far", "irr.rect.wall", "cie56.50cm.v6"});
  for (ReferenceCase& c : cases) multiply(c.parameters["luminaire"]["edge_u"], kPlanted);
  expect_noticed("direct light", cases, 1);
}

TEST(ValidationPower, luminaire_hung_1_percent_too_low_is_noticed) {
  std::vector<ReferenceCase> cases = pick({"ies.axial.total_flux_lm"});
  multiply(cases[0].parameters["h"], 0.99);
  expect_noticed("measured luminaires", cases, 1);
}

TEST(ValidationPower, emitted_power_2_percent_too_high_is_noticed) {
  std::vector<ReferenceCase> cases = pick({"sphere.0.5", "energy.closed"});
  for (ReferenceCase& c : cases) multiply(c.parameters["flux"], kPlanted);
  // The multiplier divides by the flux, so it alone would not notice; the irradiances do.
  expect_noticed("enclosures", cases, 0.2);
}

TEST(Validation, every_case_has_an_evaluator) {
  std::set<std::string> kinds;
  for (const Family& f : families()) kinds.insert(f.kinds.begin(), f.kinds.end());
  std::set<std::string> ids;
  for (const ReferenceCase& c : read_reference_cases(reference_cases_path())) {
    EXPECT_TRUE(kinds.count(c.kind)) << c.kind;
    for (const ReferenceValue& v : c.values) EXPECT_TRUE(ids.insert(v.id).second) << v.id << " twice";
  }
}

}  // namespace
}  // namespace reemit::validation
