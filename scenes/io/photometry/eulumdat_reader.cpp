#include "scenes/io/photometry/eulumdat_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/io/photometry/eulumdat_text.h"
#include "scenes/io/photometry/ies_angles.h"

namespace reemit {
namespace {

constexpr std::size_t kMostStored = 1'000'000;
constexpr int kMostLampSets = 1000;
constexpr double kMetresPerMillimetre = 1e-3;

/// Reads one file; the numbers of lines are those of the format.
class EulumdatFile {
 public:
  explicit EulumdatFile(const std::filesystem::path& file) : path_(file), text_(file) {}

  MeasuredLuminaire read() {
    read_symmetry();
    read_names();
    read_opening();
    read_factors();
    read_lamp_sets();
    text_.numbers(kRoomIndices, "direct ratios");
    read_grid();
    finish();
    return std::move(result_);
  }

 private:
  static constexpr std::size_t kRoomIndices = 10;

  /// 1 to 7: company, type, symmetry, counts and distances of planes and angles.
  void read_symmetry() {
    text_.text("the company");
    text_.text("the type indicator");  // what it says of the luminaire is in the symmetry and the sizes
    symmetry_ = text_.integer("the symmetry indicator", 0, 4);
    planes_ = static_cast<std::size_t>(text_.integer("the number of C planes", 1, kMostAngles));
    text_.number_or("the distance of the C planes", 0);  // the angles themselves follow
    angles_ = static_cast<std::size_t>(text_.integer("the number of angles in a plane", 2, kMostAngles));
    text_.number_or("the distance of the angles", 0);
    if (stored_planes() * angles_ > kMostStored)
      text_.fail(fmt::format("{} x {} intensities", stored_planes(), angles_),
                 fmt::format("Tables of up to {} are read.", kMostStored));
    const std::size_t divisor = symmetry_ < 2 ? 1 : (symmetry_ == 2 ? 2 : 4);
    if (planes_ % divisor != 0)
      text_.fail(fmt::format("{} C planes cannot have the symmetry {}", planes_, symmetry_),
                 fmt::format("Their number must be divisible by {}.", divisor));
  }

  /// 8 to 12: report, name, number, file, date.
  void read_names() {
    text_.text("the number of the report");
    const std::string name = text_.text("the name of the luminaire");
    const std::string number = text_.text("the number of the luminaire");
    text_.text("the file name");
    text_.text("the date");
    result_.name = !name.empty() ? name : (!number.empty() ? number : path_.stem().string());
  }

  /// 13 to 21: sizes of the housing, then of the luminous area [mm].
  void read_opening() {
    for (const char* what : {"the length of the luminaire", "its width", "its height"})
      text_.number_or(what, 0);
    const double length = text_.size("the length of the luminous area");
    const double width = text_.size("the width of the luminous area");
    std::array<double, 4> heights{};
    for (double& height : heights) height = text_.size("the height of the luminous area");
    const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
    if (*least != *most)
      result_.notes.push_back(fmt::format(
          "{}: the luminous area is {} to {} mm high on its four sides; the mean is taken for all.",
          text_.where(), *least, *most));
    LuminousOpening& o = result_.opening;
    o.height = (heights[0] + heights[1] + heights[2] + heights[3]) / 4 * kMetresPerMillimetre;
    o.width = length * kMetresPerMillimetre;  // along C = 90
    o.length = (length > 0 && width == 0 ? length : width) * kMetresPerMillimetre;
    if (length > 0 && width == 0)
      o.shape = LuminousOpening::Shape::kCylinder;  // of width 0 it is round
    else if (length > 0 || width > 0 || o.height > 0)
      o.shape = LuminousOpening::Shape::kBox;
  }

  /// 22 to 25: downward flux fraction, light output ratio [%], conversion factor, tilt [degree].
  void read_factors() {
    downward_ = text_.number_or("the downward flux fraction", 0) / 100;
    output_ratio_ = text_.number_or("the light output ratio", 0) / 100;
    factor_ = text_.number_or("the conversion factor", 1);
    if (!(factor_ > 0)) {
      result_.warnings.push_back(
          fmt::format("{}: the conversion factor is {}; 1 is taken.", text_.where(), factor_));
      factor_ = 1;
    }
    const double tilt = text_.number_or("the tilt during the measurement", 0);
    if (tilt != 0)
      result_.warnings.push_back(fmt::format(
          "{}: the luminaire was measured at a tilt of {} degrees, which is not applied: aim it in the room.",
          text_.where(), tilt));
  }

  /// 26: the flux that the intensities, in cd per 1000 lm, refer to.
  void read_lamp_sets() {
    const int sets = text_.integer("the number of lamp sets", 0, kMostLampSets);
    std::string others;
    for (int i = 0; i < sets; ++i) {
      const double lamps = text_.number_or("the number of lamps", 1);
      text_.text("the type of the lamps");
      const double flux = text_.number_or("the flux of the lamps", 0);
      text_.text("the colour of the lamps");
      text_.text("the colour rendering of the lamps");
      text_.text("the power of the lamps");
      if (i == 0) {
        flux_ = flux;
        absolute_ = lamps < 0;
      } else {
        others += fmt::format("{}{:g} lm", i > 1 ? ", " : "", flux);
      }
    }
    if (!(flux_ > 0)) {
      result_.warnings.push_back(fmt::format(
          "{}: no flux of the lamps is given; 1000 lm is taken. Give the light its \"flux_lm\" or a scale.",
          text_.where()));
      flux_ = kLumensOfIntensities;
      stated_ = false;
    } else if (!others.empty()) {
      result_.warnings.push_back(fmt::format(
          "{}: of the lamp sets the first is taken, {:g} lm; others, for which the light can be scaled: {}.",
          text_.where(), flux_, others));
    }
  }

  std::size_t stored_planes() const {
    switch (symmetry_) {
      case 0:
        return planes_;
      case 1:
        return 1;
      case 4:
        return planes_ / 4 + 1;
      default:
        return planes_ / 2 + 1;
    }
  }

  void read_grid() {
    const std::vector<double> all = text_.numbers(planes_, "C angles");
    grid_.vertical = text_.numbers(angles_, "angles in a plane");
    expect_increase(all, "C angles");
    expect_increase(grid_.vertical, "angles in a plane");
    const IesComplaint vertical = check_vertical_angles(grid_);
    if (!vertical.problem.empty()) text_.fail(vertical.problem, vertical.advice);
    const std::size_t count = stored_planes();
    std::vector<double> values = text_.numbers(count * angles_, "intensities");
    clear_noise(values, text_.where(), result_.warnings);
    for (std::size_t i = 0; i < count; ++i) {
      // Symmetric to plane 90 - 270, the half from 270 over 0 to 90 is stored: its mirror image backwards.
      const std::size_t plane = symmetry_ == 3 ? count - 1 - i : i;
      const double angle =
          symmetry_ == 1 ? 0 : all[(plane + (symmetry_ == 3 ? 3 * planes_ / 4 : 0)) % planes_];
      grid_.horizontal.push_back(symmetry_ == 3 ? (angle > 180 ? 540 - angle : 180 - angle) : angle);
      for (std::size_t k = 0; k < angles_; ++k) add_intensity(values[plane * angles_ + k]);
    }
    if (symmetry_ == 0 && planes_ > 1 && grid_.horizontal.back() < 360) {
      grid_.horizontal.push_back(360);
      for (std::size_t k = 0; k < angles_; ++k) grid_.candela.push_back(grid_.candela[k]);
    }
    const IesComplaint horizontal = check_horizontal_angles(grid_);
    if (!horizontal.problem.empty() || (symmetry_ > 0 && !spans_symmetry()))
      text_.fail(fmt::format("the C angles of the stored planes do not fit the symmetry {}", symmetry_),
                 "They run from 0 to below or up to 360 (symmetry 0), 0 to 180 (2), 270 to 90 (3) or 0 to 90 "
                 "(4) in the "
                 "list of C angles.");
  }

  void expect_increase(const std::vector<double>& angles, const char* what) const {
    for (std::size_t i = 1; i < angles.size(); ++i)
      if (!(angles[i] > angles[i - 1]))
        text_.fail(fmt::format("the {} do not increase: {} after {}", what, angles[i], angles[i - 1]),
                   "Sort them and name each once; check the counts of planes and angles.");
  }

  bool spans_symmetry() const {
    constexpr std::array<std::array<double, 2>, 5> kSpan = {{{0, 360}, {0, 0}, {0, 180}, {90, 270}, {0, 90}}};
    constexpr double kSlack = 1e-6;
    const auto& [first, last] = kSpan[static_cast<std::size_t>(symmetry_)];
    return std::fabs(grid_.horizontal.front() - first) < kSlack &&
           std::fabs(grid_.horizontal.back() - last) < kSlack;
  }

  void add_intensity(double per_thousand_lumens) {
    if (per_thousand_lumens < 0)
      text_.fail(fmt::format("the intensity {} cd is negative", per_thousand_lumens),
                 "Intensities are 0 or more.");
    const double candela = per_thousand_lumens * factor_ * flux_ / kLumensOfIntensities;
    if (!std::isfinite(candela))
      text_.fail("an intensity is too large for a number", "Check the conversion factor and the flux.");
    grid_.candela.push_back(candela);
  }

  void finish() {
    const std::string rest = text_.rest_as_text();
    if (!rest.empty()) result_.warnings.push_back(rest + ".");
    const std::string file = path_.lexically_normal().string();
    result_.table = table_of(grid_, text_.where(), file, result_.warnings);
    if (stated_ && !absolute_) result_.lamp_lumens = flux_;
    check_flux(file);
  }

  /// What the file says of its flux against what its intensities amount to.
  void check_flux(const std::string& file) {
    constexpr double kSlack = 0.05;
    const double flux = result_.table->total_flux();
    const double ratio = flux / flux_;
    if (output_ratio_ > 0 && std::fabs(ratio / output_ratio_ - 1) > kSlack)
      result_.warnings.push_back(
          fmt::format("{}: the intensities amount to {:.1f} % of the lamps' flux, the file says {:.1f} %; "
                      "the intensities "
                      "count.",
                      file, 100 * ratio, 100 * output_ratio_));
    const auto horizon = std::find_if(grid_.vertical.begin(), grid_.vertical.end(),
                                      [](double angle) { return std::fabs(angle - 90) < 1e-6; });
    if (horizon == grid_.vertical.end() || !(downward_ > 0)) return;
    const double down =
        result_.table->flux_below(static_cast<std::size_t>(horizon - grid_.vertical.begin())) / flux;
    if (std::fabs(down - downward_) > kSlack)
      result_.warnings.push_back(fmt::format(
          "{}: {:.1f} % of the light goes downwards, the file says {:.1f} %; the intensities count.", file,
          100 * down, 100 * downward_));
  }

  static constexpr double kLumensOfIntensities = 1000;

  std::filesystem::path path_;
  EulumdatText text_;
  MeasuredLuminaire result_;
  IesGrid grid_;
  int symmetry_ = 0;
  std::size_t planes_ = 0, angles_ = 0;
  double downward_ = 0, output_ratio_ = 0, factor_ = 1;
  double flux_ = 0;     // of the lamps [lm]
  bool stated_ = true;  // the flux stands in the file
  bool absolute_ = false;
};

}  // namespace

MeasuredLuminaire read_eulumdat_file(const std::filesystem::path& file) {
  return EulumdatFile(file).read();
}

}  // namespace reemit
