#include "viewer_export/still/still_settings.h"

#include <cmath>

#include "scenes/model/error.h"

namespace reemit {

std::string to_string(Integrator integrator) {
  switch (integrator) {
    case Integrator::kGather:
      return "gather";
    case Integrator::kPath:
      return "path";
    case Integrator::kZones:
      return "zones";
  }
  return "";
}

std::pair<int, int> picture_size(const StillSettings& settings, const Camera& camera) {
  return {settings.width != 0 ? settings.width : camera.width,
          settings.height != 0 ? settings.height : camera.height};
}

void check(const StillSettings& s) {
  const auto require = [](bool good, const char* name, const char* range) {
    if (!good)
      throw InputError("still", std::string(name) + " is out of range", std::string("Choose ") + range);
  };
  require(s.spp >= 1 && s.spp <= 1 << 20, "samples per pixel", "1 to 1048576.");
  require(s.most_spp >= 1 && s.most_spp <= 1 << 20, "largest number of samples per pixel", "1 to 1048576.");
  require(s.gathers >= 1 && s.gathers <= 1024, "gather rays per sample", "1 to 1024.");
  require(s.light_samples >= 1 && s.light_samples <= 1024, "light samples", "1 to 1024.");
  require(s.error_target >= 0 && s.error_target < 1, "error", "a share below 1, such as 2%.");
  require(s.error_floor >= 0 && s.error_floor <= 1, "error floor", "a share of at most 1, such as 1%.");
  require(s.most_mean_spp >= 0 && std::isfinite(s.most_mean_spp), "mean number of samples per pixel",
          "0 for no limit, or more.");
  require(s.close_hit >= 0 && std::isfinite(s.close_hit), "close-hit distance", "0 or more zone sizes.");
  require(s.threads >= 0, "number of threads", "0 (all cores) or more.");
}

}  // namespace reemit
