#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "command.h"
#include "galactic/bake/build.h"
#include "support/console/stop_request.h"
#include "terminal.h"

namespace galactic::bake {

/// Follows the build of single files: a line of progress, and the closing table of each. The first
/// Ctrl-C ends the program: one file may take long, and what is kept of it is kept on the way.
class FileFollower final : public BuildObserver {
 public:
  FileFollower(const BakeCommand& command, std::span<const PackJob> jobs);

  void show(std::string_view item, std::string_view stage, double fraction) override;
  void end(const PackOutcome& pack) override;

 private:
  StopRequest stop_;
  std::mutex mutex_;
  Verbosity verbosity_;
  ProgressLine line_;
};

/// Follows the build of many packs: on a terminal one line with an estimate of what is left,
/// elsewhere a line for each pack that is done, and one now and then while a pack takes long. The
/// first Ctrl-C stops it between packs.
class WorldFollower final : public BuildObserver {
 public:
  /// `count`: packs that are to be made.
  WorldFollower(const BakeCommand& command, std::size_t count)
      : verbosity_(command.run.verbosity), count_(count), line_(command.saysMore()) {}

  void begin(std::string_view pack) override;
  /// What is done inside a pack is shown while it is the only one at work, as episodes always are.
  void show(std::string_view item, std::string_view stage, double fraction) override;
  void end(const PackOutcome& pack) override;
  [[nodiscard]] bool stops() override { return stop_.came(); }

 private:
  using Clock = std::chrono::steady_clock;

  void forgetStage();
  void redraw();
  /// A line that stays.
  void print(const std::string& line);
  /// Where nobody sees the line that changes: one that stays, after a while without any.
  void sayThatItGoesOn();
  /// How much time is left; "?" while nobody knows.
  [[nodiscard]] std::string left() const;

  StopRequest stop_{"galactic-bake"};
  std::mutex mutex_;
  Verbosity verbosity_;
  std::size_t count_;
  ProgressLine line_;
  Clock::time_point start_ = Clock::now();
  /// When the last line that stays was printed.
  Clock::time_point printed_ = start_;
  std::set<std::string, std::less<>> running_;
  /// Of the only pack at work: what is done, and how much of it is; else nothing.
  std::string stage_;
  double fraction_ = 0;
  /// When and with what it was first told.
  Clock::time_point stage_start_;
  double stage_from_ = 0;
  std::size_t done_ = 0;
  std::size_t baked_ = 0;
};

}  // namespace galactic::bake
