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

/// Follows the build of single files: shows a progress line, and prints a table when each is done.
/// The first Ctrl-C ends the program: a single file may take long, and what can be resumed is saved
/// along the way.
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

/// Follows the build of many packs. On a terminal, shows one line with an estimate of the time
/// left; elsewhere, prints a line for each finished pack, and one now and then while a pack takes
/// long. The first Ctrl-C stops the build between packs.
class WorldFollower final : public BuildObserver {
 public:
  /// `count`: number of packs to make.
  WorldFollower(const BakeCommand& command, std::size_t count)
      : verbosity_(command.run.verbosity), count_(count), line_(command.saysMore()) {}

  void begin(std::string_view pack) override;
  /// Shows the stage of a pack only while no other pack is being made, which is always so for
  /// episodes.
  void show(std::string_view item, std::string_view stage, double fraction) override;
  void end(const PackOutcome& pack) override;
  [[nodiscard]] bool stops() override { return stop_.came(); }

 private:
  using Clock = std::chrono::steady_clock;

  void forgetStage();
  void redraw();
  /// Prints a permanent line.
  void print(const std::string& line);
  /// Prints a permanent line if the progress line is hidden and nothing has been printed for a
  /// while.
  void sayThatItGoesOn();
  /// The estimated time left; "?" while there is no estimate.
  [[nodiscard]] std::string left() const;

  StopRequest stop_{"galactic-bake"};
  std::mutex mutex_;
  Verbosity verbosity_;
  std::size_t count_;
  ProgressLine line_;
  Clock::time_point start_ = Clock::now();
  /// When the last permanent line was printed.
  Clock::time_point printed_ = start_;
  std::set<std::string, std::less<>> running_;
  /// Stage of the only pack in progress and the fraction done; empty and 0 otherwise.
  std::string stage_;
  double fraction_ = 0;
  /// When the stage was first reported, and with which fraction.
  Clock::time_point stage_start_;
  double stage_from_ = 0;
  std::size_t done_ = 0;
  std::size_t baked_ = 0;
};

}  // namespace galactic::bake
