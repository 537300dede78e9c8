#pragma once
#include <filesystem>
#include <memory>

#include "galactic/error.h"
#include "pictures/image.h"

namespace galactic {

/// A video that ffmpeg, found on PATH, makes of pictures sent to it one by one. It grows under
/// another name beside its path and is renamed when it is whole.
class VideoPipe {
 public:
  /// Frames per second.
  static constexpr int kRate = 30;

  /// Of frames of one size; ffmpeg chooses the format by the ending of `path`. Fails with
  /// kUnsupported when there is no ffmpeg, and with kIo when it cannot be started.
  [[nodiscard]] static Result<VideoPipe> start(const std::filesystem::path& path,
                                               const pictures::Image& like);
  /// Not finished: leaves no file behind.
  ~VideoPipe();
  VideoPipe(VideoPipe&&) noexcept;
  VideoPipe& operator=(VideoPipe&&) noexcept;

  /// Fails with kIo when ffmpeg has ended early.
  [[nodiscard]] Result<void> append(const pictures::Image& frame);
  /// After the last frame. Fails with kIo when ffmpeg or the file system does.
  [[nodiscard]] Result<void> finish();

 private:
  class Child;
  explicit VideoPipe(std::unique_ptr<Child> child);
  std::unique_ptr<Child> child_;
};

}  // namespace galactic
