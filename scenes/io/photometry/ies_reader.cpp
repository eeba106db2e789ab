#include "scenes/io/photometry/ies_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "scenes/io/common/text_parse.h"
#include "scenes/io/photometry/ies_angles.h"
#include "scenes/io/photometry/ies_opening.h"
#include "scenes/io/photometry/ies_text.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

constexpr std::size_t kMostUnfolded = 4'000'000;  // with the symmetry unfolded: 32 MB
constexpr int kMostTiltAngles = 1000;
constexpr double kMetresPerFoot = 0.3048;

std::string upper_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

/// Edition of the standard by its line, as in IESNA:LM-63-2002, IESNA91, IES:LM-63-2019; nothing if it is no
/// such line, as in files of 1986.
std::optional<int> edition_of(std::string_view line) {
  std::string header = upper_case(line);
  if (!header.starts_with("IES")) return std::nullopt;
  header.resize(std::min(header.find_first_of(" \t("), header.size()));
  for (const int year : {1986, 1991, 1995, 2002, 2019}) {
    const std::string digits = fmt::format("{:02}", year % 100);
    if (header.ends_with(std::to_string(year)) || header.ends_with("-" + digits) ||
        header.ends_with("IESNA" + digits))
      return year;
  }
  return 2002;
}

/// The value of TILT= if that is what the line says.
std::optional<std::string> tilt_of(std::string_view line) {
  if (!upper_case(line.substr(0, 4)).starts_with("TILT")) return std::nullopt;
  std::size_t at = line.find_first_not_of(" \t", 4);
  if (at == std::string_view::npos || line[at] != '=') return std::nullopt;
  at = line.find_first_not_of(" \t", at + 1);
  return at == std::string_view::npos ? std::string() : std::string(line.substr(at));
}

/// Reads one file.
class IesFile {
 public:
  explicit IesFile(const std::filesystem::path& file) : path_(file), text_(file) {}

  MeasuredLuminaire read() {
    read_labels();
    read_tilt();
    read_lamps();
    read_grid();
    warn_of_rest(text_);
    finish();
    return std::move(result_);
  }

 private:
  /// The lines up to TILT=.
  void read_labels() {
    std::string_view line;
    std::string label;
    std::string luminaire;
    std::string catalogue;
    bool is_edition_due = true;
    while (text_.next_line(line)) {
      if (const auto tilt = tilt_of(line)) {
        tilt_ = *tilt;
        result_.name = !luminaire.empty() ? luminaire : (!catalogue.empty() ? catalogue : label);
        if (result_.name.empty()) result_.name = path_.stem().string();
        return;
      }
      if (line.empty()) continue;
      // It is the first line, but for remarks that somebody put above it.
      if (const auto edition = is_edition_due ? edition_of(line) : std::nullopt) {
        is_edition_due = false;
        edition_ = *edition;
        continue;
      }
      is_edition_due = is_edition_due && !line.starts_with('[');
      const std::size_t end = line.starts_with('[') ? line.find(']') : std::string_view::npos;
      if (end == std::string_view::npos) {
        if (label.empty()) label = line;
        continue;
      }
      const std::size_t value = line.find_first_not_of(" \t", end + 1);
      if (value == std::string_view::npos) continue;
      const std::string keyword = upper_case(line.substr(1, end - 1));
      if (keyword == "LUMINAIRE" && luminaire.empty()) luminaire = line.substr(value);
      if (keyword == "LUMCAT" && catalogue.empty()) catalogue = line.substr(value);
    }
    text_.fail("this is not an IES photometric file: no line begins with TILT=",
               "Give a file in the IES LM-63 format; EULUMDAT files end in .ldt.");
  }

  void read_tilt() {
    const std::string choice = upper_case(tilt_);
    if (choice == "NONE") return;
    if (choice.empty())
      text_.fail("TILT= says nothing", "Write TILT=NONE, TILT=INCLUDE or the name of a file.");
    if (choice == "INCLUDE") {
      read_tilt_data(text_);
      return;
    }
    const std::filesystem::path file = path_.parent_path() / tilt_;
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
      text_.fail(
          fmt::format("TILT={} is neither NONE nor INCLUDE, and there is no file {}", tilt_, file.string()),
          "Put the file beside this one, or write TILT=NONE if the output does not depend on tilt.");
    IesText data(file);
    read_tilt_data(data);
    warn_of_rest(data);
  }

  void warn_of_rest(IesText& text) {
    const std::string rest = text.rest_as_text();
    if (!rest.empty()) result_.warnings.push_back(rest + ".");
  }

  /// A room does not say which way is up, so only the factor of the upright luminaire can be applied.
  void read_tilt_data(IesText& data) {
    data.integer("the lamp-to-luminaire geometry", 1, 3);
    const auto count =
        static_cast<std::size_t>(data.integer("the number of tilt angles", 1, kMostTiltAngles));
    const std::vector<double> angles = data.numbers(count, "tilt angles");
    for (std::size_t i = 1; i < count; ++i)
      if (!(angles[i] > angles[i - 1])) data.fail("the tilt angles do not increase", "Sort them.");
    const std::vector<double> factors = data.numbers(count, "tilt factors");
    bool varies = false;
    for (const double factor : factors) {
      if (!(factor >= 0)) data.fail(fmt::format("a tilt factor is {}", factor), "It must be 0 or more.");
      varies = varies || factor != 1;
    }
    const auto upright = std::find(angles.begin(), angles.end(), 0.0);
    if (upright != angles.end()) factor_ *= factors[static_cast<std::size_t>(upright - angles.begin())];
    if (!(factor_ > 0)) data.fail("the tilt factor of the upright luminaire is 0", "Correct it.");
    if (varies)
      result_.notes.push_back(
          data.where() +
          ": the lamp gives less light when tilted; the factor of the upright luminaire was taken. Scale "
          "lights that are tilted.");
  }

  void read_lamps() {
    const double lamps = text_.number("the number of lamps");
    const double lumens = text_.number("the lumens per lamp");
    const bool is_absolute = lumens == -1;
    if (!is_absolute && (!(lumens > 0) || !(lamps > 0)))
      result_.warnings.push_back(
          fmt::format("{}: {} lamps of {} lm: the light is that of the intensities, unchecked.",
                      text_.where(), lamps, lumens));
    factor_ *= text_.positive("the candela multiplier");
    verticals_ = static_cast<std::size_t>(text_.integer("the number of vertical angles", 2, kMostAngles));
    horizontals_ = static_cast<std::size_t>(text_.integer("the number of horizontal angles", 1, kMostAngles));
    constexpr std::size_t kMostCopies = 4;
    if (verticals_ * horizontals_ > kMostUnfolded / kMostCopies)
      text_.fail(fmt::format("{} x {} intensities", verticals_, horizontals_),
                 fmt::format("Tables of up to {} are read.", kMostUnfolded / kMostCopies));
    constexpr PhotometricType kTypes[] = {PhotometricType::kC, PhotometricType::kB, PhotometricType::kA};
    grid_.type = kTypes[text_.integer("the photometric type", 1, 3) - 1];
    const bool feet = text_.integer("the units type", 1, 2) == 1;
    const double width = text_.number("the width of the opening");
    const double length = text_.number("the length of the opening");
    const double height = text_.number("the height of the opening");
    for (const double size : {width, length, height})
      if (std::fabs(size) > limits::kFarthest)
        text_.fail(fmt::format("a size of the opening is {}", size),
                   fmt::format("Sizes of up to {:g} are read.", limits::kFarthest));
    bool known = true;
    result_.opening = ies_opening(width, length, height, feet ? kMetresPerFoot : 1.0, edition_ < 2002, known);
    if (!known)
      result_.warnings.push_back(fmt::format(
          "{}: an opening of {} x {} x {} has no meaning in LM-63; a box of these sizes is taken.",
          text_.where(), width, length, height));
    const double ballast = text_.number("the ballast factor");
    if (!(ballast > 0))
      text_.fail(
          fmt::format("the ballast factor is {}", ballast),
          "It must be above 0. Is the line of ballast factor, a second number and input watts missing, "
          "so that an angle stands in its place?");
    factor_ *= ballast;
    read_second_factor();
    text_.number("the input watts");
    result_.lamp_lumens = std::max(0.0, lamps) * std::max(0.0, lumens) * factor_lumens_ * ballast;
  }

  /// The number after the ballast factor is a factor in the editions of 1986 and 1991, not used in those of
  /// 1995 and 2002, and tells how the file was made in that of 2019.
  void read_second_factor() {
    if (edition_ < 1995) {
      factor_lumens_ = text_.positive("the ballast-lamp photometric factor");
      factor_ *= factor_lumens_;
      return;
    }
    const double value = text_.number("the number after the ballast factor");
    if (edition_ < 2019 && value != 1)
      result_.warnings.push_back(fmt::format(
          "{}: the number {} after the ballast factor has no meaning in LM-63-{} and was not applied.",
          text_.where(), value, edition_));
  }

  void expect_increase(const std::vector<double>& angles, const std::vector<std::uint32_t>& lines,
                       const char* what) const {
    for (std::size_t i = 1; i < angles.size(); ++i)
      if (!(angles[i] > angles[i - 1]))
        text_.fail_at(
            lines[i],
            fmt::format("the {} angles do not increase: {} after {}", what, angles[i], angles[i - 1]),
            "Sort them and name each once; check the counts of angles, and that decimals have points, not "
            "commas.");
  }

  void read_grid() {
    std::vector<std::uint32_t> lines;
    grid_.vertical = text_.numbers(verticals_, "vertical angles", &lines);
    expect_increase(grid_.vertical, lines, "vertical");
    const IesComplaint vertical = check_vertical_angles(grid_);
    if (!vertical.problem.empty()) text_.fail(vertical.problem, vertical.advice);
    lines.clear();
    grid_.horizontal = text_.numbers(horizontals_, "horizontal angles", &lines);
    expect_increase(grid_.horizontal, lines, "horizontal");
    const IesComplaint horizontal = check_horizontal_angles(grid_);
    if (!horizontal.problem.empty()) text_.fail(horizontal.problem, horizontal.advice);
    lines.clear();
    grid_.candela = text_.numbers(verticals_ * horizontals_, "candela values", &lines);
    clear_noise(grid_.candela, text_.where(), result_.warnings);
    for (std::size_t i = 0; i < grid_.candela.size(); ++i) {
      if (grid_.candela[i] < 0)
        text_.fail_at(lines[i], fmt::format("the intensity {} cd is negative", grid_.candela[i]),
                      "Intensities are 0 or more.");
      grid_.candela[i] *= factor_;
      if (!std::isfinite(grid_.candela[i]))
        text_.fail_at(lines[i], "an intensity is too large for a number", "Check the candela multiplier.");
    }
  }

  void finish() {
    const std::string file = path_.lexically_normal().string();
    result_.table = table_of(grid_, text_.where(), file, result_.warnings);
    if (grid_.type != PhotometricType::kC && std::fabs(grid_.vertical.front()) < 1)
      result_.warnings.push_back(
          fmt::format("{}: the vertical angles begin at 0 degrees, so no light goes to angles below.", file));
    const double flux = result_.table->total_flux();
    constexpr double kMost = 1.05;
    constexpr double kLeast = 0.01;
    if (result_.lamp_lumens > 0 &&
        (flux > kMost * result_.lamp_lumens || flux < kLeast * result_.lamp_lumens))
      result_.warnings.push_back(
          fmt::format("{}: the intensities amount to {:.4g} lm, but the lamps give {:.4g} lm: is the candela "
                      "multiplier right?",
                      file, flux, result_.lamp_lumens));
  }

  std::filesystem::path path_;
  IesText text_;
  MeasuredLuminaire result_;
  IesGrid grid_;
  std::string tilt_;
  int edition_ = 1986;
  std::size_t verticals_ = 0, horizontals_ = 0;
  double factor_ = 1;         // of the intensities
  double factor_lumens_ = 1;  // of the lamp lumens, beside the ballast factor
};

}  // namespace

MeasuredLuminaire read_ies_file(const std::filesystem::path& file) {
  return IesFile(file).read();
}

}  // namespace reemit
