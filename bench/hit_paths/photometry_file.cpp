#include "bench/hit_paths/photometry_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>

namespace reemit::hit_paths {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// Weight of line i + 1 for an angle between lines i and i + 1; false outside the lines.
bool place(const std::vector<double>& lines, double angle, std::size_t& i, double& share) {
  constexpr double kRounding = 1e-7;
  if (angle < lines.front() - kRounding || angle > lines.back() + kRounding) return false;
  i = 0;
  while (i + 2 < lines.size() && angle > lines[i + 1]) ++i;
  share = std::min(1.0, std::max(0.0, (angle - lines[i]) / (lines[i + 1] - lines[i])));
  return true;
}

/// The numbers of a file after its TILT line, blanks or commas between them.
class Numbers {
 public:
  explicit Numbers(const std::filesystem::path& file) : in_(file) {
    std::string line;
    while (std::getline(in_, line))
      if (line.starts_with("TILT=")) break;
    if (!line.starts_with("TILT=NONE"))
      throw std::invalid_argument("the reference reads IES files with TILT=NONE");
  }
  double next() {
    while (in_.peek() == ',') in_.get();
    double value = 0;
    if (!(in_ >> value)) throw std::invalid_argument("the IES file ends too soon");
    while (in_.peek() == ',') in_.get();
    return value;
  }
  std::vector<double> next(std::size_t count) {
    std::vector<double> values(count);
    for (double& v : values) v = next();
    return values;
  }

 private:
  std::ifstream in_;
};

}  // namespace

Photometry::Photometry(const IntensityTable& table) : type_(table.type()), candela_(table.candela()) {
  for (const double a : table.polar()) vertical_.push_back(a * kDegrees);
  for (const double a : table.azimuth()) horizontal_.push_back(a * kDegrees);
}

Photometry::Photometry(const std::filesystem::path& file) : folded_(true) {
  std::string edition;
  std::getline(std::ifstream(file) >> std::ws, edition);
  const bool old = !edition.starts_with("IES") || edition.starts_with("IESNA91");
  Numbers numbers(file);
  numbers.next();  // lamps
  numbers.next();  // lumens of a lamp
  const double multiplier = numbers.next();
  const auto verticals = static_cast<std::size_t>(numbers.next());
  const auto horizontals = static_cast<std::size_t>(numbers.next());
  if (numbers.next() != 1) throw std::invalid_argument("the reference reads IES files of type C");
  const double metres = numbers.next() == 1 ? 0.3048 : 1;
  const double width = std::abs(numbers.next());
  const double length = std::abs(numbers.next());
  const double height = std::abs(numbers.next());
  size_ = metres * Vec3(length, width, height);
  const double ballast = numbers.next();
  const double ballast_lamp = numbers.next();
  numbers.next();  // watts
  vertical_ = numbers.next(verticals);
  horizontal_ = numbers.next(horizontals);
  candela_ = numbers.next(verticals * horizontals);
  for (double& c : candela_) c *= multiplier * ballast * (old ? ballast_lamp : 1.0);
}

double Photometry::candela(const Vec3& direction) const {
  // Cosines with the pole, and the angle about it, of each kind of goniometer.
  const Vec3 d = direction / direction.norm();
  double along = -d.z();
  double turn = std::atan2(d.y(), d.x());
  if (type_ == PhotometricType::kA) turn = -turn;
  if (type_ == PhotometricType::kB) {
    along = d.y();
    turn = std::atan2(d.x(), -d.z());
  }
  const double across = type_ == PhotometricType::kB ? std::hypot(d.x(), d.z()) : std::hypot(d.x(), d.y());
  const double vertical = std::atan2(across, along) * kDegrees;
  double horizontal = turn * kDegrees;
  if (folded_) {
    // 0: all planes alike. To 90 and to 180: mirrored. From 90 to 270: mirrored at the plane across.
    if (horizontal < 0) horizontal += 360;
    if (horizontal_.front() == 90 && horizontal_.back() == 270)
      horizontal = horizontal < 90 ? 180 - horizontal : horizontal > 270 ? 540 - horizontal : horizontal;
    else if (horizontal_.back() <= 180 && horizontal > 180)
      horizontal = 360 - horizontal;
    if (horizontal_.back() <= 90 && horizontal > 90) horizontal = 180 - horizontal;
  } else {
    while (horizontal < horizontal_.front() - 1e-7) horizontal += 360;
    while (horizontal > horizontal_.front() + 360) horizontal -= 360;
  }
  std::size_t v = 0;
  double s = 0;
  if (!place(vertical_, vertical, v, s)) return 0;
  const auto at = [&](std::size_t plane) {
    const double* c = candela_.data() + plane * vertical_.size() + v;
    return c[0] + s * (c[1] - c[0]);
  };
  if (horizontal_.size() == 1) return at(0);
  std::size_t h = 0;
  double t = 0;
  if (!place(horizontal_, horizontal, h, t)) return 0;
  return at(h) + t * (at(h + 1) - at(h));
}

}  // namespace reemit::hit_paths
