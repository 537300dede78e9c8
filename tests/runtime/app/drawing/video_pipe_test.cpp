// Videos, and what ffmpeg may do to them.
#include "drawing/video_pipe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "picture_folder.h"
#include "support/file_content.h"
#include "support/files/part_files.h"
#include "support/program_run.h"

namespace galactic::video_pipe_test {
namespace {

using pictures::Image;
using testing::ElementsAre;
using testing::HasSubstr;

class Videos : public test::PictureFolder {};

TEST_F(Videos, AVideoNeedsFfmpegAndSaysSo) {
  usePath(file("nothing"));
  const auto video = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(video.error().message,
            "needs ffmpeg, which is not on PATH; install it, or take --frames instead");
}

TEST_F(Videos, AnFfmpegInAFolderThatMayNotBeLookedIntoIsNone) {
  // Starting a folder is refused as looking into a closed one is, of root, too.
  std::filesystem::create_directories(file("closed/ffmpeg"));
  usePath(file("closed"));
  const auto video = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(video.error().message, HasSubstr("needs ffmpeg, which is not on PATH"));
  // One that is there and may not be started is another matter.
  fakeFfmpeg("");
  std::filesystem::permissions(file("bin/ffmpeg"), std::filesystem::perms::owner_read);
  usePath(file("closed") + ":" + file("bin"));
  const auto refused = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "cannot start ffmpeg: Permission denied");
}

TEST_F(Videos, AnFfmpegThatEndsEarlyIsAnErrorAndLeavesNothing) {
  fakeFfmpeg("for last; do :; done\nhead -c 1000 > \"$last\"\nexit 3\n");
  auto video = VideoPipe::start(file("run.mp4"), Image(256, 256, {}));
  ASSERT_TRUE(video);
  Result<void> sent;
  for (int frame = 0; frame < 1000 && sent; ++frame) sent = video->append(Image(256, 256, {}));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().code, ErrorCode::kIo);
  EXPECT_EQ(sent.error().message,
            "ffmpeg ended with code 3 before the video was whole; what it says stands above");
  EXPECT_THAT(files("."), ElementsAre("bin"));
}

TEST_F(Videos, AnFfmpegThatEndsBeforeItHasReadAFrameIsTheSameError) {
  // Longer than it takes to fill the socket, with frames so small that none is sent in parts: the
  // next one waits, and is reset.
  fakeFfmpeg("sleep 0.2\nexit 4\n");
  const Image frame(64, 64, {});
  auto video = VideoPipe::start(file("run.mp4"), frame);
  ASSERT_TRUE(video);
  Result<void> sent;
  for (int n = 0; n < 1000 && sent; ++n) sent = video->append(frame);
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().message,
            "ffmpeg ended with code 4 before the video was whole; what it says stands above");
  EXPECT_THAT(files("."), ElementsAre("bin"));
}

TEST_F(Videos, AVideoGrowsUnderANameOfItsOwnAndRemovesWhatKilledRunsLeft) {
  keepingFfmpeg();
  static_cast<void>(folder_.write("run.partial.mp4", "another video"));
  const auto part = partPathOf("run.mp4", 7, PartEnding::kOfTarget).string();
  static_cast<void>(folder_.write(part, "half"));
  auto video = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
  ASSERT_TRUE(video);
  auto second = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
  ASSERT_TRUE(second);
  ASSERT_TRUE(video->append(Image(2, 2, {})));
  ASSERT_TRUE(video->finish());
  EXPECT_EQ(test::fileContent(file("run.mp4")).size(), 12U);
  ASSERT_TRUE(second->append(Image(2, 2, {})));
  ASSERT_TRUE(second->append(Image(2, 2, {})));
  ASSERT_TRUE(second->finish());
  EXPECT_EQ(test::fileContent(file("run.mp4")).size(), 24U);
  EXPECT_EQ(test::fileContent(file("run.partial.mp4")), "another video");
  EXPECT_THAT(files("."), ElementsAre("arguments", "bin", "run.mp4", "run.partial.mp4"));
}

TEST_F(Videos, AVideoWhereNothingCanBeWrittenIsAnError) {
  keepingFfmpeg();
  const auto video = VideoPipe::start(file("none/run.mp4"), Image(2, 2, {}));
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().code, ErrorCode::kIo);
  EXPECT_EQ(video.error().message, "cannot be written: No such file or directory");
}

TEST_F(Videos, AnFfmpegThatFailsAtTheEndIsAnErrorToo) {
  fakeFfmpeg("cat > /dev/null\nexit 1\n");
  auto video = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
  ASSERT_TRUE(video);
  ASSERT_TRUE(video->append(Image(2, 2, {})));
  const auto finished = video->finish();
  ASSERT_FALSE(finished);
  EXPECT_THAT(finished.error().message, HasSubstr("ffmpeg ended with code 1"));
}

TEST_F(Videos, AVideoThatIsGivenUpLeavesTheOldOne) {
  keepingFfmpeg();
  static_cast<void>(folder_.write("run.mp4", "old"));
  {
    auto video = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
    ASSERT_TRUE(video);
    ASSERT_TRUE(video->append(Image(2, 2, {})));
  }
  EXPECT_EQ(test::fileContent(file("run.mp4")), "old");
  EXPECT_THAT(files("."), ElementsAre("arguments", "bin", "run.mp4"));
}

}  // namespace
}  // namespace galactic::video_pipe_test
