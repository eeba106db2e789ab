#include "bench/convergence/reference.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace reemit::bench {
namespace {

constexpr double kMedianOfNormal = 0.67448975;

double median_of(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Rms and median of deviations given by index, worst band.
template <class Deviation>
ErrorPair measure(const Reference& reference, const ErrorNorm& norm, Deviation&& deviation_of) {
  ErrorPair worst;
  const std::size_t bands = reference.bands;
  const std::size_t items = reference.value.size() / bands;
  for (std::size_t b = 0; b < bands; ++b) {
    double mean = 0;
    for (std::size_t i = 0; i < items; ++i)
      mean += static_cast<double>(reference.value[i * bands + b]) / static_cast<double>(items);
    const double floor = norm.floor_share * mean;
    double squares = 0;
    double scale = 0;
    std::vector<double> relative;
    relative.reserve(items);
    for (std::size_t i = 0; i < items; ++i) {
      const std::size_t k = i * bands + b;
      const double truth = reference.value[k];
      const double d = deviation_of(k);
      if (!norm.weight.empty()) {
        squares += norm.weight[i] * d * d;
        scale += norm.weight[i] * truth * truth;
      } else if (truth + floor > 0) {
        squares += d * d / ((truth + floor) * (truth + floor));
        scale += 1;
      }
      if (truth > 0) relative.push_back(std::abs(d) / truth);
    }
    if (scale > 0) worst.rms = std::max(worst.rms, std::sqrt(squares / scale));
    worst.median = std::max(worst.median, median_of(relative));
  }
  return worst;
}

std::optional<Reference> load(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string magic;
  std::size_t bands = 0;
  std::size_t count = 0;
  if (!(in >> magic >> bands >> count) || magic != "reemit-reference" || bands == 0) return std::nullopt;
  in.get();
  // The length decides, not what a damaged header says.
  const std::uintmax_t bytes = 2 * count * sizeof(float);
  const auto start = static_cast<std::uintmax_t>(in.tellg());
  if (std::filesystem::file_size(file) != start + bytes) return std::nullopt;
  Reference reference{bands, std::vector<float>(count), std::vector<float>(count)};
  for (std::vector<float>* values : {&reference.value, &reference.stderr_of_value})
    in.read(reinterpret_cast<char*>(values->data()), static_cast<std::streamsize>(count * sizeof(float)));
  return in ? std::optional(std::move(reference)) : std::nullopt;
}

void save(const Reference& reference, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  out << "reemit-reference " << reference.bands << ' ' << reference.value.size() << '\n';
  for (const std::vector<float>* values : {&reference.value, &reference.stderr_of_value})
    out.write(reinterpret_cast<const char*>(values->data()),
              static_cast<std::streamsize>(values->size() * sizeof(float)));
  if (!out.flush()) throw std::runtime_error(fmt::format("{} cannot be written", file.string()));
}

}  // namespace

ErrorPair deviation(const std::vector<float>& values, const Reference& reference, const ErrorNorm& norm) {
  if (values.size() != reference.value.size())
    throw std::invalid_argument("values and reference differ in number");
  return measure(reference, norm, [&](std::size_t k) {
    return static_cast<double>(values[k]) - static_cast<double>(reference.value[k]);
  });
}

ErrorPair own_error(const Reference& reference, const ErrorNorm& norm) {
  ErrorPair error = measure(reference, norm, [&](std::size_t k) { return reference.stderr_of_value[k]; });
  error.median *= kMedianOfNormal;
  return error;
}

ReferenceCache::ReferenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (!folder_.empty()) std::filesystem::create_directories(folder_);
}

Reference ReferenceCache::get(const std::string& name, const std::function<Reference()>& make) const {
  if (folder_.empty()) return make();
  const std::filesystem::path file = folder_ / (name + ".ref");
  if (std::optional<Reference> kept = load(file)) return *std::move(kept);
  Reference reference = make();
  save(reference, file);
  return reference;
}

}  // namespace reemit::bench
