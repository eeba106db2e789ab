#include "viewer_export/cli/audit_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace reemit::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Two surfaces, two bands, one quantum = 0.5 W over 2 batches, books that balance.
EnergyAudit balanced_audit() {
  EnergyAudit audit;
  audit.batches = 2;
  audit.weight = 2;
  for (const char* name : {"r", "g"}) {
    BandAudit band;
    band.band = name;
    band.watts_per_quantum = 0.5;
    band.emitted = 100;
    band.absorbed = {10, 60};
    band.absorbed_on_backs = {0, 4};
    band.escaped = {1, 0, 0, 0, 0, 15};
    band.unshot = 8;
    band.roulette_net = -2;
    band.roulette_gain = 3;
    audit.bands.push_back(band);
  }
  return audit;
}

TEST(AuditReport, JsonHoldsPowersThatAddUp) {
  const auto json = audit_json(balanced_audit(), {"floor", "wall"});
  EXPECT_TRUE(json["balanced"].get<bool>());
  ASSERT_EQ(json["bands"].size(), 2U);
  const auto& band = json["bands"][0];
  EXPECT_EQ(band["name"], "r");
  EXPECT_DOUBLE_EQ(band["emitted_W"].get<double>(), 25);
  EXPECT_DOUBLE_EQ(band["absorbed_W"].get<double>(), 18.5);
  EXPECT_DOUBLE_EQ(band["escaped_W"].get<double>(), 4);
  EXPECT_DOUBLE_EQ(band["escaped_by_direction_W"]["-z"].get<double>(), 3.75);
  EXPECT_DOUBLE_EQ(band["unshot_W"].get<double>(), 2);
  EXPECT_DOUBLE_EQ(band["roulette_W"].get<double>(), 0.5);
  EXPECT_DOUBLE_EQ(band["emitted_W"].get<double>(),
                   band["absorbed_W"].get<double>() + band["escaped_W"].get<double>() +
                       band["unshot_W"].get<double>() + band["roulette_W"].get<double>());
  EXPECT_TRUE(band["balance_quanta"].is_number_integer());
  EXPECT_EQ(band["balance_quanta"].get<std::int64_t>(), 0);
}

TEST(AuditReport, RareEventsAreCounted) {
  EnergyAudit audit = balanced_audit();
  audit.events = {1234, 5, 67, 8, 9};
  EXPECT_THAT(
      audit_text(audit, {"floor", "wall"}),
      AllOf(HasSubstr("an edge, a back or nothing: 1234; packets that ended on backs: 5, outside: 67"),
            HasSubstr("behind their face: 8; packets that roulette made more than twice the usual: 9\n")));
  const auto events = audit_json(audit, {"floor", "wall"})["events"];
  EXPECT_EQ(events["second_looks"], 1234);
  EXPECT_EQ(events["starts_behind"], 8);
  EXPECT_EQ(events["roulette_jumps"], 9);
}

TEST(AuditReport, SurfacesComeByFallingPower) {
  const auto json = audit_json(balanced_audit(), {"floor", "wall"});
  ASSERT_EQ(json["surfaces"].size(), 2U);
  EXPECT_EQ(json["surfaces"][0]["name"], "wall");
  EXPECT_DOUBLE_EQ(json["surfaces"][0]["absorbed_W"][1].get<double>(), 15);
  EXPECT_EQ(json["surfaces"][1]["name"], "floor");
}

TEST(AuditReport, OneMissingQuantumIsReported) {
  EnergyAudit audit = balanced_audit();
  audit.bands[1].unshot -= 1;
  const auto json = audit_json(audit, {"floor", "wall"});
  EXPECT_FALSE(json["balanced"].get<bool>());
  EXPECT_EQ(json["bands"][0]["balance_quanta"].get<std::int64_t>(), 0);
  EXPECT_EQ(json["bands"][1]["balance_quanta"].get<std::int64_t>(), 1);
  EXPECT_THAT(audit_text(audit, {"floor", "wall"}), HasSubstr("DO NOT BALANCE"));
}

TEST(AuditReport, TextNamesWhatTookPower) {
  const std::string text = audit_text(balanced_audit(), {"floor", "wall"});
  EXPECT_THAT(text, HasSubstr("balance exactly"));
  EXPECT_LT(text.find("wall"), text.find("floor"));
  EXPECT_THAT(text, HasSubstr("towards -z"));
  EXPECT_THAT(text, Not(HasSubstr("towards +y")));
}

}  // namespace
}  // namespace reemit::cli
