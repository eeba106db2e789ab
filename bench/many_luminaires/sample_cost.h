#pragma once
#include <cstddef>
#include <vector>

#include "solver/gather/direct_light.h"
#include "solver/trace/surface_point.h"

namespace reemit::bench {

/// Something to be timed: some samples at each of some points.
struct Candidate {
  const DirectLight* light = nullptr;
  const std::vector<SurfacePoint>* points = nullptr;
  int samples = 1;  ///< At each point.
};

/// Time of one DirectLight::add_sample [ns], by candidate and round. All candidates take turns in every
/// round, so that a drift of the machine hits them alike. The processor time of this one thread is counted;
/// random numbers are drawn beforehand.
std::vector<std::vector<double>> sample_times_ns(const std::vector<Candidate>& candidates, int rounds);

/// Quotients round by round.
std::vector<double> ratios(const std::vector<double>& upper, const std::vector<double>& lower);

}  // namespace reemit::bench
