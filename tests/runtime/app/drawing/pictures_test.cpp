// What galactic-run makes of the images of a run: pictures, sheets, frames and videos.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "drawing/contact_sheet.h"
#include "drawing/frame_images.h"
#include "drawing/picture_output.h"
#include "drawing/rendering.h"
#include "drawing/video_pipe.h"
#include "galactic/world_views.h"
#include "pictures/drawing.h"
#include "pictures/palette.h"
#include "support/homes/small_home.h"
#include "support/homes/small_home_models.h"
#include "support/part_files.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::pictures_test {
namespace {

using pictures::Image;
using pictures::Rgb;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

/// Memory for a small image of all kinds.
struct SmallImage {
  std::vector<std::uint8_t> color{10, 20, 30, 255, 40, 50, 60, 255};
  std::vector<float> depth{2, 0};
  std::vector<std::uint32_t> semantics{7, 0};

  /// 2 x 1 pixels.
  [[nodiscard]] DrawnImage image() const {
    return {2, 1, ColorFormat::kRgba8, color, depth, semantics};
  }
  [[nodiscard]] EnvFrame frame() const { return {image(), std::nullopt}; }
};

TEST(FrameImages, ColorsAreTakenAsTheyAre) {
  const SmallImage small;
  const Image rgba = colorPicture(small.image());
  EXPECT_EQ(rgba.width(), 2);
  EXPECT_EQ(rgba.height(), 1);
  EXPECT_EQ(rgba.at(0, 0), (Rgb{10, 20, 30}));
  EXPECT_EQ(rgba.at(1, 0), (Rgb{40, 50, 60}));
  const std::vector<std::uint8_t> packed{1, 2, 3, 4, 5, 6};
  const Image rgb = colorPicture({2, 1, ColorFormat::kRgb8, packed, {}, {}});
  EXPECT_EQ(rgb.at(1, 0), (Rgb{4, 5, 6}));
}

TEST(FrameImages, DepthIsBrightWhereItIsNearAndBlackWhereNothingIs) {
  std::vector<float> depth{1e-6F, kHalfBright, 6, 0};
  const Image picture = depthPicture({4, 1, ColorFormat::kNone, {}, depth, {}});
  EXPECT_EQ(picture.at(0, 0), (Rgb{255, 255, 255}));
  EXPECT_EQ(picture.at(1, 0), (Rgb{128, 128, 128}));
  EXPECT_EQ(picture.at(2, 0), (Rgb{64, 64, 64}));
  EXPECT_EQ(picture.at(3, 0), (Rgb{}));
}

TEST(FrameImages, DepthNumbersAreMillimeters) {
  const std::vector<float> depth{0, 0.0004F, 0.0006F, 1.2345F, 65.534F, 65.5351F, 1e9F};
  const auto numbers = depthNumbers({7, 1, ColorFormat::kNone, {}, depth, {}});
  EXPECT_THAT(numbers.pixels, ElementsAre(0, 0, 1, 1235, 65534, 65535, 65535));
}

TEST(FrameImages, IdsHaveNumbersAndColorsOfTheirOwn) {
  const std::vector<std::uint32_t> ids{0, 1, 2, 70000};
  const DrawnImage image{4, 1, ColorFormat::kNone, {}, {}, ids};
  EXPECT_THAT(semanticNumbers(image).pixels, ElementsAre(0, 1, 2, 65535));
  const Image picture = semanticPicture(image);
  EXPECT_EQ(picture.at(0, 0), (Rgb{}));
  EXPECT_FALSE(picture.at(1, 0) == picture.at(2, 0));
  EXPECT_GE(picture.at(1, 0).r, 64);
}

TEST(ContactSheet, PutsCellsInRowsWithTheirCaptionsBelow) {
  const Image red(3, 2, {255, 0, 0});
  const Image blue(3, 2, {0, 0, 255});
  const Image sheet = contactSheet({{red, "I"}, {blue, ""}, {red, ""}}, 2);
  // A letter is wider than the pictures: 5 x 7 font pixels.
  const int width = pictures::textWidth("I") + kCaptionGap - kSheetGap;
  const int height = 2 + kSheetGap + pictures::kTextHeight;
  EXPECT_EQ(sheet.width(), 3 * kSheetGap + 2 * width);
  EXPECT_EQ(sheet.height(), 3 * kSheetGap + 2 * height);
  const int left = 2 * kSheetGap + width;
  const int top = 2 * kSheetGap + height;
  EXPECT_EQ(sheet.at(kSheetGap, kSheetGap), red.at(0, 0));
  EXPECT_EQ(sheet.at(kSheetGap + 2, kSheetGap + 1), red.at(0, 0));
  EXPECT_EQ(sheet.at(kSheetGap + 3, kSheetGap), pictures::kPaper);
  EXPECT_EQ(sheet.at(kSheetGap, kSheetGap + 2), pictures::kPaper);
  EXPECT_EQ(sheet.at(left, kSheetGap), blue.at(0, 0));
  EXPECT_EQ(sheet.at(kSheetGap, top), red.at(0, 0));
  EXPECT_EQ(sheet.at(left, top), pictures::kPaper);
  // The top bar of the letter.
  EXPECT_EQ(sheet.at(kSheetGap + pictures::kTextScale, kSheetGap + 2 + kSheetGap / 2),
            pictures::kInk);
}

TEST(ContactSheet, BreaksCaptionsThatAreWiderThanTheirPictures) {
  constexpr int kWidth = 128;
  const Image grey(kWidth, 4, {90, 90, 90});
  const auto sheet_of = [&grey](const std::string& caption) {
    return contactSheet({{grey, caption}, {grey, caption}}, 2);
  };
  const Image one_line = sheet_of("env 0");
  EXPECT_EQ(one_line.width(), 3 * kSheetGap + 2 * kWidth);
  EXPECT_EQ(one_line.height(), 3 * kSheetGap + 4 + pictures::kTextHeight);
  ASSERT_GT(pictures::textWidth("env 0 step 0"), kWidth);
  const Image two_lines = sheet_of("env 0 step 0");
  EXPECT_EQ(two_lines.width(), one_line.width());
  EXPECT_EQ(two_lines.height(), one_line.height() + kCaptionAdvance);
  // Both lines have ink, and between the captions there is none.
  const auto inked = [](const Image& sheet, const pictures::PixelRect& part) {
    for (int y = part.y; y < part.bottom(); ++y) {
      for (int x = part.x; x < part.right(); ++x) {
        if (sheet.at(x, y) == pictures::kInk) return true;
      }
    }
    return false;
  };
  const int first = kSheetGap + 4 + kSheetGap / 2;
  EXPECT_TRUE(inked(two_lines, {kSheetGap, first, kWidth, pictures::kTextHeight}));
  EXPECT_TRUE(
      inked(two_lines, {kSheetGap, first + kCaptionAdvance, kWidth, pictures::kTextHeight}));
  // A word that is wider yet makes the cells wider, and leaves a gap.
  const std::string word(12, 'W');
  const Image wide = sheet_of(word);
  const int right_of_word = kSheetGap + pictures::textWidth(word);
  EXPECT_EQ(wide.height(), one_line.height());
  EXPECT_TRUE(inked(wide, {right_of_word - 2, 0, 2, wide.height()}));
  EXPECT_FALSE(inked(wide, {right_of_word, 0, kCaptionGap, wide.height()}));
  EXPECT_TRUE(inked(wide, {right_of_word + kCaptionGap, 0, 2, wide.height()}));
}

/// The steps that a sheet shows of a run of `planned` steps that ends after `done`.
std::vector<std::uint64_t> stepsOnSheet(std::uint64_t planned, std::uint64_t done,
                                        std::uint64_t every = 1) {
  SheetMoments sheet(planned, every);
  std::size_t held = 0;
  for (std::uint64_t step = 0; step <= done; ++step) {
    if (step != done && !sheet.wants(step)) continue;
    sheet.add({step, {{Image(1, 1, {}), "env 0"}}});
    ++held;
  }
  EXPECT_LT(held, 200U) << "few states are copied";
  std::vector<std::uint64_t> steps;
  for (const SheetMoments::Moment& moment : sheet.take()) {
    EXPECT_EQ(moment.cells.size(), 1U);
    steps.push_back(moment.step);
  }
  return steps;
}

TEST(SheetMoments, AreThePlannedOnesOfARunThatDoesAllItsSteps) {
  EXPECT_THAT(stepsOnSheet(1000, 1000), ElementsAre(0, 200, 400, 600, 800, 1000));
  EXPECT_THAT(stepsOnSheet(3, 3), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(stepsOnSheet(1, 1), ElementsAre(0, 1));
  // The last state is shown wherever the run ends.
  EXPECT_THAT(stepsOnSheet(20, 20, 8), ElementsAre(0, 8, 16, 20));
  EXPECT_THAT(stepsOnSheet(5, 5, 100), ElementsAre(0, 5));
}

TEST(SheetMoments, AreEvenlySpreadWhereverARunEnds) {
  for (const std::uint64_t planned : {1000U, 5000U, 1000000000U}) {
    for (const std::uint64_t done : {0U, 4U, 5U, 13U, 24U, 25U, 41U, 369U, 370U, 999U}) {
      SCOPED_TRACE(std::to_string(done) + " of " + std::to_string(planned));
      const std::vector<std::uint64_t> steps = stepsOnSheet(planned, done);
      ASSERT_EQ(steps.size(), std::min<std::uint64_t>(done + 1, SheetMoments::kMost));
      EXPECT_EQ(steps.front(), 0U);
      EXPECT_EQ(steps.back(), done);
      // A moment is held at least each twelfth part of the run.
      for (std::size_t row = 1; row < steps.size(); ++row) {
        const double wanted = static_cast<double>(row * done) / 5;
        const double off = static_cast<double>(steps[row]) - wanted;
        EXPECT_LT(steps[row - 1], steps[row]);
        if (done < 5) continue;
        EXPECT_LE(std::abs(off), static_cast<double>(done) / 24 + 0.5);
      }
    }
  }
}

TEST(PictureOutput, ATileHasColorDepthIdsAndDebugSideBySide) {
  const SmallImage small;
  EnvFrame frame = small.frame();
  const Image tile = tileOf(frame);
  EXPECT_EQ(tile.width(), 3 * 2 + 2 * 2);
  EXPECT_EQ(tile.height(), 1);
  EXPECT_EQ(tile.at(1, 0), (Rgb{40, 50, 60}));
  EXPECT_EQ(tile.at(4, 0), (Rgb{128, 128, 128}));
  EXPECT_EQ(tile.at(9, 0), (Rgb{}));
  frame.debug = DrawnImage{2, 1, ColorFormat::kRgba8, small.color, {}, {}};
  EXPECT_EQ(tileOf(frame).width(), 4 * 2 + 3 * 2);
  EXPECT_EQ(tileOf(frame).at(12, 0), (Rgb{10, 20, 30}));
}

/// A folder for pictures, and a PATH on which this test decides what there is.
class Pictures : public testing::Test {
 protected:
  void SetUp() override {
    path_before_ = std::getenv("PATH");
    usePath(folder_.path().string() + "/bin:/usr/bin:/bin");
  }
  void TearDown() override { usePath(path_before_); }

  static void usePath(const std::string& path) { ::setenv("PATH", path.c_str(), 1); }

  /// A program "ffmpeg" of these shell commands.
  void fakeFfmpeg(const std::string& commands) const {
    const auto file = folder_.write("bin/ffmpeg", "#!/bin/sh\n" + commands);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  /// One that keeps its arguments and what it is sent.
  void keepingFfmpeg() const {
    fakeFfmpeg("for last; do :; done\necho \"$@\" > '" + file("arguments") +
               "'\ncat > \"$last\"\n");
  }

  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / folder)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  [[nodiscard]] static DrawingOptions smallOptions() {
    DrawingOptions options;
    options.images = "rgbds";
    options.width = 2;
    options.height = 1;
    options.frame_envs = 2;
    return options;
  }

  test::ScratchFolder folder_;
  std::string path_before_;
};

TEST_F(Pictures, FramesAreNamedByEnvAndStep) {
  DrawingOptions options = smallOptions();
  options.frames = file("deep/frames");
  options.frame_every = 60;
  ASSERT_TRUE(makeFrameFolder(options.frames));
  auto output = PictureOutput::open(options, {120, 5});
  ASSERT_TRUE(output) << output.error().message;
  EXPECT_EQ(output->envCount(), 2U);
  EXPECT_TRUE(output->wants(0));
  EXPECT_FALSE(output->wants(59));
  EXPECT_TRUE(output->wants(120));
  const SmallImage small;
  EnvFrame with_debug = small.frame();
  with_debug.seen_from.world_from_camera.origin = {4, 5, 6};
  with_debug.debug = DrawnImage{2, 1, ColorFormat::kRgba8, small.color, {}, {}};
  ASSERT_TRUE(output->add(120, std::vector{small.frame(), with_debug}));
  ASSERT_TRUE(output->finish());
  EXPECT_THAT(files("deep/frames"),
              ElementsAre("env_0000_step_000120_camera.json", "env_0000_step_000120_depth.png",
                          "env_0000_step_000120_rgb.png", "env_0000_step_000120_semantic.png",
                          "env_0001_step_000120_camera.json", "env_0001_step_000120_debug.png",
                          "env_0001_step_000120_depth.png", "env_0001_step_000120_rgb.png",
                          "env_0001_step_000120_semantic.png"));
  EXPECT_EQ(test::fileContent(options.frames + "/env_0001_step_000120_camera.json"),
            "{\n  \"intrinsics\": [[0.5, 0, 1], [0, 0.5, 0.5], [0, 0, 1]],\n"
            "  \"world_from_camera\": "
            "[[0, -0, 1, 4], [0, -1, 0, 5], [1, -0, 0, 6], [0, 0, 0, 1]]\n}\n");
}

TEST_F(Pictures, ASheetShowsSixMomentsFromTheFirstToTheLast) {
  DrawingOptions options = smallOptions();
  options.contact_sheet = file("sheet.png");
  const SmallImage small;
  const std::vector<EnvFrame> frames{small.frame(), small.frame()};
  const auto height_of = [&](std::uint64_t steps, std::uint64_t done) {
    auto output = PictureOutput::open(options, {steps, 2});
    EXPECT_TRUE(output);
    for (std::uint64_t step = 0; step < done; ++step) {
      if (!output->wants(step)) continue;
      EXPECT_TRUE(output->add(step, frames));
    }
    EXPECT_TRUE(output->wantsLast(done));
    EXPECT_TRUE(output->addLast(done, frames));
    EXPECT_TRUE(output->finish());
    const std::string png = test::fileContent(options.contact_sheet);
    return static_cast<unsigned char>(png[22]) * 256 + static_cast<unsigned char>(png[23]);
  };
  const int row = 1 + kSheetGap + pictures::kTextHeight + kCaptionAdvance + kSheetGap;
  EXPECT_EQ(height_of(100, 100), kSheetGap + 6 * row);
  EXPECT_EQ(height_of(3, 3), kSheetGap + 4 * row);
  // Runs that were stopped.
  EXPECT_EQ(height_of(100, 41), kSheetGap + 6 * row);
  EXPECT_EQ(height_of(1000000, 41), kSheetGap + 6 * row);
  EXPECT_EQ(height_of(1000000, 0), kSheetGap + 1 * row);
}

TEST_F(Pictures, ASheetSaysWhichEnvsAreIdle) {
  DrawingOptions options = smallOptions();
  options.contact_sheet = file("sheet.png");
  const SmallImage small;
  EnvFrame idle = small.frame();
  idle.is_idle = true;
  auto output = PictureOutput::open(options, {7, 2});
  ASSERT_TRUE(output) << output.error().message;
  ASSERT_TRUE(output->add(0, std::vector{small.frame(), small.frame()}));
  ASSERT_TRUE(output->addLast(3, std::vector{small.frame(), idle}));
  ASSERT_TRUE(output->finish());
  const Image tile = tileOf(idle);
  const Image wanted = contactSheet({{tile, "env 0 step 0"},
                                     {tile, "env 1 step 0"},
                                     {tile, "env 0 step 3"},
                                     {tile, "env 1 (idle) step 3"}},
                                    2);
  ASSERT_TRUE(pictures::writePng(file("wanted.png"), wanted));
  EXPECT_TRUE(test::fileContent(options.contact_sheet) == test::fileContent(file("wanted.png")));
}

TEST_F(Pictures, ShowWhoIsIdleInTheStateThatIsDrawn) {
  const test::SmallHome home(test::smallHomeWorldWithModels());
  SimulationOptions simulation;
  simulation.envs = 2;
  simulation.order = EpisodeOrder::kPartition;
  simulation.task.most_steps = 2;
  simulation.body_transforms = true;
  auto simulator = BatchSimulator::create(home.world(), simulation).value();
  RunOptions run;
  run.drawing = smallOptions();
  run.drawing.backend = RenderBackend::kSoft;
  auto rendering = Rendering::create(home.world(), simulator, run, 2).value();
  const std::vector<float> actions(simulator.envCount() * simulator.actionCount());
  std::size_t idle = 0;
  constexpr std::size_t kStates = 8;
  for (std::size_t step = 0; step < kStates; ++step) {
    const auto now = simulator.idle();
    const std::vector<std::uint8_t> wanted(now.begin(), now.end());
    rendering.update(simulator);
    rendering.begin();
    // As a run does, which draws and steps at once.
    simulator.step(actions);
    rendering.end();
    for (std::size_t env = 0; env < wanted.size(); ++env) {
      EXPECT_EQ(rendering.frames()[env].is_idle, wanted[env] != 0) << env << " at " << step;
      idle += wanted[env];
    }
  }
  // Three of four episodes can be played: one of the envs has two of them.
  EXPECT_EQ(idle, 2 * kStates - 2 - 4);
}

TEST_F(Pictures, ASheetIsWrittenThoughFramesAndVideoCannotBe) {
  fakeFfmpeg("exit 3\n");
  DrawingOptions options = smallOptions();
  options.frames = file("frames");
  options.video = file("run.mp4");
  options.contact_sheet = file("sheet.png");
  auto output = PictureOutput::open(options, {1000, 2});
  ASSERT_TRUE(output) << output.error().message;
  const SmallImage small;
  const std::vector<EnvFrame> frames{small.frame(), small.frame()};
  // There is no such folder.
  const Result<void> added = output->add(0, frames);
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().where, HasSubstr("/frames/env_0000_step_000000"));
  ASSERT_FALSE(output->addLast(1, frames));
  static_cast<void>(output->finish());
  EXPECT_THAT(files("."), ElementsAre("bin", "sheet.png"));
}

TEST_F(Pictures, AFileInTheWayOfTheFramesIsRefused) {
  const std::string in_the_way = folder_.write("occupied", "a file").string();
  const Result<void> made = makeFrameFolder(in_the_way);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kIo);
  EXPECT_EQ(made.error().where, in_the_way);
  EXPECT_THAT(made.error().message, HasSubstr("cannot be made a folder"));
}

TEST_F(Pictures, AVideoIsTheTilesOfAllFrames) {
  keepingFfmpeg();
  DrawingOptions options = smallOptions();
  options.video = file("run.mp4");
  auto output = PictureOutput::open(options, {10, 2});
  ASSERT_TRUE(output) << output.error().message;
  const SmallImage small;
  for (std::uint64_t step = 0; step < 3; ++step) {
    ASSERT_TRUE(output->add(step, std::vector{small.frame(), small.frame()}));
  }
  EXPECT_FALSE(std::filesystem::exists(options.video));
  const auto finished = output->finish();
  ASSERT_TRUE(finished) << finished.error().message;
  // Two tiles of 10 x 1 pixels with a gap between them: 22 x 1, made even.
  const std::string raw = test::fileContent(options.video);
  ASSERT_EQ(raw.size(), 3U * 22 * 2 * 3);
  EXPECT_EQ(raw.substr(0, 6), "\x0a\x14\x1e\x28\x32\x3c");
  EXPECT_EQ(raw.substr(12 * 3, 6), "\x0a\x14\x1e\x28\x32\x3c");
  const std::string part = partPathOf(file("run.mp4"), 0, PartEnding::kOfTarget).string();
  EXPECT_THAT(part, EndsWith(".mp4"));
  EXPECT_EQ(test::fileContent(file("arguments")),
            "-y -loglevel error -f rawvideo -pix_fmt rgb24 -s 22x2 -r 30 -i - -an -pix_fmt "
            "yuv420p " +
                part + "\n");
  EXPECT_THAT(files("."), ElementsAre("arguments", "bin", "run.mp4"));
}

TEST_F(Pictures, AVideoNeedsFfmpegAndSaysSo) {
  usePath(file("nothing"));
  const auto video = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(video.error().message,
            "needs ffmpeg, which is not on PATH; install it, or take --frames instead");
}

TEST_F(Pictures, AnFfmpegThatEndsEarlyIsAnErrorAndLeavesNothing) {
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

TEST_F(Pictures, AnFfmpegThatEndsBeforeItHasReadAFrameIsTheSameError) {
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

TEST_F(Pictures, AVideoGrowsUnderANameOfItsOwnAndRemovesWhatKilledRunsLeft) {
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

TEST_F(Pictures, AVideoWhereNothingCanBeWrittenIsAnError) {
  keepingFfmpeg();
  const auto video = VideoPipe::start(file("none/run.mp4"), Image(2, 2, {}));
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().code, ErrorCode::kIo);
  EXPECT_EQ(video.error().message, "cannot be written: No such file or directory");
}

TEST_F(Pictures, AnFfmpegThatFailsAtTheEndIsAnErrorToo) {
  fakeFfmpeg("cat > /dev/null\nexit 1\n");
  auto video = VideoPipe::start(file("run.mp4"), Image(2, 2, {}));
  ASSERT_TRUE(video);
  ASSERT_TRUE(video->append(Image(2, 2, {})));
  const auto finished = video->finish();
  ASSERT_FALSE(finished);
  EXPECT_THAT(finished.error().message, HasSubstr("ffmpeg ended with code 1"));
}

TEST_F(Pictures, AVideoThatIsGivenUpLeavesTheOldOne) {
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

TEST(CameraChoice, KnowsTheCamerasByName) {
  const test::SmallHome home;
  const Robot& robot = home.world().robot();
  const auto head = chooseCamera(robot, {.name = "head"});
  ASSERT_TRUE(head);
  EXPECT_EQ(head->mount.frame, CameraFrame::kLink);
  EXPECT_EQ(head->mount.link, robot.camera()->link);
  EXPECT_EQ(head->mount.vertical_fov, robot.camera()->vertical_fov);
  const auto hand = chooseCamera(robot, {.name = "hand", .fov_degrees = 90});
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->mount.link, 4U);
  EXPECT_NEAR(hand->mount.vertical_fov, 1.5707963F, 1e-6F);
  EXPECT_EQ(chooseCamera(robot, {.name = "link:hand"})->mount.link, 4U);
  const auto follow = chooseCamera(robot, {.name = "follow"});
  ASSERT_TRUE(follow);
  EXPECT_EQ(follow->mount.frame, CameraFrame::kBase);
  const Pose& pose = follow->mount.frame_from_camera;
  EXPECT_LT(pose.translation.x, 0);
  EXPECT_LT(rotate(pose.rotation, {1, 0, 0}).y, -0.5F);
}

TEST(CameraChoice, FromAboveAheadIsUpInTheImageAndCeilingsAreCutOff) {
  const test::SmallHome home;
  const auto top = chooseCamera(home.world().robot(), {.name = "top"});
  ASSERT_TRUE(top);
  const Pose& pose = top->mount.frame_from_camera;
  EXPECT_NEAR(rotate(pose.rotation, {1, 0, 0}).y, -1, 1e-6F);
  EXPECT_NEAR(rotate(pose.rotation, {0, 1, 0}).x, 1, 1e-6F);
  EXPECT_NEAR(pose.translation.y - top->near, 2.1F, 1e-5F);
}

TEST(CameraChoice, StandsAndLooksAsARecipeWouldHaveIt) {
  const test::SmallHome home;
  const Robot& robot = home.world().robot();
  const auto expect_near = [](const Vec3& found, const Vec3& wanted) {
    EXPECT_NEAR(found.x, wanted.x, 1e-6F);
    EXPECT_NEAR(found.y, wanted.y, 1e-6F);
    EXPECT_NEAR(found.z, wanted.z, 1e-6F);
  };
  const auto hand = chooseCamera(
      robot, {.name = "hand", .position = {0.1F, 0.2F, 0.3F}, .rpy_degrees = {90, 0, 0}});
  ASSERT_TRUE(hand);
  const Pose& rolled = hand->mount.frame_from_camera;
  // Ahead, up and to the right, where a recipe has ahead, to the left and up.
  expect_near(rolled.translation, {0.1F, 0.3F, -0.2F});
  expect_near(rotate(rolled.rotation, {1, 0, 0}), {1, 0, 0});
  expect_near(rotate(rolled.rotation, {0, 1, 0}), {0, 0, 1});
  const auto turned =
      chooseCamera(robot, {.name = "hand", .rpy_degrees = {0, 30, 90}})->mount.frame_from_camera;
  // Pitched down first, then turned to the left.
  const float down = std::sqrt(3.0F) / 2;
  expect_near(rotate(turned.rotation, {1, 0, 0}), {0, -0.5F, -down});
  expect_near(rotate(turned.rotation, {0, 1, 0}), {0, down, -0.5F});
  // Of a camera that has a place of its own, in its own axes: 5 m down from above.
  const auto top = chooseCamera(robot, {.name = "top", .position = {5, 0, 0}, .near = 0.2F});
  expect_near(top->mount.frame_from_camera.translation, {0, 1, 0});
  EXPECT_EQ(top->near, 0.2F);
}

TEST(CameraChoice, RefusesPlacesThatAreNone) {
  const test::SmallHome home;
  const auto refusal = [&](const CameraWish& wish) {
    const auto none = chooseCamera(home.world().robot(), wish);
    return none ? "" : none.error().where + ": " + none.error().message;
  };
  EXPECT_EQ(refusal({.name = "hand", .position = {-100, 0, 100}, .rpy_degrees = {-360, 0, 360}}),
            "");
  EXPECT_EQ(refusal({.name = "hand", .position = {0, 0, 101}}),
            "--camera-position: found 101 m, expected -100 to 100");
  EXPECT_EQ(refusal({.name = "hand", .position = {std::nanf(""), 0, 0}}),
            "--camera-position: found nan m, expected -100 to 100");
  EXPECT_EQ(refusal({.name = "hand", .rpy_degrees = {0, -361, 0}}),
            "--camera-rpy: found -361 degrees, expected -360 to 360");
  for (const float near : {-1.0F, 0.009F, 101.0F, std::nanf("")}) {
    EXPECT_THAT(refusal({.name = "hand", .near = near}),
                EndsWith(" m, expected 0.01 to 100, or 0 for what belongs to the camera"));
  }
}

TEST(CameraChoice, NumbersCamerasByTheirPlaces) {
  const test::SmallHome home;
  const auto number = [&](const CameraWish& wish) {
    return chooseCamera(home.world().robot(), wish).value().mount.number;
  };
  const std::uint64_t hand = number({.name = "hand"});
  EXPECT_EQ(number({.name = "hand",
                    .fov_degrees = 50,
                    .position = {0, -0.0F, 0},
                    .near = 0.2F,
                    .jitter = {0.1F, 2}}),
            hand);
  EXPECT_NE(number({.name = "head"}), hand);
  EXPECT_NE(number({.name = "hand", .position = {0.1F, 0, 0}}), hand);
  EXPECT_NE(number({.name = "hand", .rpy_degrees = {0.1F, 0, 0}}), hand);
}

TEST(CameraChoice, RefusesJitterOutOfRange) {
  const test::SmallHome home;
  const auto refusal = [&](const CameraJitter& jitter) {
    const auto none = chooseCamera(home.world().robot(), {.name = "hand", .jitter = jitter});
    return none ? "" : none.error().where + ": " + none.error().message;
  };
  EXPECT_EQ(refusal({.camera_jitter = 1, .camera_jitter_degrees = 180}), "");
  EXPECT_EQ(refusal({.camera_jitter = -0.5F}), "--camera-jitter: found -0.5 m, expected 0 to 1");
  EXPECT_EQ(refusal({.camera_jitter_degrees = 181}),
            "--camera-jitter-degrees: found 181 degrees, expected 0 to 180");
  EXPECT_EQ(refusal({.camera_jitter_degrees = std::nanf("")}),
            "--camera-jitter-degrees: found nan degrees, expected 0 to 180");
}

TEST(CameraChoice, RefusesFieldsOfViewThatShowNothing) {
  const test::SmallHome home;
  const Robot& robot = home.world().robot();
  for (const float fov : {0.0F, 1.0F, 175.0F}) {
    EXPECT_TRUE(chooseCamera(robot, {.name = "top", .fov_degrees = fov})) << fov;
  }
  for (const float fov : {-5.0F, 0.9F, 175.1F, 180.0F, 360.0F, std::nanf("")}) {
    const auto none = chooseCamera(robot, {.name = "top", .fov_degrees = fov});
    ASSERT_FALSE(none) << fov;
    EXPECT_EQ(none.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(none.error().where, "--fov");
    EXPECT_THAT(none.error().message,
                EndsWith(" degrees, expected 1 to 175, or 0 for that of the camera"));
  }
}

TEST(CameraChoice, AnUnknownLinkIsRefusedWithThoseThereAre) {
  const test::SmallHome home;
  const auto none =
      chooseCamera(home.world().robot(), {.name = "nose", .options = {.camera = "--debug-camera"}});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(none.error().where, "--debug-camera");
  EXPECT_THAT(none.error().message,
              AllOf(HasSubstr("found no link nose"),
                    HasSubstr("head, follow, top or one of base, mast, turret, arm, hand")));
}

}  // namespace
}  // namespace galactic::pictures_test
