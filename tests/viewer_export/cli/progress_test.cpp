#include "viewer_export/cli/progress.h"

#include <chrono>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reemit::cli {
namespace {

using ::testing::HasSubstr;

std::string said(auto&& work) {
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, SaysWhatIsDoneAndHowMuchOfIt) {
  EXPECT_EQ(said([] {
              Progress progress("solving", ProgressStyle::kLines);
              progress.update(0.37, "error 2 %", 21);
            }),
            "solving  37 %, error 2 %, 21 s left\n");
}

TEST(Progress, AStepIsSaidHoweverShortTheOneBeforeWas) {
  const std::string text = said([] {
    Progress progress("solving", ProgressStyle::kLines);
    progress.begin_step(0, "first batch");
    progress.update(0.5, "lost between the two");
    progress.begin_step(1, "looking at how good it is");
  });
  EXPECT_EQ(text, "solving   0 %, first batch\nsolving 100 %, looking at how good it is\n");
}

TEST(Progress, ShortWorkIsNotWorthALine) {
  EXPECT_EQ(said([] {
              Progress progress("meshing", ProgressStyle::kLines, 3600);
              progress.update(0.5);
            }),
            "");
  EXPECT_EQ(said([] { const WaitingLine line("reading hall.obj", ProgressStyle::kLines); }), "");
}

TEST(Progress, LongWorkThatNobodyCanMeasureSaysThatItGoesOn) {
  const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(2500)); };
  EXPECT_THAT(said([&] {
                const WaitingLine line("reading hall.obj", ProgressStyle::kLine);
                wait();
              }),
              HasSubstr("reading hall.obj, 1 s"));
  EXPECT_EQ(said([&] {
              const WaitingLine line("reading hall.obj", ProgressStyle::kSilent);
              wait();
            }),
            "");
}

}  // namespace
}  // namespace reemit::cli
