// Outputs that cannot be written: exit code 2, a message that names them, and nothing left behind.
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/solved_room.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// One way to ask each subcommand that writes for an output.
struct Writer {
  std::vector<std::string> command;
  std::string extension;
  std::string option = "-o";
};

std::vector<Writer> writers(const TempFolder& folder) {
  const std::string solution = (folder / "room.h5").string();
  return {{{"solve", (folder / "room.json").string(), "--packets", "1000"}, ".h5"},
          {{"render", solution, "--size", "8x8", "--spp", "1"}, ".exr"},
          {{"render", solution, "--size", "8x8", "--spp", "1"}, ".hdr"},
          {{"render", solution, "--size", "8x8", "--spp", "1"}, ".png"},
          {{"export", solution, "--values", "zones"}, ".ply"},
          {{"export", solution, "--values", "zones"}, ".glb"},
          {{"export", solution, "--values", "zones"}, ".csv"},
          {{"info", (folder / "room.json").string()}, ".glb", "--report"}};
}

ProgramRun write_to(const Writer& writer, const std::string& output, const RunOptions& options = {}) {
  std::vector<std::string> arguments = writer.command;
  arguments.insert(arguments.end(), {writer.option, output});
  return run_reemit(arguments, options);
}

class BadOutputs : public ::testing::Test {
 protected:
  BadOutputs() {
    folder_.write("room.json", small_json_room());
    solve_small_room(folder_, "room.h5");
  }

  void expect_refused(const Writer& writer, const std::string& output, const std::string& word,
                      const RunOptions& options = {}) {
    const std::vector<std::string> before = folder_.listing();
    const ProgramRun run = write_to(writer, output, options);
    EXPECT_EQ(run.exit_code, 2) << output << ": " << run.err;
    EXPECT_THAT(run.out, IsEmpty()) << output;
    EXPECT_THAT(run.err, HasSubstr("reemit: error: ")) << output;
    EXPECT_THAT(run.err, HasSubstr(word)) << output;
    EXPECT_EQ(folder_.listing(), before) << output << ": something was left behind";
  }

  TempFolder folder_;
};

TEST_F(BadOutputs, MissingFolder) {
  for (const Writer& writer : writers(folder_)) {
    const std::string output = (folder_ / "nowhere").string() + "/out" + writer.extension;
    expect_refused(writer, output, "nowhere");
  }
}

TEST_F(BadOutputs, ParentIsAFile) {
  for (const Writer& writer : writers(folder_)) {
    const std::string output = (folder_ / "room.json").string() + "/out" + writer.extension;
    expect_refused(writer, output, "room.json/out");
  }
}

TEST_F(BadOutputs, ReadOnlyFileSystem) {
  for (const Writer& writer : writers(folder_))
    expect_refused(writer, "/proc/out" + writer.extension, "/proc/out");
}

TEST_F(BadOutputs, OutputIsAFolder) {
  std::filesystem::create_directory(folder_ / "folder.h5");
  std::filesystem::create_directory(folder_ / "folder.ply");
  const std::vector<Writer> all = writers(folder_);
  expect_refused(all.front(), (folder_ / "folder.h5").string(), "is a directory");
  expect_refused({{"export", (folder_ / "room.h5").string()}, ".ply"}, (folder_ / "folder.ply").string(),
                 "is a directory");
}

TEST_F(BadOutputs, DeviceIsNotReplaced) {
  const std::vector<Writer> all = writers(folder_);
  expect_refused(all.front(), "/dev/full", "not a regular file");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(BadOutputs, InputIsNotOverwritten) {
  const std::string room = read_bytes(folder_ / "room.json");
  expect_refused({{"solve", (folder_ / "room.json").string()}, ""}, (folder_ / "room.json").string(),
                 "input file");
  EXPECT_EQ(read_bytes(folder_ / "room.json"), room);
  // The solution under a name of a format that could be written.
  std::filesystem::copy_file(folder_ / "room.h5", folder_ / "solution.ply");
  const std::string solution = (folder_ / "solution.ply").string();
  expect_refused({{"export", solution, "--values", "zones"}, ""}, solution, "input file");
}

TEST_F(BadOutputs, FullDiskKeepsThePreviousFile) {
  RunOptions full_disk;
  full_disk.largest_file = 200;
  for (const Writer& writer : writers(folder_)) {
    const std::string before = read_bytes(folder_ / "room.h5");
    const std::string output = folder_.write("old" + writer.extension, before).string();
    expect_refused(writer, output, "old" + writer.extension, full_disk);
    EXPECT_TRUE(read_bytes(output) == before) << writer.extension;
  }
}

TEST_F(BadOutputs, FullStandardOutput) {
  RunOptions options;
  options.stdout_path = "/dev/full";
  for (const char* command : {"audit", "info"}) {
    const ProgramRun run = run_reemit({command, (folder_ / "room.h5").string()}, options);
    EXPECT_EQ(run.exit_code, 2) << command;
    EXPECT_THAT(run.err, HasSubstr("cannot write")) << command;
  }
}

TEST_F(BadOutputs, StandardErrorThatTakesNothingCostsNoResult) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  int pipe[2];
  ASSERT_EQ(::pipe2(pipe, O_CLOEXEC), 0);
  ::close(pipe[0]);  // the reader has left
  folder_.write("warns.json", replaced(small_json_room(), "[1, 1, 1]", "[300, 1, 1]"));
  for (const int descriptor : {full, pipe[1], -1}) {
    RunOptions options;
    options.stderr_descriptor = descriptor;
    const std::filesystem::path solution = folder_ / "out.h5";
    const ProgramRun run = run_reemit(
        {"solve", (folder_ / "warns.json").string(), "-o", solution.string(), "--packets", "1000", "-v"},
        options);
    EXPECT_EQ(run.exit_code, 0) << descriptor;
    EXPECT_THAT(run.out, HasSubstr("stopped:")) << descriptor;
    EXPECT_TRUE(std::filesystem::remove(solution)) << descriptor;
    // An error is told by the exit code at least.
    options.stdout_path = "/dev/full";
    EXPECT_EQ(run_reemit({"--version"}, options).exit_code, 2) << descriptor;
  }
  ::close(full);
  ::close(pipe[1]);
}

TEST_F(BadOutputs, SolveReplacesSolutionsOnly) {
  const Writer solve = writers(folder_).front();
  for (const char* name : {"lamp.glb", "other.json", "out", "out.h5.txt"}) {
    const std::filesystem::path file = folder_.write(name, "of somebody");
    expect_refused(solve, file.string(), ".h5 or .hdf5");
    EXPECT_EQ(read_bytes(file), "of somebody");
  }
  const std::filesystem::path measured = folder_.write("measured.h5", "\x89HDF\r\n\x1a\n of somebody");
  expect_refused(solve, measured.string(), "is not a solution");
  EXPECT_EQ(read_bytes(measured), "\x89HDF\r\n\x1a\n of somebody");

  EXPECT_EQ(write_to(solve, (folder_ / "room.h5").string()).exit_code, 0);
  EXPECT_EQ(write_to(solve, folder_.write("empty.HDF5", "").string()).exit_code, 0);
}

TEST_F(BadOutputs, ExportDoesNotReplaceTheRoom) {
  const std::filesystem::path room = folder_.write("square.glb", small_glb_room());
  const std::string solution = (folder_ / "square.h5").string();
  ASSERT_EQ(run_reemit({"solve", room.string(), "-o", solution, "--packets", "1000"}).exit_code, 0);
  expect_refused({{"export", solution, "--values", "zones"}, ""}, room.string(), "the room is made of");
  EXPECT_EQ(read_bytes(room), small_glb_room());
}

TEST_F(BadOutputs, FilesThatARoomNamesAreNotReplaced) {
  const std::filesystem::path part = folder_.write("part.glb", small_glb_room());
  const std::string room = folder_
                               .write("parts.json", R"({"format": "reemit-room", "version": 1,
 "materials": {"grey": {"reflectance": 0.5}}, "objects": [{"material": "grey", "file": {"path": "part.glb"}}],
 "lights": [{"type": "point", "position": [0.5, 0.5, 1], "power": 1}]})")
                               .string();
  const std::string solution = (folder_ / "parts.h5").string();
  ASSERT_EQ(run_reemit({"solve", room, "-o", solution, "--packets", "1000"}).exit_code, 0);
  expect_refused({{"export", solution, "--values", "zones"}, ""}, part.string(), "the room is made of");
  // A picture over an image: by another name of the file, the link that is beside it.
  std::filesystem::create_symlink(part, folder_ / "picture.png");
  expect_refused({{"render", solution, "--size", "8x8", "--spp", "1"}, ""},
                 (folder_ / "picture.png").string(), "the room is made of");
  EXPECT_EQ(read_bytes(part), small_glb_room());
}

}  // namespace
}  // namespace reemit::test
