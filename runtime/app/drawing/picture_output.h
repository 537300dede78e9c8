#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/render_options.h"
#include "drawing/contact_sheet.h"
#include "drawing/frame_images.h"
#include "drawing/sheet_moments.h"
#include "drawing/video_pipe.h"
#include "galactic/batch_renderer.h"
#include "galactic/error.h"

namespace galactic {

/// What is shown of one env at one moment: the image of its camera, and the debug view if there is
/// one.
struct EnvFrame {
  DrawnImage camera;
  std::optional<DrawnImage> debug;
  RenderCamera seen_from = {};
  /// Whether the env is idle (BatchSimulator::idle()).
  bool is_idle = false;
  /// Index of the episode, its target, and what the hand holds; empty: nothing.
  std::uint32_t episode = 0;
  std::string_view target = {};
  std::string_view held = {};
};

/// The run that the pictures show.
struct PicturedRun {
  std::uint64_t steps = 0;
  std::size_t envs = 0;
  /// The longest name of an object in any episode.
  std::string_view longest_name = {};
  std::size_t episodes = 0;
};

/// A frame as it appears in sheets and videos: color, depth, semantics and debug view side by side,
/// as far as they exist.
[[nodiscard]] pictures::Image tileOf(const EnvFrame& frame);

/// Whether a frame, or the file that accompanies the frames, may have this name.
[[nodiscard]] bool isFrameName(std::string_view name);

/// Makes the folder for frames if needed, and removes the frames that killed runs had begun to
/// write there. Fails with kIo when the folder cannot be made, or when no frame can be written
/// there.
[[nodiscard]] Result<void> makeFrameFolder(const std::filesystem::path& folder);

/// Writes frames, contact sheet and video of a run, as the options ask.
class PictureOutput {
 public:
  /// Does not check whether files can be written: makeFrameFolder() and tryFile() do. Fails with
  /// the errors of VideoPipe, and with kUnsupported when the sheet would be too large.
  [[nodiscard]] static Result<PictureOutput> open(const DrawingOptions& options,
                                                  const PicturedRun& run);

  /// Writes the meaning of the ids in semantic images beside the frames; does nothing if there are
  /// no frames.
  [[nodiscard]] Result<void> writeLegend(std::string_view json) const;

  /// Whether the state after `step` steps is shown.
  [[nodiscard]] bool wants(std::uint64_t step) const;
  /// Whether that state is shown if it is the last one: a sheet ends with the last state.
  [[nodiscard]] bool wantsLast(std::uint64_t step) const;
  /// How many envs are shown, starting with the first one.
  [[nodiscard]] std::size_t envCount() const { return envs_; }

  /// Adds the state after `step` steps, for which wants() must be true. `frames` has envCount()
  /// elements. After a failure, finish() still writes everything except a video that failed.
  [[nodiscard]] Result<void> add(std::uint64_t step, std::span<const EnvFrame> frames);
  /// The same for the state with which the run ends, for which wantsLast() must be true.
  [[nodiscard]] Result<void> addLast(std::uint64_t step, std::span<const EnvFrame> frames);
  /// Call it after the last step, even if the run ended early: writes the sheet and completes the
  /// video.
  [[nodiscard]] Result<void> finish();

 private:
  PictureOutput(const DrawingOptions& options, const PicturedRun& run);

  [[nodiscard]] SheetLayout plannedSheet(const PicturedRun& run, const DrawingOptions& options,
                                         std::size_t envs) const;
  [[nodiscard]] std::string adviceForSheet(const PicturedRun& run) const;
  [[nodiscard]] Result<void> checkSheet(const PicturedRun& run) const;
  [[nodiscard]] Result<void> show(std::uint64_t step, std::span<const EnvFrame> frames,
                                  bool is_on_sheet);
  [[nodiscard]] Result<void> writeSheet();
  [[nodiscard]] Result<void> writeFrame(std::uint64_t step, std::size_t env,
                                        const EnvFrame& frame) const;
  /// Whether frames and video show the state after `step` steps.
  [[nodiscard]] bool isFrame(std::uint64_t step) const;
  [[nodiscard]] pictures::Image videoFrame(std::span<const pictures::Image> tiles) const;

  DrawingOptions options_;
  std::size_t envs_;
  std::optional<SheetMoments> sheet_;
  std::optional<VideoPipe> video_;
};

}  // namespace galactic
