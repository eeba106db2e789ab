#include "scenes/io/native/named_metals.h"

#include <algorithm>
#include <map>

namespace reemit {
namespace {

struct Sample {
  double nm, eta, k;
};

const std::map<std::string, std::vector<Sample>>& samples() {
  static const std::map<std::string, std::vector<Sample>> all{{"aluminium",
                                                               {{413.3, 0.548, 5.00},
                                                                {495.9, 0.771, 5.91},
                                                                {619.9, 1.292, 7.28},
                                                                {688.8, 1.731, 7.96},
                                                                {729.3, 2.082, 8.34}}},
                                                              {"copper",
                                                               {{413.3, 1.184, 2.21},
                                                                {442.8, 1.169, 2.36},
                                                                {476.9, 1.152, 2.50},
                                                                {516.6, 1.121, 2.60},
                                                                {539.1, 1.037, 2.59},
                                                                {563.6, 0.826, 2.60},
                                                                {590.4, 0.468, 2.81},
                                                                {619.9, 0.272, 3.24},
                                                                {652.5, 0.214, 3.67},
                                                                {670.2, 0.215, 3.86}}},
                                                              {"gold",
                                                               {{393.6, 1.960, 1.89},
                                                                {413.2, 1.950, 1.86},
                                                                {442.8, 1.826, 1.81},
                                                                {476.8, 1.541, 1.71},
                                                                {516.6, 0.878, 2.01},
                                                                {563.5, 0.613, 2.64},
                                                                {619.9, 0.487, 3.31},
                                                                {826.5, 0.418, 5.13}}},
                                                              {"silver",
                                                               {{381.5, 0.229, 1.86},
                                                                {413.3, 0.226, 2.28},
                                                                {495.9, 0.237, 3.09},
                                                                {619.9, 0.269, 4.18},
                                                                {826.6, 0.271, 5.80}}}};
  return all;
}

Sample at(const std::vector<Sample>& samples, double nm) {
  const auto after = std::upper_bound(samples.begin(), samples.end(), nm,
                                      [](double x, const Sample& s) { return x < s.nm; });
  if (after == samples.begin()) return samples.front();
  if (after == samples.end()) return samples.back();
  const Sample& below = *(after - 1);
  const double t = (nm - below.nm) / (after->nm - below.nm);
  return {nm, below.eta + t * (after->eta - below.eta), below.k + t * (after->k - below.k)};
}

std::vector<double> wavelengths(const BandSet& bands) {
  switch (bands.kind()) {
    case BandKind::kGrey:
      return {555};
    case BandKind::kRgb:
      return {611, 549, 464};
    case BandKind::kSpectral:
      break;
  }
  return bands.centres_nm();
}

}  // namespace

std::vector<std::string> metal_names() {
  std::vector<std::string> names;
  for (const auto& [name, unused] : samples()) names.push_back(name);
  return names;
}

OpticalConstants metal_constants(const std::string& name, const BandSet& bands) {
  const auto count = static_cast<Eigen::Index>(bands.count());
  OpticalConstants constants{Spectrum(count), Spectrum(count)};
  const std::vector<double> nm = wavelengths(bands);
  for (std::size_t b = 0; b < nm.size(); ++b) {
    const Sample s = at(samples().at(name), nm[b]);
    constants.eta[static_cast<Eigen::Index>(b)] = s.eta;
    constants.k[static_cast<Eigen::Index>(b)] = s.k;
  }
  return constants;
}

}  // namespace reemit
