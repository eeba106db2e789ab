#include "solver/solution/gather_plan_group.h"

#include <algorithm>

#include "solver/solution/file_damage.h"

namespace reemit {
namespace {

/// Files that have `caustic_packets` instead are of a program that kept no photons on black surfaces: they
/// are read as if nobody had looked.
constexpr const char* kPacketsAttribute = "photon_packets";

void write_packets(const Hdf5Group& group, const CausticPackets& caustics) {
  group.write_attribute(kPacketsAttribute, caustics.packets);
  std::vector<std::uint64_t> bytes;
  std::vector<std::uint8_t> marks;
  for (const std::vector<std::uint8_t>& of_part : caustics.brings) {
    bytes.push_back(of_part.size());
    marks.insert(marks.end(), of_part.begin(), of_part.end());
  }
  group.write<std::uint64_t>("caustic_part_bytes", bytes, {bytes.size()}, "1",
                             "bytes of caustic_marks that belong to each part of the packets");
  group.write<std::uint8_t>("caustic_marks", marks, {marks.size()}, "",
                            "bit i % 8 of byte i / 8 of a part: 1 if its packet i brings light over mirrors");
  group.write<std::uint8_t>("caustic_radii", caustics.radius_codes, {caustics.radius_codes.size()}, "",
                            "radius of each photon, 24 steps to an octave");
}

CausticPackets read_packets(const Hdf5Group& group) {
  CausticPackets caustics;
  caustics.packets = group.read_attribute<std::uint32_t>(kPacketsAttribute);
  caustics.radius_codes = group.read<std::uint8_t>("caustic_radii", group.shape("caustic_radii"));
  const Hdf5Shape parts = group.shape("caustic_part_bytes");
  const Hdf5Shape size = group.shape("caustic_marks");
  const auto marks = group.read<std::uint8_t>("caustic_marks", size);
  std::size_t begin = 0;
  for (const std::uint64_t bytes : group.read<std::uint64_t>("caustic_part_bytes", parts)) {
    require_intact(bytes <= marks.size() - begin, "fewer marks of packets than there are packets");
    const auto first = marks.begin() + static_cast<std::ptrdiff_t>(begin);
    caustics.brings.emplace_back(first, first + static_cast<std::ptrdiff_t>(bytes));
    begin += bytes;
  }
  return caustics;
}

}  // namespace

void write_gather_plan(const Hdf5Group& root, const Solution& solution) {
  const GatherPlan& plan = solution.gather_plan;
  if (plan.uneven.empty() && !plan.caustics) return;
  const Hdf5Group group = root.create_group("gather_plan");
  group.write_attribute("seed", plan.seed);
  if (!plan.uneven.empty())
    group.write<std::uint8_t>("uneven", plan.uneven, {plan.uneven.size()}, "",
                              "1: gather rays that see a part of the zone are continued from there");
  if (plan.caustics) write_packets(group, *plan.caustics);
}

void read_gather_plan(const Hdf5Group& root, Solution& solution) {
  if (!root.has_dataset("gather_plan")) return;
  const Hdf5Group group = root.open_group("gather_plan");
  GatherPlan& plan = solution.gather_plan;
  plan.seed = group.read_attribute<std::uint64_t>("seed");
  if (group.has_dataset("uneven"))
    plan.uneven = group.read<std::uint8_t>("uneven", {solution.mesh.zone_count()});
  require_intact(std::all_of(plan.uneven.begin(), plan.uneven.end(), [](std::uint8_t u) { return u <= 1; }),
                 "a zone is neither even nor uneven");
  if (group.has_attribute(kPacketsAttribute)) plan.caustics = read_packets(group);
}

}  // namespace reemit
