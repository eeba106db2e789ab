#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "scenes/io/mgf/mgf_interpreter.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

/// Places a luminaire whose nadir is -z and whose C = 0 is +x. The transforms of MGF are similarities: their
/// scale applies to the opening, as to all sizes, but not to the intensities.
PhotometricLight placed(const MeasuredLuminaire& luminaire, const Eigen::Affine3d& transform,
                        const std::string& where) {
  PhotometricLight light;
  const double scale = std::cbrt(std::fabs(transform.linear().determinant()));
  if (!(scale > 0) || !std::isfinite(scale))
    throw InputError(where, "the luminaire is scaled by 0 or beyond all numbers", "Check the -s around it.");
  light.orientation = transform.linear() / scale;
  light.position = transform.translation();
  light.opening = luminaire.opening;
  light.opening.length *= scale;
  light.opening.width *= scale;
  light.opening.height *= scale;
  light.table = luminaire.table;
  const Vec3 reach = Vec3::Constant(light.opening.size().maxCoeff());
  for (const Vec3& end : {Vec3(light.position - reach), Vec3(light.position + reach)}) {
    const std::string problem = place_problem(end);
    if (!problem.empty()) throw InputError(where, problem, kLengthAdvice);
  }
  return light;
}

}  // namespace

void MgfInterpreter::run_ies(const File& file, const TextLine& line, const std::string& where) {
  if (line.words.size() < 2)
    throw InputError(where, "'ies' names no file", "Write 'ies file [-m factor] [transform]'.");
  const bool has_factor = line.words.size() > 2 && line.words[2] == "-m";
  if (has_factor && line.words.size() < 4) throw InputError(where, "'-m' lacks a number", "Give the factor.");
  const double factor = has_factor ? mgf_number(line, 3, where) : 1;
  if (!(factor > 0))
    throw InputError(where, fmt::format("the factor {} leaves the luminaire no light", factor),
                     "Remove the luminaire or give it power.");
  const std::size_t first = std::min<std::size_t>(has_factor ? 4 : 2, line.words.size());
  const MgfTransform transform(std::span(line.words).subspan(first), where);
  const MeasuredLuminaire* luminaire = nullptr;
  try {
    luminaire =
        &luminaires_.load(mgf_mentioned_file(file.folder, line.words[1], where), builder_.warnings, notes_);
  } catch (const InputError& error) {
    throw InputError(where, std::string("the luminaire cannot be read: ") + error.what(), "");
  }
  const auto count = static_cast<std::size_t>(transform.instance_count());
  if (lights_.size() + count > kMostLuminaires)
    throw InputError(where, fmt::format("the room has more than {} luminaires", kMostLuminaires),
                     "Check the counts of the arrays (-a) here and around it.");
  // One candela in equal parts of power.
  const BandSet bands = BandSet::rgb();
  const Spectrum per_candela =
      Spectrum::Constant(static_cast<Eigen::Index>(bands.count()), factor / bands.efficacy_lm_per_w().sum());
  const std::string problem =
      strength_problem(per_candela * luminaire->table->greatest_intensity(), "the greatest intensity [W/sr]");
  if (!problem.empty()) throw InputError(where, problem, kStrengthAdvice);
  const std::string& base = object_path_.empty() ? luminaire->name : object_path_;
  for (std::size_t i = 0; i < count; ++i) {
    PhotometricLight light =
        placed(*luminaire, transform_ * transform.instance(static_cast<std::int64_t>(i)), where);
    light.name = count > 1 ? fmt::format("{} {}", base, i + 1) : base;
    light.intensity_per_candela = per_candela;
    lights_.emplace_back(std::move(light));
  }
}

void MgfInterpreter::finish(Scene& scene) {
  builder_.finish(scene);
  scene.lights.insert(scene.lights.end(), std::make_move_iterator(lights_.begin()),
                      std::make_move_iterator(lights_.end()));
  lights_.clear();
  scene.notes.insert(scene.notes.end(), notes_.begin(), notes_.end());
}

}  // namespace reemit
