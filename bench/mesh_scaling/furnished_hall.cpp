#include "bench/mesh_scaling/furnished_hall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "scenes/model/vec.h"

namespace reemit::bench {
namespace {

constexpr double kPitch = 2.6;         // between workplaces [m]
constexpr double kHeight = 3.2;        // of the hall [m]
constexpr int kCoarse = 12;            // sides of a circle of a workplace that is not detailed
constexpr std::size_t kDetailed = 48;  // workplaces in a room that grows in detail

class ObjWriter {
 public:
  void begin(const std::string& material) {
    text_ += fmt::format("o part{}\nusemtl {}\n", parts_++, material);
  }
  /// Where the following corners stand: turned by `angle` about the vertical, then moved.
  void place(const Vec3& at, double angle) {
    at_ = at;
    turn_ = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  }
  std::size_t vertex(const Vec3& local) {
    const Vec3 p = at_ + turn_ * local;
    fmt::format_to(std::back_inserter(text_), "v {:.6f} {:.6f} {:.6f}\n", p.x(), p.y(), p.z());
    return ++vertices_;
  }
  void triangle(std::size_t a, std::size_t b, std::size_t c) {
    fmt::format_to(std::back_inserter(text_), "f {} {} {}\n", a, b, c);
    ++triangles_;
  }
  void quad(std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  std::size_t triangles() const { return triangles_; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  Vec3 at_ = Vec3::Zero();
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  std::size_t parts_ = 0;
  std::size_t vertices_ = 0;
  std::size_t triangles_ = 0;
};

void box(ObjWriter& out, const Vec3& low, const Vec3& high, bool inwards = false) {
  std::array<std::size_t, 8> v{};
  for (std::size_t i = 0; i < 8; ++i)
    v[i] = out.vertex({(i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                       (i & 4) != 0 ? high.z() : low.z()});
  constexpr std::array<std::array<std::size_t, 4>, 6> kSides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (auto side : kSides) {
    if (inwards) std::reverse(side.begin(), side.end());
    out.quad(v[side[0]], v[side[1]], v[side[2]], v[side[3]]);
  }
}

/// An upright solid whose radius runs along `profile` of (radius, height), closed by fans at both ends.
void turned(ObjWriter& out, const Vec3& foot, const std::vector<std::pair<double, double>>& profile,
            int sides) {
  std::vector<std::vector<std::size_t>> rings;
  for (const auto& [radius, height] : profile) {
    std::vector<std::size_t>& ring = rings.emplace_back();
    for (int i = 0; i < sides; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / sides;
      ring.push_back(out.vertex(foot + Vec3(radius * std::cos(azimuth), radius * std::sin(azimuth), height)));
    }
  }
  const std::size_t below = out.vertex(foot + Vec3(0, 0, profile.front().second));
  const std::size_t above = out.vertex(foot + Vec3(0, 0, profile.back().second));
  for (std::size_t i = 0; i < rings[0].size(); ++i) {
    const std::size_t next = (i + 1) % rings[0].size();
    out.triangle(below, rings.front()[next], rings.front()[i]);
    for (std::size_t r = 0; r + 1 < rings.size(); ++r)
      out.quad(rings[r][i], rings[r][next], rings[r + 1][next], rings[r + 1][i]);
    out.triangle(above, rings.back()[i], rings.back()[next]);
  }
}

void cylinder(ObjWriter& out, const Vec3& foot, double radius, double height, int sides) {
  // Round things of fine models are fine along their axis as well.
  const int rows = std::max(1, sides / kCoarse);
  std::vector<std::pair<double, double>> profile;
  for (int i = 0; i <= rows; ++i) profile.emplace_back(radius, height * i / rows);
  turned(out, foot, profile, sides);
}

void globe(ObjWriter& out, const Vec3& centre, double radius, int sides) {
  std::vector<std::pair<double, double>> profile;
  for (int i = 1; i < sides / 2; ++i) {
    const double polar = 2 * std::numbers::pi * i / sides;
    profile.emplace_back(radius * std::sin(polar), -radius * std::cos(polar));
  }
  turned(out, centre, profile, sides);
}

class Furnisher {
 public:
  Furnisher(ObjWriter& out, std::uint32_t seed, int sides) : out_(out), random_(seed), sides_(sides) {}

  void workplace(const Vec3& centre) {
    const double angle = between(0, 2 * std::numbers::pi);
    const Vec3 at = centre + Vec3(between(-0.3, 0.3), between(-0.3, 0.3), 0);
    desk(at, angle);
    const Eigen::AngleAxisd turn(angle, Vec3::UnitZ());
    chair(at + turn * Vec3(between(-0.2, 0.2), -0.65, 0), angle + between(-0.6, 0.6));
    shelf(at + turn * Vec3(0, 0.75, 0), angle);
    out_.place(at + turn * Vec3(0.95, between(-0.3, 0.1), hover()), angle);
    out_.begin("metal");
    cylinder(out_, Vec3::Zero(), between(0.12, 0.16), 0.32, sides_);
    out_.place(at + Vec3(0, 0, between(2.2, 2.6)), angle);
    out_.begin("glass");
    globe(out_, Vec3::Zero(), between(0.1, 0.18), sides_);
  }

 private:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double hover() { return between(0, 1) < 0.2 ? 2e-4 : 0.0; }

  void desk(const Vec3& at, double angle) {
    out_.place(at, angle);
    const double w = between(1.3, 1.7);
    const double d = between(0.65, 0.8);
    out_.begin("wood");
    box(out_, {-w / 2, -d / 2, 0.72}, {w / 2, d / 2, 0.75});
    out_.begin("metal");
    for (const double x : {-w / 2 + 0.06, w / 2 - 0.06})
      for (const double y : {-d / 2 + 0.06, d / 2 - 0.06}) cylinder(out_, {x, y, 0}, 0.025, 0.72, sides_);
    out_.begin("wood");
    box(out_, {w / 2 - 0.55, -0.2, hover()}, {w / 2 - 0.12, 0.25, 0.6});
    out_.begin("plastic");
    box(out_, {-0.15, 0.05, 0.75 + hover()}, {0.15, 0.2, 0.77});
    box(out_, {-0.03, 0.1, 0.77}, {0.03, 0.13, 0.9});
    box(out_, {-0.28, 0.08, 0.9}, {0.28, 0.12, 1.25});
    out_.begin("china");
    cylinder(out_, {between(-0.5, -0.4), between(-0.2, 0), 0.75}, 0.04, 0.09, sides_);
    out_.begin("paper");
    double z = 0.75;
    for (int i = 0; i < 4; ++i) {
      const double next = z + between(0.01, 0.04);
      const double x = between(0.35, 0.45);
      box(out_, {x, -0.2, z}, {x + 0.15, between(0, 0.05), next});
      z = next;
    }
  }

  void chair(const Vec3& at, double angle) {
    out_.place(at, angle);
    out_.begin("cloth");
    box(out_, {-0.22, -0.22, 0.43}, {0.22, 0.22, 0.47});
    out_.begin("metal");
    for (const double x : {-0.19, 0.19})
      for (const double y : {-0.19, 0.19}) cylinder(out_, {x, y, hover()}, 0.015, 0.43, sides_);
    for (const double x : {-0.19, 0.19}) cylinder(out_, {x, -0.2, 0.47}, 0.012, 0.45, sides_);
    out_.begin("cloth");
    back_rest();
  }

  /// A bent sheet.
  void back_rest() {
    const int across = std::max(4, sides_ / 2);
    const int up = std::max(3, sides_ / 4);
    std::vector<std::size_t> above;
    for (int j = 0; j <= up; ++j) {
      std::vector<std::size_t> row;
      for (int i = 0; i <= across; ++i) {
        const double x = 0.4 * i / across - 0.2;
        row.push_back(out_.vertex({x, -0.18 - 0.05 * std::cos(5 * x), 0.6 + 0.3 * j / up}));
      }
      for (int i = 0; j > 0 && i < across; ++i) {
        const auto k = static_cast<std::size_t>(i);
        out_.quad(above[k], above[k + 1], row[k + 1], row[k]);
      }
      above = std::move(row);
    }
  }

  void shelf(const Vec3& at, double angle) {
    out_.place(at, angle);
    const double w = between(0.8, 1.2);
    out_.begin("wood");
    for (const double x : {-w / 2, w / 2 - 0.02}) box(out_, {x, 0, 0}, {x + 0.02, 0.3, 1.8});
    for (const double z : {0.05, 0.6, 1.2}) box(out_, {-w / 2 + 0.02, 0, z}, {w / 2 - 0.02, 0.3, z + 0.02});
    out_.begin("paper");
    for (const double z : {0.07, 0.62, 1.22}) {
      double x = -w / 2 + 0.02;
      for (int i = 0; i < 6; ++i) {
        const double next = x + between(0.02, 0.07);
        box(out_, {x, 0.02, z}, {next, between(0.2, 0.28), z + between(0.2, 0.35)});
        x = next;
      }
    }
  }

  ObjWriter& out_;
  std::mt19937 random_;
  int sides_;
};

/// The hall with its luminaires; the floor and the ceiling are one rectangle each.
void shell(ObjWriter& out, double width, double depth) {
  out.place(Vec3::Zero(), 0);
  out.begin("wall");
  box(out, {0, 0, 0}, {width, depth, kHeight}, true);
  out.begin("lamp");
  for (double x = 1.5; x + 1.2 < width; x += 5.2)
    for (double y = 1.5; y + 0.3 < depth; y += 5.2) {
      const double z = kHeight - 0.01;
      out.quad(out.vertex({x, y, z}), out.vertex({x, y + 0.3, z}), out.vertex({x + 1.2, y + 0.3, z}),
               out.vertex({x + 1.2, y, z}));
    }
}

std::string furnished(std::size_t places, int sides, std::uint32_t seed, std::size_t& triangles) {
  ObjWriter out;
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(places))));
  const std::size_t rows = (places + columns - 1) / columns;
  shell(out, kPitch * static_cast<double>(columns) + 1, kPitch * static_cast<double>(rows) + 1);
  Furnisher furnisher(out, seed, sides);
  for (std::size_t i = 0; i < places; ++i)
    furnisher.workplace({0.5 + kPitch * (0.5 + static_cast<double>(i % columns)),
                         0.5 + kPitch * (0.5 + static_cast<double>(i / columns)), 0});
  triangles = out.triangles();
  return out.text();
}

void save(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

std::size_t write_furnished_hall(const std::filesystem::path& file, std::size_t wanted, Growth growth,
                                 std::uint32_t seed) {
  std::size_t triangles = 0;
  std::size_t places = growth == Growth::kHall ? 16 : kDetailed;
  int sides = kCoarse;
  std::string text = furnished(places, sides, seed, triangles);
  if (growth == Growth::kHall) {
    places = std::max<std::size_t>(1, places * wanted / triangles);
    text = furnished(places, sides, seed, triangles);
  } else {
    while (triangles < wanted) text = furnished(places, sides += 2, seed, triangles);
  }
  const std::filesystem::path materials = std::filesystem::path(file).replace_extension(".mtl");
  std::string list;
  for (const char* name : {"wall", "wood", "metal", "glass", "plastic", "china", "paper", "cloth"})
    list += fmt::format("newmtl {}\nKd 0.5 0.5 0.5\n", name);
  list += "newmtl lamp\nKd 0.5 0.5 0.5\nKe 10 10 10\n";
  save(materials, list);
  save(file, fmt::format("mtllib {}\n", materials.filename().string()) + text);
  return triangles;
}

}  // namespace reemit::bench
