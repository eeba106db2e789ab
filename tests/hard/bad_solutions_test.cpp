// Solution files that cannot be used: exit code 2 and a message, from every subcommand that reads one.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include "solver/solution/file_seal.h"
#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/solved_room.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BadSolutions : public ::testing::Test {
 protected:
  BadSolutions() {
    folder_.write("room.json", small_json_room());
    solve_small_room(folder_, "room.h5");
  }

  void expect_refused(const std::vector<std::string>& command, const std::string& word) {
    const std::vector<std::string> before = folder_.listing();
    const ProgramRun run = run_reemit(command);
    EXPECT_EQ(run.exit_code, 2) << command.front() << ": " << run.err;
    EXPECT_THAT(run.out, IsEmpty()) << command.front();
    EXPECT_THAT(run.err, HasSubstr("reemit: error: ")) << command.front();
    EXPECT_THAT(run.err, HasSubstr(word)) << command.front();
    EXPECT_EQ(folder_.listing(), before) << command.front() << ": something was left behind";
  }

  void expect_refused_by_all(const std::string& name, const std::string& word) {
    const std::string solution = (folder_ / name).string();
    expect_refused({"audit", solution}, word);
    expect_refused({"info", solution}, word);
    expect_refused({"render", solution, "-o", (folder_ / "out.png").string()}, word);
    expect_refused({"export", solution, "-o", (folder_ / "out.csv").string()}, word);
  }

  TempFolder folder_;
};

TEST_F(BadSolutions, Missing) {
  expect_refused_by_all("none.h5", "none.h5");
}

TEST_F(BadSolutions, Empty) {
  folder_.write("bad.h5", "");
  expect_refused_by_all("bad.h5", "bad.h5");
}

TEST_F(BadSolutions, NoHdf5AtAll) {
  folder_.write("bad.h5", "this is a letter to a friend");
  expect_refused_by_all("bad.h5", "bad.h5");
}

TEST_F(BadSolutions, Truncated) {
  const std::string whole = read_bytes(folder_ / "room.h5");
  for (const std::size_t size : {std::size_t{8}, std::size_t{100}, whole.size() / 2, whole.size() - 1}) {
    folder_.write("bad.h5", whole.substr(0, size));
    expect_refused_by_all("bad.h5", "bad.h5");
  }
}

TEST_F(BadSolutions, FlippedBytesNeverCrash) {
  const std::string whole = read_bytes(folder_ / "room.h5");
  for (std::size_t part = 1; part <= 24; ++part) {
    std::string damaged = whole;
    damaged[whole.size() * part / 25] ^= static_cast<char>(0xff);
    folder_.write("bad.h5", damaged);
    const int code = run_reemit({"audit", (folder_ / "bad.h5").string()}).exit_code;
    EXPECT_TRUE(code >= 0 && code <= 2) << "byte " << whole.size() * part / 25 << " ends with " << code;
  }
}

TEST_F(BadSolutions, OtherVersion) {
  std::filesystem::copy_file(folder_ / "room.h5", folder_ / "bad.h5");
  const hid_t file = H5Fopen((folder_ / "bad.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t attribute = H5Aopen(file, "format_version", H5P_DEFAULT);
  ASSERT_GE(attribute, 0);
  const unsigned version = 4711;
  EXPECT_GE(H5Awrite(attribute, H5T_NATIVE_UINT, &version), 0);
  H5Aclose(attribute);
  H5Fclose(file);
  const std::string changed = read_bytes(folder_ / "bad.h5");
  expect_refused_by_all("bad.h5", "changed");  // the seal is gone
  folder_.write("bad.h5", changed + seal_of(changed));
  expect_refused_by_all("bad.h5", "4711");
}

TEST_F(BadSolutions, RoomHasChanged) {
  folder_.write("room.json", replaced(small_json_room(), "0.5}", "0.6}"));
  const std::string solution = (folder_ / "room.h5").string();
  expect_refused({"render", solution, "-o", (folder_ / "out.png").string()}, "changed");
  expect_refused({"export", solution, "-o", (folder_ / "out.csv").string()}, "changed");
  const ProgramRun info = run_reemit({"info", solution});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("changed"));
  EXPECT_EQ(run_reemit({"audit", solution}).exit_code, 0) << "the audit needs no room";
}

TEST_F(BadSolutions, RoomIsGone) {
  std::filesystem::rename(folder_ / "room.json", folder_ / "moved.json");
  const std::string solution = (folder_ / "room.h5").string();
  const std::string picture = (folder_ / "out.png").string();
  expect_refused({"render", solution, "-o", picture}, "room.json");
  const ProgramRun run = run_reemit(
      {"render", solution, "--room", (folder_ / "moved.json").string(), "-o", picture, "--spp", "1"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(picture));
}

}  // namespace
}  // namespace reemit::test
