#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/build_mesh.h"
#include "mesh/zones/zone_mesh.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/bands.h"
#include "scenes/model/scene.h"
#include "solver/solution/channels.h"
#include "solver/solution/energy_audit.h"
#include "solver/solution/form_factor_report.h"
#include "solver/solution/gather_plan.h"
#include "solver/solution/solver_settings.h"
#include "solver/solution/zone_bias.h"

namespace reemit {

/// Sums over batches of the irradiance x of every zone [W/m2], index zone * channels.count() + channel. One
/// batch is one independent estimate, of weight w: its packets over those of the smallest batch. Means and
/// standard errors follow from the sums alone, and more batches can be added later. The mean is sum(w
/// x)/sum(w), and its squared standard error sum(w^2 (x - mean)^2) / (sum(w)^2 - sum(w^2)): that of a ratio
/// estimate
/// ([COC77] 6.4), which does not presume that the variance of a batch falls as 1/w, with the correction for
/// few batches that is exact if it does. With equal weights it is the textbook's.
struct ZoneSums {
  /// Batch k belongs to group k mod kGroups. What reads the zone solution in as many independent replicates
  /// as there are groups, each replicate its own group, gets an error bar that holds the noise of the zones
  /// too.
  static constexpr std::size_t kGroups = 16;

  Channels channels{1};
  std::int64_t batches = 0;
  std::array<std::int64_t, kGroups> group_weight{};  ///< Sum of w over the batches of a group.
  double weight_squared = 0;                         ///< Sum of w^2 over all batches.
  /// Sum of w x: straight from luminaires; after light was scattered.
  std::vector<double> direct, indirect;
  std::vector<double> direct_cross, indirect_cross;  ///< Sum of w^2 x.
  /// Sum of (w x)^2; total is direct + indirect + caustic.
  std::vector<double> direct_squared, indirect_squared, total_squared;
  /// The same of light from luminaires over mirrors, glass and gloss; size 0 in rooms that bend no light.
  std::vector<double> caustic, caustic_cross, caustic_squared;
  /// Sum of w times the total over the batches of one group: index group * values + value, with
  /// values = zones * channels.count(). These groups of batches are not groups of luminaires. Single
  /// precision, as the file has it: a run that was resumed must not differ from one that was not.
  std::vector<float> group_total;

  bool has_caustics() const { return !caustic.empty(); }
  /// Of all parts, of value i.
  double total(std::size_t i) const {
    const double sum = direct[i] + indirect[i];
    return has_caustics() ? sum + caustic[i] : sum;
  }
  double total_cross(std::size_t i) const {
    const double sum = direct_cross[i] + indirect_cross[i];
    return has_caustics() ? sum + caustic_cross[i] : sum;
  }
  /// The sums with one value per zone and channel; those of caustics only where there are any.
  std::vector<std::vector<double>*> columns();
  std::vector<const std::vector<double>*> columns() const;

  /// No batches, and all sums 0.
  void clear(std::size_t zones, Channels of_zones, bool caustics);
  /// Notes a batch of weight `w`, whose values must be added too; returns its group.
  std::size_t count_batch(std::int64_t w);
  std::int64_t weight() const;  ///< Sum of w over all batches.
  /// Of a standard error, for Student's t: as many as that many batches of equal weight leave.
  double degrees_of_freedom() const;
  /// Squared standard error of a mean, from sum(w x), sum(w^2 x) and sum((w x)^2). Pre: batches >= 2.
  double squared_error(double sum, double cross, double squares) const;
};

/// A mean and its standard error, both in the unit of the quantity.
struct Estimate {
  double mean = 0;
  double stderr_of_mean = 0;
};

/// What packets brought to zones that were gathered since; to go on, a run needs it. The sums of most of them
/// hold gathered light, those of a few, where packets knew better, the same as here.
struct GatheredZones {
  std::vector<ZoneId> zones;
  std::vector<double> sums;        ///< Rows of ZoneSums::columns(): [zone][channel][column].
  std::vector<float> group_total;  ///< [group][zone][channel]
  std::uint64_t rays = 0;          ///< Traced to gather, part of SolveRecord::rays.

  /// Keeps what the sums of these zones are. Where memory runs out, what was kept before stays.
  void keep(const ZoneSums& sums, std::vector<ZoneId> of_zones);
  /// Puts it back.
  void restore(ZoneSums& sums) const;
};

enum class StopReason {
  kUnderWay,  ///< It has not: what stands when a checkpoint is saved.
  kErrorTarget,
  kTimeLimit,
  kPacketCount,
  kInterrupted,
  kNoLuminaire,
  kBatchLimit,
  kBounceLimit,   ///< The noise met the error target, but too much power was unshot when batches ended.
  kSystemSolved,  ///< By the matrix method, which has no stopping rule.
};
std::string to_string(StopReason reason);  ///< In words, as printed and stored.

/// How far a solve got.
struct SolveRecord {
  StopReason stopped = StopReason::kUnderWay;
  std::uint64_t packets = 0;  ///< As SolverSettings::packets counts them.
  std::uint64_t rays = 0;     ///< Traced in all.
  double seconds = 0;         ///< Wall time of the solve without meshing and saving, all sittings together.
  /// sqrt(sum A s^2 / sum A B^2) over zones, worst band: B without what they emit, s its standard error.
  double error = 0;
  double error_bound = 0;            ///< The true rms error stays below this with odds of 99.9 %, worst band.
  double error_95th_percentile = 0;  ///< 95th percentile over zones of s/B, worst band; lit zones only.
  std::uint64_t unreached_zones = 0;  ///< Zones that no packet met.
  std::uint64_t gathered_zones = 0;   ///< Zones too small for packets, found by gathering.
  std::uint64_t unit_packets = 0;     ///< Packets of a batch of weight 1; 0 before there is one.
  bool cut_off = false;               ///< The solution is a first batch that was cut off.
  /// How far radiosity at points lies from that of their zones, relative rms, worst band: an error that more
  /// packets do not lessen. Nothing if it was not estimated.
  std::optional<double> discretisation;
  /// The same for light gathered at points of the room, what stills and vertices show. Nothing if it was not
  /// estimated.
  std::optional<ZoneBias> gather_bias;
};

/// The view-independent solution of a room and all that later questions need.
/// Zone values are irradiances, of three parts: direct, indirect and caustic. Radiosity follows as B = M_e +
/// rho E + tau E', with the zone's material and the irradiance E' of the other side.
struct Solution {
  std::string program_version;
  std::string room_path;                     ///< As given to solve, made absolute.
  std::vector<std::string> more_room_paths;  ///< Further files of a room of several, in order, absolute.
  std::string room_hash;                     ///< content_hash of the room.
  ReadOptions read_options;
  MeshSettings mesh_settings;
  SolverSettings settings;
  SolveRecord record;
  BandSet bands = BandSet::grey();
  std::vector<std::string> surface_names;     ///< By SurfaceId.
  std::vector<MaterialId> surface_materials;  ///< By SurfaceId, into materials.
  /// As in the room; of their non-diffuse parts diffuse transmission alone. Filled by keep_surfaces.
  std::vector<Material> materials;
  /// Of rooms with textures or vertex colours, by zone and band: diffuse reflectance [0,1], and emitted
  /// radiosity [W/m2]; empty in others, where the materials say it.
  std::vector<double> zone_reflectances, zone_exitances;
  MeshReport mesh_report;
  ZoneMesh mesh{BaseMesh{}};
  ZoneSums sums;
  GatheredZones gathered;
  EnergyAudit audit;
  GatherPlan gather_plan;
  std::vector<std::string> light_warnings;  ///< Of light that is lost where it should not be (lost_light.h).
  std::optional<FormFactorReport> form_factors;  ///< Of the matrix method; not kept in the file.

  // Batch means and their standard errors, as ZoneSums has them. One batch alone says nothing about its
  // error: that is then +infinity, never 0. It is 0 without batches (no luminaire) and where no packet of n
  // >= 2 batches came (mean_light counts one more). They are of all light groups; how their errors go
  // together the sums do not tell: they are added, the most there is.
  Estimate direct_irradiance(ZoneId z, std::size_t band) const;    ///< [W/m2]
  Estimate indirect_irradiance(ZoneId z, std::size_t band) const;  ///< [W/m2]
  /// From luminaires over mirrors, glass and gloss [W/m2]; exactly 0 in rooms that bend no light.
  Estimate caustic_irradiance(ZoneId z, std::size_t band) const;
  Estimate irradiance(ZoneId z, std::size_t band) const;  ///< [W/m2]

  const Material& zone_material(ZoneId z) const {
    return materials[surface_materials[mesh.zone_surface(z).index()].index()];
  }
  /// Diffuse [0,1]; of textures the mean over the zone.
  double zone_reflectance(ZoneId z, std::size_t band) const {
    if (!zone_reflectances.empty()) return zone_reflectances[z.index() * bands.count() + band];
    return zone_material(z).reflectance_of(mesh.zone_shows_front(z))[static_cast<Eigen::Index>(band)];
  }
  double emitted_radiosity(ZoneId z,
                           std::size_t band) const;  ///< M_e = pi L_e of the side the zone is on [W/m2].
  using Irradiance = Estimate (Solution::*)(ZoneId, std::size_t) const;
  /// What comes through a zone in all directions of some irradiance of the zones behind, such as
  /// direct_irradiance: tau E' [W/m2]. The errors of these zones count as independent.
  Estimate transmitted(ZoneId z, std::size_t band, Irradiance of) const;
  /// That and what the zone reflects of its own: rho E + tau E' [W/m2].
  Estimate scattered(ZoneId z, std::size_t band, Irradiance of) const;
  Estimate radiosity(ZoneId z, std::size_t band) const;  ///< B = M_e + rho E + tau E' [W/m2].

 private:
  /// Mean and error of what `part` (sum, cross, squares of value i) tells of a zone, over all light groups.
  template <class Part>
  Estimate over_groups(ZoneId z, std::size_t band, const Part& part) const;
};

/// The files of its room, one or more, in order.
std::vector<std::string> room_files(const Solution& solution);

/// Copies into a solution what it keeps of the room's surfaces: their names and materials.
void keep_surfaces(const Scene& scene, Solution& solution);

}  // namespace reemit
