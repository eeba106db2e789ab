#pragma once
#include <array>
#include <filesystem>

#include "bench/many_luminaires/figures.h"
#include "solver/emit/selection.h"

namespace reemit::bench {

struct RunSettings {
  int threads = 2;  ///< Of references and stills; times per sample are those of one thread.
  int seeds = 3;
  bool quick = false;            ///< Fewer points, samples and levels: to see that all works.
  std::filesystem::path folder;  ///< Pictures go to folder/images.
};

inline constexpr std::array kSelections{Selection::kConstant, Selection::kLinear, Selection::kSpatial};

/// The sphereflake, all of it luminous or one sphere of it: time per sample, error at equal time.
void measure_sphereflake(const RunSettings& settings, Figures& figures);
/// Stills of the hundred panels: error over time, and the pictures side by side.
void measure_panels(const RunSettings& settings, Figures& figures);
/// Time per sample and time to build over the number of luminaires.
void measure_growth(const RunSettings& settings, Figures& figures);

inline constexpr const char* kOneLamp = "one lamp";
inline constexpr const char* kPicture = "many_luminaires_panels.png";
/// Samples per pixel of the stills shown.
inline constexpr std::size_t kShownSamples = 49;

}  // namespace reemit::bench
