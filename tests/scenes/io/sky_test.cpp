// Sky and sun in room files and as options.
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>

#include "scenes/io/native/sky_option.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/error.h"
#include "tests/scenes/io/expect_input_error.h"
#include "tests/scenes/io/native_reading.h"
#include "tests/support/encoded_image.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::expect_input_error;
using test::TempFolder;

std::string room_under(const std::string& sky) {
  return test::replaced(test::small_json_room(), R"("cameras")", R"("sky": )" + sky + R"(, "cameras")");
}

Scene read_under(const std::string& sky) {
  const TempFolder folder;
  return read_scene(folder.write("room.json", room_under(sky)));
}

void expect_sky_refused(const std::string& sky, std::initializer_list<const char*> parts) {
  expect_input_error([&] { read_under(sky); }, parts);
}

double lux(const Scene& scene, const Spectrum& irradiance) {
  return (irradiance * scene.bands.efficacy_lm_per_w()).sum();
}

/// An image of 16 x 8 pixels as .exr.
std::filesystem::path write_image(const TempFolder& folder, std::vector<float> rgb, int width = 16,
                                  int height = 8) {
  const ImageDescription description{"openexr", width, height, {"R", "G", "B"}, PixelType::kFloat};
  return folder.write("sky.exr", test::encoded_image(description, rgb.data()));
}

std::vector<float> even_pixels(float value, int count = 16 * 8) {
  return std::vector<float>(static_cast<std::size_t>(count) * 3, value);
}

TEST(Sky, overcast_by_its_illuminance) {
  const Scene scene = read_under(R"({"type": "overcast", "illuminance_lx": 10000, "up": "y"})");
  ASSERT_TRUE(scene.sky);
  EXPECT_EQ(scene.sky->kind, SkyKind::kOvercast);
  EXPECT_NEAR(lux(scene, horizontal_sky_irradiance(*scene.sky, scene.bands)), 10000, 1e-6);
  EXPECT_NEAR(scene.sky->ground_reflectance[0], 0.2, 1e-12);
  EXPECT_EQ(scene.sky->up, Vec3(0, 1, 0));
  EXPECT_EQ(scene.sky->north, Vec3(0, 0, -1)) << "so that x runs east";
}

TEST(Sky, zenith_luminance_is_nine_sevenths_of_the_mean) {
  const Scene scene = read_under(R"({"type": "overcast", "zenith_luminance_cd_m2": 900, "up": "z"})");
  EXPECT_NEAR(lux(scene, horizontal_sky_irradiance(*scene.sky, scene.bands)), 7 * pi * 100, 1e-6);
  EXPECT_EQ(scene.sky->north, Vec3(0, 1, 0));
}

TEST(Sky, sun_at_a_place_and_time_stands_where_it_did) {
  const Scene scene = read_under(
      R"({"type": "clear", "illuminance_lx": 20000, "up": "z", "sun": {"latitude_deg": 39.742476, "longitude_deg":
          -105.1786, "time": "2003-10-17T12:30:30-07:00", "illuminance_lx": 90000}})");
  const Vec3 sun = scene.sky->towards_sun();
  const double altitude = std::asin(sun.z()) * 180 / pi;
  const double azimuth = std::atan2(sun.x(), sun.y()) * 180 / pi;
  EXPECT_NEAR(altitude, 90 - 50.11162, 0.015) << "sea level, where refraction is 0.004 degrees more";
  EXPECT_NEAR(azimuth + 360, 194.34024, 0.01);
  EXPECT_NEAR(lux(scene, horizontal_sun_irradiance(*scene.sky, scene.bands)), 90000 * sun.z(), 1e-6);
}

TEST(Sky, options_are_the_same_as_the_file) {
  const TempFolder folder;
  const auto plain = folder.write("plain.json", test::small_json_room());
  const auto in_file = folder.write(
      "sky.json",
      room_under(
          R"({"type": "cie", "cie_type": 7, "illuminance_lx": 15000, "ground_reflectance": 0.3, "up": "z",
                                 "north": [1, 1, 0], "sun": {"altitude_deg": 30, "azimuth_deg": 120, "illuminance_lx": 50000}})"));
  ReadOptions options;
  options.sky = "cie7:15000lx,ground=0.3,up=z,north=1/1/0";
  options.sun = "altitude=30,azimuth=120,lx=50000";
  EXPECT_EQ(content_hash(read_scene(plain, options)), content_hash(read_scene(in_file)));
  EXPECT_NE(content_hash(read_scene(plain)), content_hash(read_scene(in_file)));
  options.sun = "altitude=31,azimuth=120,lx=50000";
  EXPECT_NE(content_hash(read_scene(plain, options)), content_hash(read_scene(in_file)));
}

TEST(Sky, a_room_that_is_lit_by_its_sky_is_not_called_dark) {
  const TempFolder folder;
  const std::string dark =
      test::replaced(test::small_json_room(), R"("exitance": [30, 25, 20])", R"("sides": "both")");
  const auto file = folder.write("room.json", dark);
  using testing::Contains;
  using testing::HasSubstr;
  EXPECT_THAT(read_scene(file).warnings, Contains(HasSubstr("no luminaire")));
  ReadOptions options;
  options.sky = "overcast:10000lx";
  EXPECT_THAT(read_scene(file, options).warnings, Not(Contains(HasSubstr("no luminaire"))));
}

TEST(Sky, colour_keeps_a_room_from_becoming_grey) {
  const TempFolder folder;
  const std::string grey = test::replaced(
      test::replaced(test::small_json_room(), R"("exitance": [30, 25, 20])", R"("exitance": 1)"),
      "[0.6, 0.1, 0.1]", "0.3");
  const auto file = folder.write("room.json", grey);
  EXPECT_EQ(read_scene(file).bands.count(), 1U);
  ReadOptions options;
  options.sky = "uniform:10000lx,color=0.8/0.9/1.2";
  EXPECT_EQ(read_scene(file, options).bands.count(), 3U);
}

TEST(Sky, images_keep_their_light) {
  const TempFolder folder;
  write_image(folder, even_pixels(2));
  folder.write("room.json", room_under(R"({"type": "image", "file": "sky.exr", "scale": 3, "up": "z"})"));
  const Scene scene = read_scene(folder / "room.json");
  EXPECT_NEAR(horizontal_sky_irradiance(*scene.sky, scene.bands)[0], 6 * pi, 1e-5);
  EXPECT_EQ(scene.sky->ground_reflectance.size(), 0) << "its lower half is the ground";
}

/// An orange zenith, a blue horizon, and dark ground.
std::vector<float> evening(int rows) {
  std::vector<float> rgb;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < 2 * rows; ++column) {
      const float down = (static_cast<float>(row) + 0.5F) / static_cast<float>(rows);
      const float side = static_cast<float>(column % 7) / 7;
      for (const float value : {9 - 8 * down + side, 3.0F, 0.5F + 6 * down}) rgb.push_back(value);
    }
  return rgb;
}

TEST(Sky, images_keep_their_colours_in_spectral_bands) {
  const TempFolder folder;
  write_image(folder, evening(8));
  folder.write("room.json", room_under(R"({"type": "image", "file": "sky.exr", "up": "z"})"));
  const auto sky_colour = [](const Scene& scene) {
    return scene.bands.to_rgb(horizontal_sky_irradiance(*scene.sky, scene.bands));
  };
  const Scene rgb = read_scene(folder / "room.json");
  ReadOptions options;
  options.bands = {400, 700, 10};
  const Scene spectral = read_scene(folder / "room.json", options);
  ASSERT_EQ(spectral.bands.count(), 31U);
  EXPECT_TRUE(sky_colour(spectral).isApprox(sky_colour(rgb), 1e-5));
  // So many bands that the image is made smaller: 204 rows at most.
  write_image(folder, evening(256), 512, 256);
  const Scene large = read_scene(folder / "room.json");
  options.bands = {380, 780, 0.5};
  const Scene many = read_scene(folder / "room.json", options);
  EXPECT_EQ(many.sky->image->rows, 204U);
  EXPECT_TRUE(sky_colour(many).isApprox(sky_colour(large), 1e-3));
  // In a room with bands of its own.
  const std::string own = test::room(
      R"("bands": {"wavelengths_nm": [400, 440, 480, 520, 560, 600, 640, 680, 700]}, "materials": {"a": {"reflectance": 0.5}},
         "objects": [{"material": "a", "quad": {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]}}],
         "sky": {"type": "image", "file": "sky.exr", "up": "z"})");
  const Scene native = read_scene(folder.write("own.json", own));
  EXPECT_NEAR(lux(native, horizontal_sky_irradiance(*native.sky, native.bands)),
              lux(large, horizontal_sky_irradiance(*large.sky, large.bands)), 1e-4 * 179 * 20);
}

// 255 rows become 204, so each of these has parts of two: no row, no column and no angle may be lost.
TEST(Sky, images_whose_sides_do_not_divide_keep_their_light) {
  const TempFolder folder;
  constexpr int kRows = 255;
  std::vector<float> rgb = evening(kRows);
  constexpr std::size_t kLast = 3 * (2 * kRows * (kRows / 4) + 2 * kRows - 1);
  rgb[kLast] = 1000;  // a sun in the last column
  write_image(folder, rgb, 2 * kRows, kRows);
  folder.write("room.json", room_under(R"({"type": "image", "file": "sky.exr", "up": "z"})"));
  const Scene large = read_scene(folder / "room.json");
  ReadOptions options;
  options.bands = {380, 780, 0.5};
  const Scene small = read_scene(folder / "room.json", options);
  const std::size_t rows = small.sky->image->rows;
  ASSERT_EQ(rows, 204U);
  const Eigen::Array3d before = large.bands.to_rgb(horizontal_sky_irradiance(*large.sky, large.bands));
  const Eigen::Array3d after = small.bands.to_rgb(horizontal_sky_irradiance(*small.sky, small.bands));
  EXPECT_TRUE(after.isApprox(before, 2e-4)) << before.transpose() << ", " << after.transpose();
  // The sun stands in the last column still.
  const std::size_t bands = small.bands.count(), columns = small.sky->image->columns;
  const auto brightest =
      std::max_element(small.sky->image->radiance.begin(), small.sky->image->radiance.end());
  const auto place = static_cast<std::size_t>(brightest - small.sky->image->radiance.begin()) / bands;
  EXPECT_EQ(place % columns, columns - 1);
}

TEST(Sky, absurd_images_are_refused) {
  const TempFolder folder;
  folder.write("room.json", room_under(R"({"type": "image", "file": "sky.exr"})"));
  const auto refused = [&](std::vector<float> rgb, int width, int height,
                           std::initializer_list<const char*> parts) {
    write_image(folder, std::move(rgb), width, height);
    expect_input_error([&] { read_scene(folder / "room.json"); }, parts);
  };
  expect_input_error([&] { read_scene(folder / "room.json"); }, {"sky.exr"});  // it is not there
  std::vector<float> negative = even_pixels(1);
  negative[3 * (16 * 2 + 5) + 1] = -0.5F;
  refused(negative, 16, 8, {"sky.exr", "pixel (5, 2)", "-0.5"});
  std::vector<float> no_number = even_pixels(1);
  no_number[3] = std::numeric_limits<float>::quiet_NaN();
  refused(no_number, 16, 8, {"sky.exr", "pixel (1, 0)"});
  refused(even_pixels(1, 1), 1, 1, {"1 x 1", "twice as wide as high"});
  refused(even_pixels(1, 16 * 16), 16, 16, {"16 x 16", "twice as wide as high"});
  refused(even_pixels(0), 16, 8, {"black"});
  std::ofstream(folder / "sky.exr") << "no image";
  expect_input_error([&] { read_scene(folder / "room.json"); }, {"sky.exr", "cannot be read"});
}

TEST(Sky, mistakes_are_named_with_their_place) {
  expect_sky_refused(R"({"type": "cloudy", "illuminance_lx": 1})",
                     {"room.json#/sky/type", "cloudy", "overcast"});
  expect_sky_refused(R"({"type": "overcast"})", {"room.json#/sky", "no strength", "illuminance_lx"});
  expect_sky_refused(R"({"type": "overcast", "illuminance_lx": 0})", {"sends no light"});
  expect_sky_refused(R"({"type": "overcast", "illuminance_lx": -5})", {"/sky/illuminance_lx", "-5"});
  expect_sky_refused(R"({"type": "none"})", {"neither sky nor sun"});
  expect_sky_refused(R"({"type": "clear", "illuminance_lx": 1e4})", {"it is not said where that stands"});
  expect_sky_refused(R"({"type": "cie", "cie_type": 16, "illuminance_lx": 1e4})", {"/sky/cie_type", "16"});
  expect_sky_refused(R"({"type": "clear", "illuminance_lx": 1e4, "sun": {"altitude_deg": -3}})",
                     {"/sky/sun/altitude_deg", "3 degrees below the horizon"});
  expect_sky_refused(
      R"({"type": "clear", "illuminance_lx": 1e4, "sun": {"latitude_deg": 48, "longitude_deg": 16, "time":
                    "2024-06-21T01:00Z"}})",
      {"/sky/sun/time", "below the horizon then"});
  for (const char* time : {"2024-06-21", "2024-06-21T12:00", "2024-13-21T12:00Z", "yesterday",
                           "2024-06-21T12:00Zebra", "", "2024-02-30T12:00Z", "2023-02-29T12:00Z"})
    expect_sky_refused(R"({"type": "none", "sun": {"latitude_deg": 48, "longitude_deg": 16, "time": ")" +
                           std::string(time) + R"("}})",
                       {"/sky/sun/time", "is not a time"});
  expect_sky_refused(R"({"type": "overcast", "illuminance_lx": 1e4, "up": "z", "north": [0, 0, 1]})",
                     {"/sky/north", "along up"});
  expect_sky_refused(R"({"type": "overcast", "illuminance_lx": 1e4, "ground_reflectance": 1.5})",
                     {"/sky/ground_reflectance", "1.5"});
}

TEST(Sky, what_says_nothing_of_the_sky_is_refused) {
  expect_sky_refused(R"({"type": "none", "illuminance_lx": 1e4})", {"/sky/illuminance_lx", "\"none\""});
  expect_sky_refused(R"({"type": "image", "file": "a.hdr", "illuminance_lx": 1e4})", {"/sky/illuminance_lx"});
  expect_sky_refused(R"({"type": "overcast", "illuminance_lx": 1e4, "cie_type": 3})",
                     {"/sky/cie_type", "of: cie"});
  expect_sky_refused(R"({"type": "overcast", "illuminance_lx": 1e4, "scale": 2})",
                     {"/sky/scale", "of: image"});
  expect_sky_refused(R"({"type": "clear", "illuminance_lx": 1e4, "direct_normal_W_m2": 500})",
                     {"/sky/direct_normal_W_m2", "of: perez"});
  const auto with_sun = [](const std::string& sun) {
    return R"({"type": "none", "sun": {"illuminance_lx": 1e4, )" + sun + "}}";
  };
  expect_sky_refused(
      with_sun(R"("latitude_deg": 48, "longitude_deg": 16, "time": "2024-06-21T12:00Z", "azimuth_deg": 90)"),
      {"/sky/sun/azimuth_deg", "the time says"});
  expect_sky_refused(with_sun(R"("altitude_deg": 30, "latitude_deg": 48)"),
                     {"/sky/sun/latitude_deg", "time"});
}

TEST(Sky, mistakes_in_options_name_the_option) {
  const TempFolder folder;
  const auto file = folder.write("room.json", test::small_json_room());
  const auto refused = [&](const char* sky, const char* sun, std::initializer_list<const char*> parts) {
    ReadOptions options;
    options.sky = sky;
    options.sun = sun;
    expect_input_error([&] { read_scene(file, options); }, parts);
  };
  refused("overcast:10000", "", {"--sky", "'10000' has no unit", "overcast:10000lx"});
  refused("overcast:manylx", "", {"--sky", "'many' is not a number"});
  refused("grey:5lx", "", {"--sky", "grey"});
  refused("overcast:5lx,floor=0.2", "", {"--sky", "floor=0.2"});
  refused("image:nowhere.hdr", "", {"nowhere.hdr"});
  refused("", "altitude=-4,lx=5", {"--sun", "below the horizon"});
  refused("", "height=4,lx=5", {"--sun", "height=4"});
  refused("", "altitude=4", {"--sun", "neither sky nor sun", "lx=80000"});
  refused("overcast", "", {"--sky", "'overcast' has no strength", "overcast:10000lx"});
}

TEST(Sky, image_options_name_the_file_wherever_they_are_used) {
  const std::string option = with_absolute_path("image:skies/a.hdr,scale=2");
  EXPECT_EQ(option, "image:" + (std::filesystem::current_path() / "skies/a.hdr").string() + ",scale=2");
  EXPECT_EQ(with_absolute_path("overcast:5lx"), "overcast:5lx");
}

}  // namespace
}  // namespace reemit
