// What is written of the images of a run: pictures, sheets, frames and videos.
#include "drawing/picture_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drawing/contact_sheet.h"
#include "drawing/rendering.h"
#include "picture_folder.h"
#include "pictures/drawing.h"
#include "support/file_content.h"
#include "support/files/part_files.h"
#include "support/homes/small_home.h"
#include "support/homes/small_home_models.h"
#include "support/program_run.h"

namespace galactic::picture_output_test {
namespace {

using pictures::Image;
using pictures::Rgb;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

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

class Pictures : public test::PictureFolder {
 protected:
  [[nodiscard]] static DrawingOptions smallOptions() {
    DrawingOptions options;
    options.images = "rgbds";
    options.width = 2;
    options.height = 1;
    options.frame_envs = 2;
    return options;
  }
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
  // Env, step and episode stand below each other.
  const int row = 1 + kSheetGap + pictures::kTextHeight + 2 * kCaptionAdvance + kSheetGap;
  // Which image is which, and two lines of depths.
  const int around = kSheetGap + kSheetGap + 3 * kCaptionAdvance;
  EXPECT_EQ(height_of(100, 100), around + 6 * row);
  EXPECT_EQ(height_of(3, 3), around + 4 * row);
  // Runs that were stopped.
  EXPECT_EQ(height_of(100, 41), around + 6 * row);
  EXPECT_EQ(height_of(1000000, 41), around + 6 * row);
  EXPECT_EQ(height_of(1000000, 0), around + 1 * row);
}

TEST_F(Pictures, ASheetSaysWhatItShows) {
  constexpr std::uint32_t kWidth = 128;
  DrawingOptions options = smallOptions();
  options.contact_sheet = file("sheet.png");
  options.width = kWidth;
  options.debug_view = true;
  const std::vector<std::uint8_t> color(std::size_t{kWidth} * 4, 77);
  const std::vector<float> depth(kWidth, 3);
  const std::vector<std::uint32_t> ids(kWidth, 5);
  EnvFrame frame;
  frame.camera = {kWidth, 1, ColorFormat::kRgba8, color, depth, ids};
  frame.debug = DrawnImage{kWidth, 1, ColorFormat::kRgba8, color, {}, {}};
  frame.episode = 14;
  frame.target = "mug";
  EnvFrame idle = frame;
  idle.is_idle = true;
  EnvFrame holding = frame;
  holding.held = "bowl";
  auto output = PictureOutput::open(options, {.steps = 7, .envs = 2});
  ASSERT_TRUE(output) << output.error().message;
  ASSERT_TRUE(output->add(0, std::vector{frame, frame}));
  ASSERT_TRUE(output->addLast(3, std::vector{holding, idle}));
  ASSERT_TRUE(output->finish());
  const Image tile = tileOf(idle);
  const SheetGuide guide{.headings = {{0, "color"}, {130, "depth"}, {260, "ids"}, {390, "debug"}},
                         .legend = {{{{}, "depth"},
                                     {Rgb{255, 255, 255}, "0 m"},
                                     {Rgb{170, 170, 170}, "1 m"},
                                     {Rgb{128, 128, 128}, "2 m"},
                                     {Rgb{85, 85, 85}, "4 m"},
                                     {Rgb{51, 51, 51}, "8 m"},
                                     {Rgb{}, "nothing"}},
                                    {{{}, "debug"},
                                     {Rgb{40, 176, 72}, "robot"},
                                     {Rgb{46, 116, 232}, "held object"},
                                     {Rgb{240, 130, 20}, "object"},
                                     {Rgb{214, 30, 140}, "target, and its goal as a frame"}}}};
  const Image wanted = contactSheet({{tile, "env 0, step 0, episode 14, target mug"},
                                     {tile, "env 1, step 0, episode 14, target mug"},
                                     {tile, "env 0, step 3, episode 14, target mug, holds bowl"},
                                     {tile, "env 1, step 3, idle"}},
                                    2, guide);
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
    const std::vector states{simulator.envState(0), simulator.envState(1)};
    rendering.update(simulator);
    rendering.begin();
    // As a run does, which draws and steps at once.
    simulator.step(actions);
    rendering.end();
    for (std::size_t env = 0; env < wanted.size(); ++env) {
      const EnvFrame& frame = rendering.frames()[env];
      EXPECT_EQ(frame.is_idle, wanted[env] != 0) << env << " at " << step;
      EXPECT_EQ(frame.episode, states[env].episode) << env << " at " << step;
      const EpisodeSet& episodes = home.world().episodes();
      const Episode& episode = episodes.episodes()[states[env].episode];
      EXPECT_EQ(frame.target,
                episodes.objectNames()[episodes.placements(episode)[episode.target].object]);
      EXPECT_EQ(frame.held, "");
      idle += wanted[env];
    }
  }
  // Three of four episodes can be played: one of the envs has two of them.
  EXPECT_EQ(idle, 2 * kStates - 2 - 4);
}

TEST_F(Pictures, ASheetThatNoViewerShowsIsRefusedWithWhatFits) {
  DrawingOptions options = smallOptions();
  options.contact_sheet = file("sheet.png");
  const auto refusal_of = [&](std::uint32_t envs) {
    options.frame_envs = envs;
    const auto output = PictureOutput::open(options, {2, envs});
    return output ? std::string() : output.error().message;
  };
  const std::string refusal = refusal_of(200);
  EXPECT_THAT(refusal, HasSubstr(" pixels, and viewers show up to 16384 along a side; show at "
                                 "most "));
  const std::string most = "at most ";
  const unsigned long fits = std::stoul(refusal.substr(refusal.find(most) + most.size()));
  EXPECT_EQ(refusal_of(static_cast<std::uint32_t>(fits)), "");
  EXPECT_THAT(refusal_of(static_cast<std::uint32_t>(fits + 1)),
              HasSubstr(" show at most " + std::to_string(fits) + " of its "));
  // Three moments of 6000 pixels.
  options.width = 100;
  options.height = 6000;
  const std::string smaller = refusal_of(2);
  EXPECT_THAT(smaller, HasSubstr("; draw images of at most "));
  EXPECT_THAT(smaller, HasSubstr(" pixels along a side (--size), then one env fits"));
  options.height =
      static_cast<std::uint32_t>(std::stoul(smaller.substr(smaller.find(most) + most.size())));
  EXPECT_GT(options.height, 5000U);
  EXPECT_EQ(refusal_of(1), "");
  ++options.height;
  EXPECT_NE(refusal_of(1), "");
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

TEST_F(Pictures, FramesThatKilledRunsBeganAreRemovedWhateverTheirStep) {
  const std::string begun = "frames/env_0003_step_000120_rgb.png";
  for (const std::string& name : {begun, std::string("frames/mine.png")}) {
    static_cast<void>(folder_.write(partPathOf(name, 0).string(), "half"));
  }
  ASSERT_TRUE(makeFrameFolder(file("frames")));
  EXPECT_THAT(files("frames"), ElementsAre(StartsWith("mine.png.part-")));
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

}  // namespace
}  // namespace galactic::picture_output_test
