#pragma once
#include <cstdint>

#include <fmt/format.h>

#include "solver/solution/solution.h"

// The scalar fields of a solution file, each named once for both directions. `archive` is a writer that takes
// values or a reader that fills them; attribute(name, value) accepts numbers, bool, text and the enumerations
// below. Names end in the unit where there is one.

namespace reemit {

/// Attribute that holds the path of a further file of the room, from 0.
inline std::string room_path_attribute(std::size_t further) {
  return fmt::format("room_path_{}", further + 2);
}

template <class Archive, class Options>
void transfer_read_options(Archive& archive, Options& options) {
  archive.attribute("gltf_emissive_units", options.gltf_emissive_units);
  archive.attribute("gltf_light_efficacy_lm_per_W", options.gltf_light_efficacy);
  archive.attribute("force_two_sided", options.force_two_sided);
  archive.attribute("sky", options.sky);
  archive.attribute("sun", options.sun);
  archive.attribute("bands_first_nm", options.bands.first_nm);
  archive.attribute("bands_last_nm", options.bands.last_nm);
  archive.attribute("bands_step_nm", options.bands.step_nm);
}

template <class Archive, class Settings>
void transfer_mesh_settings(Archive& archive, Settings& settings) {
  archive.attribute("zone_area_m2", settings.zone_area);
  archive.attribute("default_zone_count", settings.default_zone_count);
  archive.attribute("smallest_angle_deg", settings.smallest_angle_deg);
  archive.attribute("crease_angle_deg", settings.crease_angle_deg);
  archive.attribute("exact_shapes", settings.exact_shapes);
  archive.attribute("share_zones", settings.share_zones);
}

template <class Archive, class Settings>
void transfer_solver_settings(Archive& archive, Settings& settings) {
  archive.attribute("method", settings.method);
  archive.attribute("sampling", settings.sampling);
  archive.attribute("reemission", settings.reemission);
  archive.attribute("direct", settings.direct);
  archive.attribute("error_target", settings.error_target);
  archive.attribute("time_limit_s", settings.time_limit_s);
  archive.attribute("packets", settings.packets);
  archive.attribute("batch_packets", settings.batch_packets);
  archive.attribute("smallest_batch_count", settings.smallest_batch_count);
  archive.attribute("stop_share", settings.stop_share);
  archive.attribute("gather_small_zones", settings.gather_small_zones);
  archive.attribute("seed", settings.seed);
  archive.attribute("threads", settings.threads);
}

template <class Archive, class Record>
void transfer_record(Archive& archive, Record& record) {
  archive.attribute("stopped", record.stopped);
  archive.attribute("packets", record.packets);
  archive.attribute("rays", record.rays);
  archive.attribute("seconds", record.seconds);
  archive.attribute("error", record.error);
  archive.attribute("error_bound", record.error_bound);
  archive.attribute("error_95th_percentile", record.error_95th_percentile);
  archive.attribute("unreached_zones", record.unreached_zones);
  archive.attribute("gathered_zones", record.gathered_zones);
  archive.attribute("unit_packets", record.unit_packets);
  archive.attribute("cut_off", record.cut_off);
  archive.attribute("discretisation", record.discretisation);
  archive.attribute("gather_bias", record.gather_bias);
}

template <class Archive, class Report>
void transfer_mesh_counts(Archive& archive, Report& report) {
  archive.attribute("degenerate_faces", report.degenerate_faces);
  archive.attribute("duplicate_faces", report.duplicate_faces);
  archive.attribute("overlapping_faces", report.overlapping_faces);
  archive.attribute("flipped_faces", report.flipped_faces);
  archive.attribute("nonplanar_faces", report.nonplanar_faces);
  archive.attribute("cut_faces", report.cut_faces);
  archive.attribute("back_to_back_faces", report.back_to_back_faces);
}

/// The values an enumeration can have, in words, as stored.
inline std::string to_string(EmissiveUnits units) {
  return units == EmissiveUnits::kWatt      ? "W/(sr m2)"
         : units == EmissiveUnits::kCandela ? "cd/m2"
                                            : "by generator";
}
inline std::string to_string(BandKind kind) {
  return kind == BandKind::kGrey ? "grey" : kind == BandKind::kRgb ? "rgb" : "spectral";
}

inline constexpr EmissiveUnits kAllEmissiveUnits[] = {EmissiveUnits::kByGenerator, EmissiveUnits::kCandela,
                                                      EmissiveUnits::kWatt};
inline constexpr BandKind kAllBandKinds[] = {BandKind::kGrey, BandKind::kRgb, BandKind::kSpectral};
inline constexpr SolveMethod kAllSolveMethods[] = {SolveMethod::kShooting, SolveMethod::kWalk,
                                                   SolveMethod::kMatrix};
inline constexpr SamplingKind kAllSamplingKinds[] = {SamplingKind::kRandom, SamplingKind::kSobol};
inline constexpr Reemission kAllReemissions[] = {Reemission::kFromHits, Reemission::kFromZones};
inline constexpr DirectSource kAllDirectSources[] = {DirectSource::kBest, DirectSource::kPackets};
inline constexpr StopReason kAllStopReasons[] = {
    StopReason::kUnderWay,    StopReason::kErrorTarget, StopReason::kTimeLimit,
    StopReason::kPacketCount, StopReason::kBatchLimit,  StopReason::kBounceLimit,
    StopReason::kInterrupted, StopReason::kNoLuminaire, StopReason::kSystemSolved};

}  // namespace reemit
