#include "drawing/picture_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "drawing/contact_sheet.h"
#include "galactic/debug_views.h"
#include "pictures/drawing.h"
#include "pictures/png_file.h"
#include "support/files/atomic_file.h"
#include "support/files/output_files.h"
#include "support/files/part_files.h"
#include "support/out_of_memory.h"
#include "support/try.h"

namespace galactic {
namespace {

using pictures::Image;

/// Gap between the images of a tile, and between the tiles of a video; pixels.
constexpr int kTileGap = 2;

/// Most pixels along a side of a sheet that viewers and browsers can show.
constexpr int kMostSheetSide = 16384;

/// A file beside the frames with the meanings of semantic ids.
constexpr std::string_view kLegendName = "semantics.json";

std::string frameName(std::size_t env, std::uint64_t step, std::string_view what) {
  return fmt::format("env_{:04}_step_{:06}_{}", env, step, what);
}

/// Describes where the camera of a frame stood and how it projects, for programs that read frames.
std::string cameraText(const EnvFrame& frame) {
  const std::array<float, 9> k =
      cameraMatrix(frame.seen_from, frame.camera.width, frame.camera.height);
  const auto& [x, y, z, t] = worldFromImageAxes(frame.seen_from);
  return fmt::format(
      "{{\n  \"intrinsics\": [[{}, {}, {}], [{}, {}, {}], [{}, {}, {}]],\n"
      "  \"world_from_camera\": [[{}, {}, {}, {}], [{}, {}, {}, {}], [{}, {}, {}, {}], "
      "[0, 0, 0, 1]]\n}}\n",
      k[0], k[1], k[2], k[3], k[4], k[5], k[6], k[7], k[8],  //
      x.x, y.x, z.x, t.x, x.y, y.y, z.y, t.y, x.z, y.z, z.z, t.z);
}

/// Number of columns for `count` tiles in a video: about as many columns as rows.
std::size_t tileColumns(std::size_t count) {
  return static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
}

/// An idle env has no task, so its caption names none.
std::string captionOf(std::size_t env, std::uint64_t step, const EnvFrame& frame) {
  if (frame.is_idle) return fmt::format("env {}, step {}, idle", env, step);
  std::string caption = fmt::format("env {}, step {}, episode {}", env, step, frame.episode);
  if (!frame.target.empty()) caption += fmt::format(", target {}", frame.target);
  if (!frame.held.empty()) caption += fmt::format(", holds {}", frame.held);
  return caption;
}

/// The images of a tile, from left to right.
std::vector<std::string_view> imagesOf(const DrawingOptions& options) {
  std::vector<std::string_view> images;
  if (options.hasColor()) images.push_back("color");
  if (options.hasDepth()) images.push_back("depth");
  if (options.hasSemantics()) images.push_back("ids");
  if (options.debug_view) images.push_back("debug");
  return images;
}

/// An empty tile of the final size.
Image emptyTile(const DrawingOptions& options) {
  const int images = static_cast<int>(imagesOf(options).size());
  return {images * (static_cast<int>(options.width) + kTileGap) - kTileGap,
          static_cast<int>(options.height),
          {}};
}

bool isViewable(const SheetLayout& layout) {
  return layout.width() <= kMostSheetSide && layout.height() <= kMostSheetSide;
}

/// The largest number up to `most` for which `fits` is true; 0 if there is none. If a number fits,
/// all smaller ones must fit, too.
template <typename Fits>
std::size_t largestThat(std::size_t most, const Fits& fits) {
  std::size_t known = 0;
  while (known < most) {
    const std::size_t next = most - (most - known) / 2;
    if (fits(next)) {
      known = next;
    } else {
      most = next - 1;
    }
  }
  return known;
}

/// Explains depths and the colors of the debug view, and which image is which.
SheetGuide guideOf(const DrawingOptions& options) {
  SheetGuide guide;
  const std::vector<std::string_view> images = imagesOf(options);
  int left = 0;
  for (const std::string_view image : images) {
    guide.headings.push_back({left, std::string(image)});
    left += static_cast<int>(options.width) + kTileGap;
  }
  const auto is_narrow = [&](std::string_view image) {
    return pictures::textWidth(image) > static_cast<int>(options.width);
  };
  if (std::ranges::any_of(images, is_narrow)) {
    guide.headings.clear();
    guide.legend.push_back(
        {{std::nullopt, fmt::format("from left to right: {}", fmt::join(images, ", "))}});
  }
  if (options.hasDepth()) {
    auto& line = guide.legend.emplace_back();
    line.push_back({std::nullopt, "depth"});
    for (const float depth : {0.0F, 1.0F, 2.0F, 4.0F, 8.0F}) {
      line.push_back({depthColor(depth), fmt::format("{} m", depth)});
    }
    line.push_back({pictures::Rgb{}, "nothing"});
  }
  if (options.debug_view) {
    auto& line = guide.legend.emplace_back();
    line.push_back({std::nullopt, "debug"});
    for (const auto& [color, meaning] : {kDebugRobot, kDebugHeld, kDebugObject, kDebugTask}) {
      const auto channel = [value = color](unsigned shift) {
        return static_cast<std::uint8_t>(value >> shift & 0xFFU);
      };
      line.push_back({pictures::Rgb{channel(0), channel(8), channel(16)}, std::string(meaning)});
    }
  }
  return guide;
}

}  // namespace

bool isFrameName(std::string_view name) {
  return name == kLegendName ||
         (name.starts_with("env_") && (name.ends_with(".png") || name.ends_with(".json")));
}

Result<void> makeFrameFolder(const std::filesystem::path& folder) {
  RETURN_IF_ERROR(checkNotDash(folder));
  RETURN_IF_ERROR(makeFolders(folder));
  RETURN_IF_ERROR(tryFile(folder / frameName(0, 0, "rgb.png")));
  (void)removeStaleParts(folder, {.accepts = isFrameName});
  return {};
}

Image tileOf(const EnvFrame& frame) {
  std::vector<Image> images;
  const auto add = [&images](const DrawnImage& drawn) {
    if (!drawn.color.empty()) images.push_back(colorPicture(drawn));
    if (!drawn.depth.empty()) images.push_back(depthPicture(drawn));
    if (!drawn.semantics.empty()) images.push_back(semanticPicture(drawn));
  };
  add(frame.camera);
  if (frame.debug) add(*frame.debug);
  const int step = images.front().width() + kTileGap;
  Image tile(static_cast<int>(images.size()) * step - kTileGap, images.front().height(), {});
  for (std::size_t n = 0; n < images.size(); ++n) {
    paste(tile, images[n], static_cast<int>(n) * step, 0);
  }
  return tile;
}

PictureOutput::PictureOutput(const DrawingOptions& options, const PicturedRun& run)
    : options_(options), envs_(std::min<std::size_t>(options.frame_envs, run.envs)) {
  if (!options.contact_sheet.empty()) sheet_.emplace(run.steps, options.frame_every);
}

Result<PictureOutput> PictureOutput::open(const DrawingOptions& options, const PicturedRun& run) {
  PictureOutput output(options, run);
  RETURN_IF_ERROR(output.checkSheet(run));
  if (!options.video.empty()) {
    const std::vector<Image> tiles(output.envs_, emptyTile(options));
    ASSIGN_OR_RETURN(VideoPipe video, VideoPipe::start(options.video, output.videoFrame(tiles)));
    output.video_.emplace(std::move(video));
  }
  return output;
}

/// The layout of a sheet of the first `envs` envs for a run that does all its steps.
SheetLayout PictureOutput::plannedSheet(const PicturedRun& run, const DrawingOptions& options,
                                        std::size_t envs) const {
  EnvFrame frame;
  frame.episode = static_cast<std::uint32_t>(run.episodes);
  frame.target = frame.held = run.longest_name;
  const std::string longest = captionOf(envs - 1, run.steps, frame);
  return sheetLayout(envs * sheet_->planned(), envs, emptyTile(options), std::span(&longest, 1),
                     guideOf(options));
}

/// How to make a sheet that is too large small enough to be viewed.
std::string PictureOutput::adviceForSheet(const PicturedRun& run) const {
  const std::size_t envs = largestThat(
      envs_, [&](std::size_t count) { return isViewable(plannedSheet(run, options_, count)); });
  if (envs > 0) return fmt::format("show at most {} of its {} envs (--frame-envs)", envs, envs_);
  const std::size_t most = std::max(options_.width, options_.height);
  const std::size_t edge = largestThat(most, [&](std::size_t longest) {
    DrawingOptions smaller = options_;
    smaller.width = std::min(options_.width, static_cast<std::uint32_t>(longest));
    smaller.height = std::min(options_.height, static_cast<std::uint32_t>(longest));
    return isViewable(plannedSheet(run, smaller, 1));
  });
  return fmt::format("draw images of at most {} pixels along a side (--size), then one env fits",
                     edge);
}

/// Called before the run, because failing afterwards would waste it.
Result<void> PictureOutput::checkSheet(const PicturedRun& run) const {
  if (!sheet_) return {};
  const SheetLayout layout = plannedSheet(run, options_, envs_);
  if (!isViewable(layout)) {
    return fail(ErrorCode::kUnsupported, options_.contact_sheet,
                fmt::format("would be a picture of {} x {} pixels, and viewers show up to {} along "
                            "a side; {}",
                            layout.width(), layout.height(), kMostSheetSide, adviceForSheet(run)));
  }
  // The tiles of all moments that are held, the sheet, and its encoded file.
  constexpr double kHeld =
      static_cast<double>(SheetMoments::mostHeld()) / static_cast<double>(SheetMoments::kMost);
  constexpr double kBytesPerPixel = (kHeld + 2) * sizeof(pictures::Rgb);
  return checkMemory(kBytesPerPixel * layout.width() * layout.height(),
                     fmt::format("pictures of {} envs on one sheet", envs_),
                     "show fewer envs (--frame-envs), or smaller images (--size)");
}

Result<void> PictureOutput::writeLegend(std::string_view json) const {
  if (options_.frames.empty()) return {};
  const std::filesystem::path file = std::filesystem::path(options_.frames) / kLegendName;
  return writeFileAtomically(file, json);
}

bool PictureOutput::wants(std::uint64_t step) const {
  const bool takes_all = !options_.frames.empty() || video_;
  return (sheet_ && sheet_->wants(step)) || (takes_all && isFrame(step));
}

bool PictureOutput::wantsLast(std::uint64_t step) const { return sheet_ || wants(step); }

Result<void> PictureOutput::add(std::uint64_t step, std::span<const EnvFrame> frames) {
  return show(step, frames, sheet_ && sheet_->wants(step));
}

Result<void> PictureOutput::addLast(std::uint64_t step, std::span<const EnvFrame> frames) {
  return show(step, frames, sheet_.has_value());
}

Result<void> PictureOutput::show(std::uint64_t step, std::span<const EnvFrame> frames,
                                 bool is_on_sheet) {
  Result<void> written;
  if (!options_.frames.empty() && isFrame(step)) {
    for (std::size_t env = 0; env < frames.size() && written; ++env) {
      written = writeFrame(step, env, frames[env]);
    }
  }
  const bool is_filmed = video_ && isFrame(step);
  if (!is_filmed && !is_on_sheet) return written;
  std::vector<Image> tiles;
  tiles.reserve(frames.size());
  for (const EnvFrame& frame : frames) tiles.push_back(tileOf(frame));
  Result<void> filmed;
  if (is_filmed) filmed = video_->append(videoFrame(tiles));
  // The video has failed; the sheet goes on without it.
  if (!filmed) video_.reset();
  if (is_on_sheet) {
    SheetMoments::Moment moment{.step = step, .cells = {}};
    for (std::size_t env = 0; env < frames.size(); ++env) {
      moment.cells.push_back({std::move(tiles[env]), captionOf(env, step, frames[env])});
    }
    sheet_->add(std::move(moment));
  }
  RETURN_IF_ERROR(written);
  return filmed;
}

Result<void> PictureOutput::finish() {
  const Result<void> filmed = video_ ? video_->finish() : Result<void>();
  Result<void> drawn = sheet_ ? writeSheet() : Result<void>();
  RETURN_IF_ERROR(filmed);
  return drawn;
}

Result<void> PictureOutput::writeSheet() {
  std::vector<SheetCell> cells;
  for (SheetMoments::Moment& moment : sheet_->take()) {
    std::ranges::move(moment.cells, std::back_inserter(cells));
  }
  if (cells.empty()) return {};
  return pictures::writePng(options_.contact_sheet, contactSheet(cells, envs_, guideOf(options_)));
}

bool PictureOutput::isFrame(std::uint64_t step) const { return step % options_.frame_every == 0; }

Result<void> PictureOutput::writeFrame(std::uint64_t step, std::size_t env,
                                       const EnvFrame& frame) const {
  const std::filesystem::path folder = options_.frames;
  const auto write = [&](std::string_view what, const auto& picture) {
    return pictures::writePng(folder / frameName(env, step, what), picture);
  };
  Result<void> written =
      writeFileAtomically(folder / frameName(env, step, "camera.json"), cameraText(frame));
  const DrawnImage& camera = frame.camera;
  if (written && !camera.color.empty()) written = write("rgb.png", colorPicture(camera));
  if (written && !camera.depth.empty()) written = write("depth.png", depthNumbers(camera));
  if (written && !camera.semantics.empty()) {
    written = write("semantic.png", semanticNumbers(camera));
  }
  if (written && frame.debug) written = write("debug.png", colorPicture(*frame.debug));
  return written;
}

Image PictureOutput::videoFrame(std::span<const Image> tiles) const {
  const std::size_t columns = tileColumns(tiles.size());
  const std::size_t rows = (tiles.size() + columns - 1) / columns;
  const int step_x = tiles[0].width() + kTileGap;
  const int step_y = tiles[0].height() + kTileGap;
  // Common codecs accept only even sizes.
  const auto even = [](std::size_t count, int step) {
    const int length = static_cast<int>(count) * step - kTileGap;
    return length + length % 2;
  };
  Image frame(even(columns, step_x), even(rows, step_y), {});
  for (std::size_t n = 0; n < tiles.size(); ++n) {
    paste(frame, tiles[n], static_cast<int>(n % columns) * step_x,
          static_cast<int>(n / columns) * step_y);
  }
  return frame;
}

}  // namespace galactic
