#include "viewer_export/still/render_still.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/mean_test.h"
#include "tests/support/never.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::MeanTest;
using test::RoomBuilder;

StillImage render(const RoomBuilder& room, const Solution& solution, const Camera& camera,
                  const StillSettings& settings) {
  const Room walls(room.scene(), solution.mesh);
  const std::atomic<bool> interrupt{false};
  return render_still(walls, solution, camera, settings, {}, interrupt);
}

StillSettings small_still(Integrator integrator, int spp) {
  StillSettings s;
  s.width = 24;
  s.height = 20;
  s.integrator = integrator;
  s.spp = spp;
  s.threads = 2;
  return s;
}

/// Camera in the middle of the furnace box, looking into a corner.
Camera inside() {
  Camera c;
  c.eye = {0.5, 0.5, 0.5};
  c.look_at = {1, 1, 0.9};
  c.up = {0, 0, 1};
  c.vertical_fov_deg = 80;
  return c;
}

/// The same into the corner below, where no lamp is seen, at whose edges any number of samples helps.
Camera downwards() {
  Camera c = inside();
  c.look_at = {1, 1, 0.1};
  return c;
}

RoomBuilder furnace(double exitance, double reflectance, std::uint32_t divisions) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", reflectance, exitance);
  room.box({0, 0, 0}, {1, 1, 1}, {m, m, m, m, m, m}, divisions);
  return room;
}

/// A box with a lamp near its ceiling and something that throws a shadow.
RoomBuilder lamp_room() {
  RoomBuilder room;
  const MaterialId white = room.material("white", 0.6, 0, true);
  const MaterialId lamp = room.material("lamp", 0.3, 20);
  room.box({0, 0, 0}, {1, 1, 1}, {white, white, white, white, white, white}, 6);
  room.quad(lamp, {Vec3(0.3, 0.3, 0.9), Vec3(0.3, 0.6, 0.9), Vec3(0.7, 0.6, 0.9), Vec3(0.7, 0.3, 0.9)}, 3);
  room.quad(white, {Vec3(0.5, 0.5, 0.4), Vec3(0.9, 0.5, 0.4), Vec3(0.9, 0.9, 0.4), Vec3(0.5, 0.9, 0.4)}, 3);
  return room;
}

TEST(RenderStill, furnace_is_evenly_bright_with_every_integrator) {
  // Radiance M/(pi (1-rho)) in every direction.
  const double m = 3;
  const double rho = 0.5;
  const RoomBuilder room = furnace(m, rho, 8);
  const Solution solution = test::uniform_solution(room, m, rho * m / (1 - rho));
  for (const Integrator integrator : {Integrator::kGather, Integrator::kPath, Integrator::kZones}) {
    const StillImage image = render(room, solution, inside(), small_still(integrator, 64));
    MeanTest pixels;
    for (const float l : image.radiance) pixels.add(static_cast<double>(l));
    EXPECT_TRUE(pixels.agrees_with(m / pi / (1 - rho))) << to_string(integrator);
    EXPECT_TRUE(pixels.would_notice(0.02, m / pi / (1 - rho))) << to_string(integrator);
    EXPECT_FALSE(pixels.agrees_with(1.02 * m / pi / (1 - rho))) << "a bias of 2 % must not pass";
  }
}

TEST(RenderStill, layers_say_what_they_are) {
  const double m = 3;
  const double rho = 0.5;
  const RoomBuilder room = furnace(m, rho, 8);
  const Solution solution = test::uniform_solution(room, m, rho * m / (1 - rho));
  const StillImage image = render(room, solution, inside(), small_still(Integrator::kZones, 8));
  ASSERT_NO_THROW(check_consistent(image));
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    EXPECT_NEAR(image.direct[p], (m + rho * m) / pi, 1e-5);
    EXPECT_NEAR(image.indirect[p], rho * rho * m / (1 - rho) / pi, 1e-5);
    EXPECT_NEAR(image.radiance_stderr[p], 0, 1e-6);
    EXPECT_EQ(image.samples[p], 8);
    EXPECT_NEAR(image.albedo[p], rho, 1e-6);
    EXPECT_GT(image.depth[p], 0.49F);
    EXPECT_LT(image.depth[p], 0.9F);
    EXPECT_NEAR(std::hypot(image.normal[3 * p], image.normal[3 * p + 1], image.normal[3 * p + 2]), 1, 1e-5);
  }
}

TEST(RenderStill, same_bits_for_any_number_of_threads) {
  const RoomBuilder room = lamp_room();
  const Solution solution = test::uniform_solution(room, 1, 0.5);
  StillSettings settings = small_still(Integrator::kGather, 8);
  settings.width = 50;
  settings.threads = 1;
  const StillImage one = render(room, solution, inside(), settings);
  settings.threads = 5;
  const StillImage five = render(room, solution, inside(), settings);
  EXPECT_EQ(one.radiance, five.radiance);
  EXPECT_EQ(one.radiance_stderr, five.radiance_stderr);
  settings.seed = 2;
  EXPECT_NE(one.radiance, render(room, solution, inside(), settings).radiance);
}

StillSettings refined_still(double error) {
  StillSettings settings = small_still(Integrator::kGather, 16);
  settings.width = 64;
  settings.height = 48;
  settings.smooth = true;
  settings.error_target = error;
  return settings;
}

TEST(RenderStill, smoothed_pictures_get_samples_where_noise_is_left) {
  const RoomBuilder room = lamp_room();
  const Solution solution = test::uniform_solution(room, 1, 0.5);
  const auto still_of = [&](double error) {
    StillSettings settings = refined_still(error);
    settings.seed = 2;  // by which some rays of pixels at the lamp's edge meet it
    return render(room, solution, inside(), settings);
  };
  const StillImage even = still_of(0.99);
  const StillImage refined = still_of(0.01);
  ASSERT_NO_THROW(check_consistent(refined));
  EXPECT_TRUE(refined.smoothed);
  for (const float samples : even.samples) EXPECT_EQ(samples, 16);
  ASSERT_GT(even.info.error, 0.015) << "nothing to refine";
  EXPECT_LE(refined.info.error, 0.01);
  // A true picture tells whether what is stated is so: within a half, as it is stated of smoothed pictures.
  StillSettings settings = refined_still(0);
  settings.smooth = false;
  settings.spp = 1024;
  settings.seed = 99;
  const StillImage truth = render(room, solution, inside(), settings);
  const auto error_of = [&](const StillImage& image) {
    const std::vector<double> scales = relative_scales(truth.radiance, 1, 0, settings.error_floor);
    double sum = 0;
    for (std::size_t p = 0; p < scales.size(); ++p)
      sum += std::pow(scales[p] * static_cast<double>(image.radiance[p] - truth.radiance[p]), 2);
    return std::sqrt(sum / static_cast<double>(scales.size()));
  };
  EXPECT_LT(error_of(refined), 0.016);
  EXPECT_GT(error_of(even), 1.5 * error_of(refined));
  const auto [fewest, most] = std::minmax_element(refined.samples.begin(), refined.samples.end());
  EXPECT_EQ(*fewest, 16);
  EXPECT_GE(*most, 128);
}

TEST(RenderStill, refinement_ends_where_noise_is_that_of_the_zones) {
  // So few packets that no sample of a pixel makes up for them.
  const RoomBuilder room = lamp_room();
  SolverSettings solver;
  solver.packets = 3'000;
  solver.direct = DirectSource::kPackets;  // shadow rays would make up for them
  const Solution solution = solve(room.scene(), room.mesh(), solver, {}, test::kNever);
  StillSettings settings = refined_still(1e-3);
  settings.width = 32;
  settings.height = 24;
  const StillImage image = render(room, solution, downwards(), settings);
  EXPECT_TRUE(image.limited_by_zones);
  EXPECT_GT(image.info.error, 1e-3);
  double rays = 0;
  for (const float samples : image.samples) rays += static_cast<double>(samples);
  EXPECT_LT(rays, 0.7 * settings.most_spp * static_cast<double>(image.pixel_count())) << "it did not notice";
}

TEST(RenderStill, refinement_that_is_interrupted_hands_over_what_was_smoothed) {
  const RoomBuilder room = furnace(3, 0.5, 8);
  const Solution solution = test::uniform_solution(room, 3, 3);
  const Room walls(room.scene(), solution.mesh);
  const StillSettings settings = refined_still(1e-7);
  std::atomic<bool> interrupt{false};
  const StillImage image = render_still(
      walls, solution, inside(), settings,
      [&](const StillProgress& now) {
        if (now.fraction > 0.6) interrupt = true;
      },
      interrupt);
  EXPECT_TRUE(interrupt);
  EXPECT_TRUE(image.smoothed);
  EXPECT_TRUE(image.interrupted);
  EXPECT_NO_THROW(check_consistent(image));
  double mean = 0;  // smoothed pixels are no independent ones
  for (const float l : image.radiance)
    mean += static_cast<double>(l) / static_cast<double>(image.pixel_count());
  EXPECT_NEAR(mean, 6 / pi, 0.002);
}

TEST(RenderStill, refinement_keeps_to_the_camera_rays_it_may_use) {
  const RoomBuilder room = lamp_room();
  const Solution solution = test::uniform_solution(room, 1, 0.5);
  StillSettings settings = refined_still(1e-4);
  settings.most_mean_spp = 24;
  const StillImage image = render(room, solution, downwards(), settings);
  double rays = 0;
  for (const float samples : image.samples) rays += static_cast<double>(samples);
  const auto pixels = static_cast<double>(image.pixel_count());
  EXPECT_LE(rays, 24 * pixels);
  EXPECT_GT(rays, 20 * pixels);
  EXPECT_GT(image.info.error, 1e-4);
}

TEST(RenderStill, refined_pictures_have_the_same_bits_for_any_number_of_threads) {
  const RoomBuilder room = lamp_room();
  const Solution solution = test::uniform_solution(room, 1, 0.5);
  StillSettings settings = refined_still(0.02);
  settings.threads = 1;
  const StillImage one = render(room, solution, inside(), settings);
  settings.threads = 5;
  const StillImage five = render(room, solution, inside(), settings);
  EXPECT_EQ(one.samples, five.samples);
  EXPECT_EQ(one.radiance, five.radiance);
  EXPECT_EQ(one.radiance_stderr, five.radiance_stderr);
}

TEST(RenderStill, standard_errors_are_true) {
  // Against a much better picture of the same room. The square of Student's t with 3 degrees of freedom,
  // capped at 25, has mean 2.157 and standard deviation 4.31. At 5 standard errors of 480 pixels a right
  // program fails with odds below 1 in 10^6; errors stated a third too small or too large would fail.
  const RoomBuilder room = lamp_room();
  const Solution solution = test::uniform_solution(room, 1, 0.5);
  const StillImage noisy = render(room, solution, inside(), small_still(Integrator::kGather, 16));
  StillSettings settings = small_still(Integrator::kGather, 1024);
  settings.seed = 99;
  const StillImage truth = render(room, solution, inside(), settings);
  double sum = 0;
  int count = 0;
  for (std::size_t p = 0; p < noisy.pixel_count(); ++p) {
    if (!(noisy.radiance_stderr[p] > 0)) continue;
    const double t = (noisy.radiance[p] - truth.radiance[p]) / noisy.radiance_stderr[p];
    sum += std::min(t * t, 25.0);
    ++count;
  }
  ASSERT_GT(count, 400);
  EXPECT_NEAR(sum / count, 2.157, 5 * 4.31 / std::sqrt(count));
}

TEST(RenderStill, error_target_is_reached_and_spends_samples_where_needed) {
  const RoomBuilder room = lamp_room();
  const Solution solution = test::uniform_solution(room, 1, 0.5);
  StillSettings settings = small_still(Integrator::kGather, 1);
  settings.width = settings.height = 48;
  settings.error_target = 0.01;
  const StillImage image = render(room, solution, inside(), settings);
  EXPECT_GT(image.info.error, 0.005);
  EXPECT_LE(image.info.error, 0.01);
  const auto [least, most] = std::minmax_element(image.samples.begin(), image.samples.end());
  EXPECT_GE(*least, 16);
  EXPECT_LT(*least, *most);
}

TEST(RenderStill, states_what_zones_do_beside_the_noise) {
  // M = 1, rho = 1/2: E = 2 everywhere. Zones that hold E = 2.4 add rho 0.2 (rho E/pi) = 0.1/pi to a radiance
  // of 2/pi, so the picture is off by 0.1/2.1, with 1 % of floor.
  const RoomBuilder room = furnace(1, 0.5, 3);
  StillSettings settings = small_still(Integrator::kGather, 64);
  settings.close_hit = 0;
  const auto zones_of = [&](double indirect) {
    return render(room, test::uniform_solution(room, 1, indirect), inside(), settings).info.zones.value();
  };
  const ZoneBias wrong = zones_of(1.4);
  EXPECT_TRUE(wrong.certain());
  // Five standard errors of the square; the bound is two above.
  EXPECT_NEAR(wrong.rms, 0.1 / (2.1 * 1.01), 2.5 * (wrong.bound - wrong.rms));
  EXPECT_LT(wrong.bound - wrong.rms, 0.01) << "test too weak";
  const ZoneBias right = zones_of(1);
  EXPECT_FALSE(right.certain());
  EXPECT_LT(right.bound, 0.02);

  settings.integrator = Integrator::kPath;
  EXPECT_EQ(zones_of(1.4).bound, 0) << "no zone is read";
}

TEST(RenderStill, lamp_over_a_floor_in_both_ways) {
  // An open floor under a lamp sees nothing but the sky: both must find the closed form.
  RoomBuilder room;
  room.quad(room.material("floor", 0.8), {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 2);
  room.scene().lights.push_back(PointLight{"bulb", {0.5, 0.5, 1}, Spectrum::Constant(1, 10.0)});
  Camera camera;
  camera.eye = {0.5, 0.5, 2};
  camera.look_at = {0.5, 0.5, 0};
  camera.vertical_fov_deg = 2 * std::atan(0.25) * 180 / pi;  // the middle half of the floor
  const Solution solution = test::dark_solution(room);
  for (const Integrator integrator : {Integrator::kGather, Integrator::kPath}) {
    StillSettings settings = small_still(integrator, 16);
    settings.height = settings.width;
    const StillImage image = render(room, solution, camera, settings);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double dx = (x + 0.5) / image.width - 0.5;
        const double dy = (y + 0.5) / image.height - 0.5;
        const double r2 = 1 + dx * dx + dy * dy;
        const double expected = 0.8 / pi * 10 / std::pow(r2, 1.5);
        EXPECT_NEAR(image.radiance[static_cast<std::size_t>(y * image.width + x)], expected, 0.02 * expected);
      }
  }
}

TEST(RenderStill, left_is_left_and_up_is_up) {
  // A floor lit from the left only under a camera that looks down with +y up: left is brighter.
  RoomBuilder room;
  room.quad(room.material("floor", 0.8), {Vec3(-5, -5, 0), Vec3(5, -5, 0), Vec3(5, 5, 0), Vec3(-5, 5, 0)}, 1);
  room.scene().lights.push_back(PointLight{"bulb", {-2, 1, 0.5}, Spectrum::Constant(1, 10.0)});
  Camera camera;
  camera.eye = {0, 0, 4};
  camera.look_at = {0, 0, 0};
  camera.vertical_fov_deg = 80;
  const StillImage image =
      render(room, test::dark_solution(room), camera, small_still(Integrator::kGather, 4));
  const auto brightest = std::max_element(image.radiance.begin(), image.radiance.end());
  const auto pixel = static_cast<int>(brightest - image.radiance.begin());
  // The picture shows 2 x 4 tan(40 deg) = 6.713 m over 20 pixels; square pixels across.
  EXPECT_NEAR(pixel % image.width, 12 + -2 / 6.713 * 20, 1.01);
  EXPECT_NEAR(pixel / image.width, 10 - 1 / 6.713 * 20, 1.01);
}

TEST(RenderStill, black_is_exactly_black) {
  RoomBuilder room = furnace(0, 0.5, 1);
  const StillImage image =
      render(room, test::dark_solution(room), inside(), small_still(Integrator::kGather, 4));
  for (const float l : image.radiance) EXPECT_EQ(l, 0);
  for (const float s : image.radiance_stderr) EXPECT_EQ(s, 0);
  EXPECT_EQ(image.info.error, 0);
}

TEST(RenderStill, sees_nothing_outside) {
  const RoomBuilder room = furnace(1, 0.5, 1);
  Camera camera = inside();
  camera.eye = {50, 0, 0};
  camera.look_at = {60, 0, 0};
  const StillImage image = render(room, test::dark_solution(room), camera, small_still(Integrator::kPath, 4));
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    EXPECT_EQ(image.radiance[p], 0);
    EXPECT_EQ(image.depth[p], std::numeric_limits<float>::infinity());
    EXPECT_EQ(image.normal[3 * p], 0);
  }
}

TEST(RenderStill, far_away_camera_sees_through_backs_of_one_sided_walls) {
  // 10^4 room sizes away: the depth keeps its precision, and the picture is the furnace.
  const double m = 3;
  const RoomBuilder room = furnace(m, 0.5, 4);
  Camera camera;
  camera.eye = {0.5, 0.5, 1e4};
  camera.look_at = {0.5, 0.5, 0};
  camera.vertical_fov_deg = 2 * std::atan(0.25e-4) * 180 / pi;
  const StillImage image =
      render(room, test::uniform_solution(room, m, m), camera, small_still(Integrator::kZones, 4));
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    EXPECT_NEAR(image.radiance[p], 2 * m / pi, 1e-4);
    EXPECT_NEAR(image.depth[p], 1e4, 0.01);
  }
}

TEST(RenderStill, one_sample_gives_no_errors) {
  const RoomBuilder room = lamp_room();
  const StillImage image =
      render(room, test::uniform_solution(room, 1, 0.5), inside(), small_still(Integrator::kGather, 1));
  EXPECT_TRUE(image.radiance_stderr.empty());
  EXPECT_EQ(image.samples[0], 1);
  EXPECT_NO_THROW(check_consistent(image));
}

TEST(RenderStill, interrupted_stills_are_noisier_stills) {
  // In a furnace every pixel sees the same radiance, whatever it was found with.
  const RoomBuilder room = furnace(3, 0.5, 8);
  const Solution solution = test::uniform_solution(room, 3, 3);
  const Room walls(room.scene(), solution.mesh);
  for (const Integrator integrator : {Integrator::kGather, Integrator::kPath}) {
    StillSettings settings = small_still(integrator, 1 << 14);
    settings.width = 100;  // 14 tiles
    settings.height = 18;
    for (const int last_report : {1, 17, 60}) {
      std::atomic<bool> interrupt{false};
      int reports = 0;
      const StillImage image = render_still(
          walls, solution, inside(), settings,
          [&](const StillProgress& now) {
            EXPECT_GE(now.fraction, 0);
            EXPECT_LE(now.fraction, 1);
            if (++reports == last_report) interrupt = true;
          },
          interrupt);
      SCOPED_TRACE(to_string(integrator) + ", " + std::to_string(last_report));
      EXPECT_NO_THROW(check_consistent(image));
      MeanTest pixels;
      for (const float l : image.radiance) {
        EXPECT_GT(l, 0.2 * 6 / pi);
        pixels.add(static_cast<double>(l));
      }
      EXPECT_TRUE(pixels.agrees_with(6 / pi));
      const auto [fewest, most] = std::minmax_element(image.samples.begin(), image.samples.end());
      EXPECT_GE(*fewest, 1);
      EXPECT_LE(*most, 3 * std::max(*fewest, 2.0F)) << "all tiles get on alike";
      const bool whole = last_report >= 14;  // all tiles had their first samples
      EXPECT_EQ(image.info.settings.back().first == "interrupted", !whole);
    }
  }
}

TEST(RenderStill, stills_interrupted_at_once_show_the_zones) {
  // The larger one has more pixels than are traced one by one then.
  const RoomBuilder room = furnace(3, 0.5, 8);
  const Solution solution = test::uniform_solution(room, 3, 3);
  const Room walls(room.scene(), solution.mesh);
  const std::atomic<bool> already{true};
  for (const int width : {70, 1030}) {
    StillSettings settings = small_still(Integrator::kGather, 16);
    settings.width = width;
    settings.height = width;
    const StillImage image = render_still(walls, solution, inside(), settings, {}, already);
    EXPECT_NO_THROW(check_consistent(image));
    for (const float l : image.radiance) ASSERT_NEAR(l, 6 / pi, 1e-5);
    for (const float s : image.samples) ASSERT_EQ(s, 1);
    for (const float d : image.depth) ASSERT_GT(d, 0);
    EXPECT_EQ(image.info.settings.back().first, "interrupted");
    EXPECT_FALSE(image.info.zones.has_value());
  }
}

TEST(RenderStill, refuses_nonsense) {
  const RoomBuilder room = furnace(1, 0.5, 1);
  const Solution solution = test::dark_solution(room);
  const auto refused = [&](Camera camera, StillSettings settings) {
    EXPECT_THROW(render(room, solution, camera, settings), InputError);
  };
  const StillSettings good = small_still(Integrator::kGather, 4);
  Camera camera = inside();
  camera.look_at = camera.eye;
  refused(camera, good);
  camera = inside();
  camera.up = camera.look_at - camera.eye;
  refused(camera, good);
  camera = inside();
  camera.vertical_fov_deg = 180;
  refused(camera, good);
  camera = inside();
  camera.eye.x() = std::nan("");
  refused(camera, good);
  StillSettings settings = good;
  settings.spp = 0;
  refused(inside(), settings);
  settings = good;
  settings.width = -3;
  refused(inside(), settings);
  settings = good;
  settings.error_target = 1;
  refused(inside(), settings);
  settings = good;
  settings.most_mean_spp = std::nan("");
  refused(inside(), settings);
}

/// Neither one with other zones nor one that is darker than when it was solved.
TEST(RenderStill, RefusesAnotherRoom) {
  const RoomBuilder room = furnace(1, 0.5, 2);
  SolverSettings solver;
  solver.packets = 1000;
  const Solution solution = solve_zones(room.scene(), room.mesh(), solver, {}, test::kNever);
  const StillSettings settings = small_still(Integrator::kZones, 1);
  EXPECT_NO_THROW(render(room, solution, inside(), settings));
  const auto with = [&](const Scene& scene, const ZoneMesh& mesh) {
    const Room walls(scene, mesh);
    render_still(walls, solution, inside(), settings, {}, test::kNever);
  };
  const ZoneMesh finer = furnace(1, 0.5, 3).mesh().mesh;
  EXPECT_THROW(with(room.scene(), finer), InputError);
  Scene darker = room.scene();
  for (Material& m : darker.materials) m.reflectance *= 0.3;
  EXPECT_THROW(with(darker, solution.mesh), InputError);
}

}  // namespace
}  // namespace reemit
