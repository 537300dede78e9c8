#include "followers.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "report.h"
#include "support/printable.h"
#include "views.h"

namespace galactic::bake {
namespace {

std::string clockText(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(seconds));
  const std::uint64_t minutes = whole / 60;
  if (minutes < 60) return fmt::format("{}:{:02}", minutes, whole % 60);
  return fmt::format("{}:{:02}:{:02}", minutes / 60, minutes % 60, whole % 60);
}

}  // namespace

void FileFollower::show(std::string_view item, std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  line_.show(item, stage, fraction);
}

void FileFollower::end(const PackJob& /*pack*/, const PackOutcome& outcome) {
  const std::lock_guard lock(mutex_);
  line_.clear();
  for (const BakeFailure& failure : outcome.failures) printError(failure.error);
  if (outcome.isThere() && verbosity_ >= Verbosity::kNormal) {
    printTable(*outcome.figures, verbosity_);
  }
}

void WorldFollower::begin(const PackJob& pack) {
  const std::lock_guard lock(mutex_);
  running_.insert(pack.name);
  forgetStage();
  redraw();
}

void WorldFollower::show(std::string_view /*item*/, std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  if (running_.size() != 1) return;
  stage_ = stage;
  fraction_ = fraction;
  redraw();
}

void WorldFollower::end(const PackJob& pack, const PackOutcome& outcome) {
  const std::lock_guard lock(mutex_);
  const bool is_world = std::holds_alternative<WorldJob>(pack.job);
  running_.erase(pack.name);
  forgetStage();
  line_.clear();
  for (const BakeFailure& failure : outcome.failures) printError(failure.error);
  if (is_world) return;
  ++done_;
  if (outcome.state == PackState::kBaked) ++baked_;
  const bool is_news = outcome.state == PackState::kBaked || verbosity_ == Verbosity::kVerbose;
  if (verbosity_ >= Verbosity::kNormal && is_news && outcome.failures.empty()) {
    fmt::print("  [{}/{}] {} {} in {:.1f} s\n", done_, count_, printable(pack.name),
               nameOf(outcome.state), outcome.seconds);
    std::fflush(stdout);
  }
  redraw();
}

void WorldFollower::forgetStage() {
  stage_.clear();
  fraction_ = 0;
}

void WorldFollower::redraw() {
  if (running_.empty()) return line_.clear();
  std::string left = "?";
  const double done = static_cast<double>(done_) + fraction_;
  // What was found in the cache says nothing of how long the rest takes.
  const double baked = static_cast<double>(baked_) + fraction_;
  if (baked > 0) {
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - start_;
    left = clockText(since.count() / baked * (static_cast<double>(count_) - done));
  }
  std::string at_work = printable(*running_.begin());
  if (!stage_.empty()) at_work += ": " + printable(stage_);
  line_.show(fmt::format("{}/{}, {} left", done_, count_, left), at_work,
             done / static_cast<double>(count_));
}

}  // namespace galactic::bake
