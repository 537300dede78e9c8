#pragma once
#include <filesystem>
#include <memory>

#include "galactic/error.h"
#include "pictures/image.h"

namespace galactic {

/// A video that ffmpeg, which must be on PATH, encodes from pictures sent to it one by one. The
/// file grows under another name beside its path and is renamed when it is whole.
class VideoPipe {
 public:
  /// Frames per second.
  static constexpr int kRate = 30;

  /// All frames must have the size of `like`; ffmpeg chooses the format by the extension of `path`.
  /// Fails with kUnsupported when there is no ffmpeg, and with kIo when it cannot be started.
  [[nodiscard]] static Result<VideoPipe> start(const std::filesystem::path& path,
                                               const pictures::Image& like);
  /// Leaves no file behind if the video was not finished.
  ~VideoPipe();
  VideoPipe(VideoPipe&&) noexcept;
  VideoPipe& operator=(VideoPipe&&) noexcept;

  /// Fails with kIo when ffmpeg has ended early.
  [[nodiscard]] Result<void> append(const pictures::Image& frame);
  /// Call it after the last frame. Fails with kIo when ffmpeg or the file system fails.
  [[nodiscard]] Result<void> finish();

 private:
  class Child;
  explicit VideoPipe(std::unique_ptr<Child> child);
  std::unique_ptr<Child> child_;
};

}  // namespace galactic
