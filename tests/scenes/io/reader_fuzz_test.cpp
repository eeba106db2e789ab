// Damaged rooms: whatever comes in, a reader gives a room or throws InputError, in bounded time.
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "scenes/io/common/text_parse.h"
#include "scenes/io/mgf/mgf_reader.h"
#include "scenes/io/obj/obj_reader.h"
#include "scenes/model/error.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using Read = std::function<Scene(const std::filesystem::path&, const ReadOptions&)>;

constexpr int kRounds = 400;
constexpr std::size_t kCut = 3;  // bytes between two truncated lengths

const std::string kMgf = R"(# every entity once
c red =
	cxy 0.6 0.35
c warm =
	cct 2900
c leaf =
	cspec 400 700 0.1 0.6 0.1
c mix =
	cmix 1 red 2 leaf
m paint =
	c mix
	rd 0.4
	c
	rs 0.05 0.1
	sides 1
m lamp = paint
	td 0.1
	ts 0.1 0
	ir 1.5 0
	c warm
	ed 5000
v a =
	p 0 0 0
v b =
	p 4 0 0
v c =
	p 4 3 0
v d =
	p 0 3 0
v t =
	p 1 1 2
	n 0 0 1
v u = t
	p 1 2 2
o room
m paint
f a b c d
fh a b c d - a b t
xf -t 0 0 1 -a 3 -t 0 0 0.5 -a 2 -rz 45 -i 1 -mx
sph t 0.2
cyl t 0.1 u
xf
m lamp
cone t 0.1 u 0.2
ring t 0.1 0.3
torus t 0.1 0.3
prism a b c d -0.5
i part.inc -t 0 0 1
ies lamp.ies -m 2 -t 1 1 1
o
)";

const std::string kObj = R"(mtllib room.mtl
o room
v 0 0 0
v 4 0 0
v 4 3 0
v 0 3 0
v 0 0 2.5
v 4 0 2.5
vn 0 0 1
vt 0 0
g floor
usemtl wall
s off
f 1//1 2//1 3//1 4//1
g wall
f 1/1/1 5/1/1 6/1/1 2/1/1
usemtl lamp
f -3 -2 -1
f 5 6 1
)";

const std::string kMtl =
    "newmtl wall\nKd 0.5 0.5 0.4\nKs 0.1 0.1 0.1\nNs 20\nillum 2\nmap_Kd t.ppm\n"
    "newmtl lamp\nKd 0 0 0\nKe 5 5 4\nd 0.9\nNi 1.5\n";

class ReaderFuzz : public ::testing::Test {
 protected:
  ReaderFuzz() {
    folder_.write("part.inc", "m paint\nf a c d\n");
    folder_.write("lamp.ies", "IESNA91\nTILT=NONE\n1 -1 1 2 1 1 2 0.5 0.25 0\n1 1 0\n0 90\n0\n100 0\n");
    folder_.write("room.mtl", kMtl);
    folder_.write("t.ppm", std::string("P6\n1 1\n255\nabc"));
  }

  // Counts what came of it, so that a test can tell that both outcomes happen.
  void expect_room_or_refusal(const Read& read, const std::filesystem::path& file, const std::string& what) {
    try {
      Scene scene = read(file, {});
      finish_scene(scene);
      ++rooms_;
    } catch (const InputError& error) {
      EXPECT_FALSE(std::string(error.what()).empty());
      ++refusals_;
    } catch (const std::exception& error) {
      ADD_FAILURE() << what << ": " << error.what();
    }
  }

  // `damaged` takes the place of the text of file `name`; the room itself is `room`.
  void truncate(const Read& read, const std::string& name, const std::string& room, const std::string& text) {
    for (std::size_t length = 1; length <= text.size(); length += kCut) {
      folder_.write(name, text.substr(0, length));
      expect_room_or_refusal(read, folder_ / room, name + " cut at " + std::to_string(length));
    }
  }

  void flip_bytes(const Read& read, const std::string& name, const std::string& room,
                  const std::string& text) {
    std::mt19937 random(12345);
    for (int round = 0; round < kRounds; ++round) {
      std::string damaged = text;
      for (std::size_t flips = 1 + random() % 6; flips > 0; --flips)
        damaged[random() % damaged.size()] =
            static_cast<char>(random() % 4 == 0 ? random() % 256 : 32 + random() % 95);
      folder_.write(name, damaged);
      expect_room_or_refusal(read, folder_ / room, name + ", round " + std::to_string(round));
    }
  }

  // Swaps, drops, doubles and replaces words; lines keep their ends.
  void shuffle_words(const Read& read, const std::string& name, const std::string& room,
                     const std::string& text) {
    static const std::vector<std::string> kSpice = {
        "nan", "-1", "0", "1e308", "-1e308", "1e-308", "99999999999", "/",   "-a",  "2000", "xf",
        "o",   "f",  "=", "-",     "\\",     "usemtl", "v",           "1//", "inf", "i"};
    std::mt19937 random(54321);
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::vector<std::string>> lines;
      for (const TextLine& line : split_lines(text)) lines.emplace_back(line.words.begin(), line.words.end());
      const auto pick = [&]() -> std::string& {
        auto& line = lines[random() % lines.size()];
        return line[random() % line.size()];
      };
      for (std::size_t changes = 1 + random() % 4; changes > 0; --changes) {
        switch (random() % 4) {
          case 0:
            std::swap(pick(), pick());
            break;
          case 1:
            pick() = kSpice[random() % kSpice.size()];
            break;
          case 2:
            std::swap(lines[random() % lines.size()], lines[random() % lines.size()]);
            break;
          default:
            pick() += " " + kSpice[random() % kSpice.size()];
        }
      }
      std::string damaged;
      for (const auto& line : lines) {
        for (const std::string& word : line) damaged += word + " ";
        damaged += "\n";
      }
      folder_.write(name, damaged);
      expect_room_or_refusal(read, folder_ / room, name + ", round " + std::to_string(round));
    }
  }

  test::TempFolder folder_;
  int rooms_ = 0, refusals_ = 0;
};

TEST_F(ReaderFuzz, TheRoomsThemselvesAreSound) {
  folder_.write("room.mgf", kMgf);
  folder_.write("room.obj", kObj);
  expect_room_or_refusal(read_mgf_scene, folder_ / "room.mgf", "mgf");
  expect_room_or_refusal(read_obj_scene, folder_ / "room.obj", "obj");
  EXPECT_EQ(rooms_, 2);
}

TEST_F(ReaderFuzz, Mgf) {
  truncate(read_mgf_scene, "room.mgf", "room.mgf", kMgf);
  flip_bytes(read_mgf_scene, "room.mgf", "room.mgf", kMgf);
  shuffle_words(read_mgf_scene, "room.mgf", "room.mgf", kMgf);
  EXPECT_GT(rooms_, 50);
  EXPECT_GT(refusals_, 50);
}

TEST_F(ReaderFuzz, Obj) {
  truncate(read_obj_scene, "room.obj", "room.obj", kObj);
  flip_bytes(read_obj_scene, "room.obj", "room.obj", kObj);
  shuffle_words(read_obj_scene, "room.obj", "room.obj", kObj);
  EXPECT_GT(rooms_, 50);
  EXPECT_GT(refusals_, 50);
}

TEST_F(ReaderFuzz, Mtl) {
  folder_.write("room.obj", kObj);
  truncate(read_obj_scene, "room.mtl", "room.obj", kMtl);
  flip_bytes(read_obj_scene, "room.mtl", "room.obj", kMtl);
  shuffle_words(read_obj_scene, "room.mtl", "room.obj", kMtl);
  EXPECT_GT(rooms_, 50);
  EXPECT_GT(refusals_, 50);
}

TEST_F(ReaderFuzz, BinaryRubbish) {
  std::mt19937 random(99);
  for (int round = 0; round < 100; ++round) {
    std::string bytes(1 + random() % 3000, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    folder_.write("room.mgf", bytes);
    folder_.write("room.obj", bytes);
    expect_room_or_refusal(read_mgf_scene, folder_ / "room.mgf", "mgf");
    expect_room_or_refusal(read_obj_scene, folder_ / "room.obj", "obj");
  }
  EXPECT_EQ(rooms_, 0);
}

}  // namespace
}  // namespace reemit
