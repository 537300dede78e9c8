#pragma once
#include <chrono>
#include <cstddef>
#include <mutex>
#include <set>
#include <string>

#include "command.h"
#include "galactic/bake/build.h"
#include "support/stop_request.h"
#include "terminal.h"

namespace galactic::bake {

/// Follows the build of single files: a line of progress, and the closing table of each.
class FileFollower final : public BuildObserver {
 public:
  explicit FileFollower(const BakeCommand& command)
      : verbosity_(command.run.verbosity), line_(command.saysMore()) {}

  void show(std::string_view item, std::string_view stage, double fraction) override;
  void end(const PackJob& pack, const PackOutcome& outcome) override;

 private:
  std::mutex mutex_;
  Verbosity verbosity_;
  ProgressLine line_;
};

/// Follows the build of many packs: on a terminal one line with an estimate of what is left,
/// elsewhere a line for each pack that is done. The first Ctrl-C stops it between packs.
class WorldFollower final : public BuildObserver {
 public:
  /// `count`: packs that are to be made.
  WorldFollower(const BakeCommand& command, std::size_t count)
      : verbosity_(command.run.verbosity), count_(count), line_(command.saysMore()) {}

  void begin(const PackJob& pack) override;
  /// What is done inside a pack is shown while it is the only one at work, as episodes always are.
  void show(std::string_view item, std::string_view stage, double fraction) override;
  void end(const PackJob& pack, const PackOutcome& outcome) override;
  [[nodiscard]] bool stops() override { return stop_.came(); }

 private:
  void forgetStage();
  void redraw();

  StopRequest stop_{"galactic-bake"};
  std::mutex mutex_;
  Verbosity verbosity_;
  std::size_t count_;
  ProgressLine line_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::set<std::string> running_;
  /// Of the only pack at work: what is done, and how much of it is; else nothing.
  std::string stage_;
  double fraction_ = 0;
  std::size_t done_ = 0;
  std::size_t baked_ = 0;
};

}  // namespace galactic::bake
