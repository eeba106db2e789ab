#include "scenes/io/common/output_file.h"

#include <csignal>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenes/model/error.h"
#include "tests/support/small_disk.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using test::read_bytes;
using test::SmallDisk;
using test::TempFolder;
using test::write_bytes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(OutputFile, AppearsOnlyWhenCommitted) {
  const TempFolder folder;
  const auto target = folder / "a.txt";
  write_bytes(target, "old");
  OutputFile file(target);
  file.write("new ");
  file.write("text");
  EXPECT_EQ(read_bytes(target), "old");
  file.commit();
  EXPECT_EQ(read_bytes(target), "new text");
  EXPECT_EQ(folder.listing().size(), 1U);
}

TEST(OutputFile, LeavesNothingBehindWithoutCommit) {
  const TempFolder folder;
  {
    OutputFile file(folder / "a.txt");
    file.write("half");
    EXPECT_EQ(folder.listing().size(), 1U);
  }
  EXPECT_EQ(folder.listing().size(), 0U);
}

TEST(OutputFile, WritesAtOffsetsAfterAppending) {
  const TempFolder folder;
  OutputFile file(folder / "a.txt");
  file.write("0123456789");
  file.write_at(3, "abc", 3);
  file.commit();
  EXPECT_EQ(read_bytes(folder / "a.txt"), "012abc6789");
}

TEST(OutputFile, ReplacesTheFileBehindALink) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "real");
  write_bytes(folder / "real/a.txt", "old");
  std::filesystem::create_symlink("real/a.txt", folder / "link.txt");
  OutputFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_bytes(folder / "real/a.txt"), "new");
}

TEST(OutputFile, KeepsThePermissionsOfTheFileItReplaces) {
  const TempFolder folder;
  const auto target = folder / "a.txt";
  write_bytes(target, "old");
  ASSERT_EQ(chmod(target.c_str(), 0640), 0);
  OutputFile file(target);
  file.commit();
  struct stat status {};
  ASSERT_EQ(stat(target.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640U);
}

TEST(OutputFile, AFolderThatTakesNoFilesIsNotCalledMissing) {
  EXPECT_THAT([] { OutputFile file("/proc/a.txt"); },
              ThrowsMessage<ResourceError>(HasSubstr("no file can be created in '/proc'")));
  EXPECT_THAT([] { OutputFile file("/proc/none/a.txt"); },
              ThrowsMessage<ResourceError>(HasSubstr("there is no folder '/proc/none'")));
}

TEST(OutputFile, FullDiskKeepsThePreviousFile) {
  const TempFolder folder;
  const auto target = folder / "a.txt";
  write_bytes(target, "old");
  {
    const SmallDisk disk(100'000);
    const std::string much(3'000'000, 'x');
    EXPECT_THROW(
        {
          OutputFile file(target);
          file.write(much);
          file.commit();
        },
        ResourceError);
  }
  EXPECT_EQ(read_bytes(target), "old");
  EXPECT_EQ(folder.listing().size(), 1U);
}

TEST(OutputFile, TwoFilesOfOneNameDoNotMeet) {
  const TempFolder folder;
  OutputFile first(folder / "a.txt");
  OutputFile second(folder / "a.txt");
  first.write("first");
  second.write("second");
  first.commit();
  EXPECT_EQ(read_bytes(folder / "a.txt"), "first");
  second.commit();
  EXPECT_EQ(read_bytes(folder / "a.txt"), "second");
  EXPECT_EQ(folder.listing().size(), 1U);
}

TEST(OutputFile, RemovesWhatKilledRunsLeft) {
  const TempFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    OutputFile file(folder / "a.txt");
    file.write("half");
    raise(SIGKILL);
  }
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  ASSERT_EQ(folder.listing(), std::vector<std::string>{fmt::format("a.txt.{}.partial", child)});
  // Files of others, however alike.
  write_bytes(folder / "a.txt.partial", "");
  write_bytes(folder / "a.txt.draft.partial", "");
  write_bytes(folder / "b.a.txt.123.partial", "");
  OutputFile(folder / "a.txt").commit();
  EXPECT_THAT(folder.listing(),
              ElementsAre("a.txt", "a.txt.draft.partial", "a.txt.partial", "b.a.txt.123.partial"));
}

TEST(CheckWritable, AcceptsNewAndExistingFilesWithoutTouchingThem) {
  const TempFolder folder;
  check_writable(folder / "new.txt");
  EXPECT_EQ(folder.listing().size(), 0U);
  write_bytes(folder / "old.txt", "old");
  check_writable(folder / "old.txt");
  EXPECT_EQ(read_bytes(folder / "old.txt"), "old");
}

TEST(CheckWritable, RefusesWhatCannotBeWritten) {
  const TempFolder folder;
  write_bytes(folder / "file", "");
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_THAT([&] { check_writable(folder / "nowhere/a.txt"); },
              ThrowsMessage<ResourceError>(HasSubstr("Create it first")));
  EXPECT_THAT([&] { check_writable(folder.path()); }, ThrowsMessage<ResourceError>(HasSubstr("is a folder")));
  EXPECT_THAT([&] { check_writable("/dev/null"); },
              ThrowsMessage<ResourceError>(HasSubstr("not a regular file")));
  EXPECT_THROW(check_writable(folder / "file/a.txt"), ResourceError);
  EXPECT_THROW(check_writable(folder / "loop"), ResourceError);
  EXPECT_THROW(check_writable("/proc/a.txt"), ResourceError);
  EXPECT_THROW(check_writable(""), ResourceError);
}

}  // namespace
}  // namespace reemit
