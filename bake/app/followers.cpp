#include "followers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "report.h"
#include "support/files/output_files.h"
#include "support/text/printable.h"
#include "views.h"

namespace galactic::bake {
namespace {

std::string clockText(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(seconds));
  const std::uint64_t minutes = whole / 60;
  if (minutes < 60) return fmt::format("{}:{:02}", minutes, whole % 60);
  return fmt::format("{}:{:02}:{:02}", minutes / 60, minutes % 60, whole % 60);
}

/// Whether an earlier bake has done part of `job`, with which the next bake continues.
bool isBegun(const PackJob& job) { return isThere(job.output.string() + ".partial"); }

}  // namespace

FileFollower::FileFollower(const BakeCommand& command, std::span<const PackJob> jobs)
    : stop_("galactic-bake",
            [jobs] {
              return std::ranges::any_of(jobs, isBegun)
                         ? "interrupted; the same command goes on where it was"
                         : "interrupted; an existing pack is left as it was";
            }),
      verbosity_(command.run.verbosity),
      line_(command.saysMore()) {}

void FileFollower::show(std::string_view item, std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  line_.show(item, stage, fraction);
}

void FileFollower::end(const PackOutcome& pack) {
  const std::lock_guard lock(mutex_);
  line_.clear();
  printFailures(pack);
  if (pack.isThere() && verbosity_ >= Verbosity::kNormal) printTable(*pack.figures, verbosity_);
}

void WorldFollower::begin(std::string_view pack) {
  const std::lock_guard lock(mutex_);
  running_.emplace(pack);
  forgetStage();
  redraw();
}

void WorldFollower::show(std::string_view /*item*/, std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  if (running_.size() != 1) return;
  if (stage_.empty()) {
    stage_start_ = Clock::now();
    stage_from_ = fraction;
  }
  stage_ = stage;
  fraction_ = fraction;
  redraw();
  sayThatItGoesOn();
}

void WorldFollower::end(const PackOutcome& pack) {
  const std::lock_guard lock(mutex_);
  running_.erase(pack.name);
  forgetStage();
  line_.clear();
  printFailures(pack);
  if (pack.state == PackState::kPlanned) return;
  ++done_;
  if (pack.state == PackState::kBaked) ++baked_;
  const bool is_news = pack.state == PackState::kBaked || verbosity_ == Verbosity::kVerbose;
  if (verbosity_ >= Verbosity::kNormal && is_news && pack.failures.empty()) {
    print(fmt::format("{} {} in {:.1f} s", printable(pack.name), nameOf(pack.state), pack.seconds));
  }
  redraw();
}

void WorldFollower::forgetStage() {
  stage_.clear();
  fraction_ = stage_from_ = 0;
}

void WorldFollower::print(const std::string& line) {
  fmt::print("  [{}/{}] {}\n", done_, count_, line);
  std::fflush(stdout);
  printed_ = Clock::now();
}

void WorldFollower::sayThatItGoesOn() {
  constexpr std::chrono::seconds kSilence{30};
  const bool is_wanted = verbosity_ >= Verbosity::kNormal && !line_.isEnabled();
  if (!is_wanted || Clock::now() - printed_ < kSilence) return;
  print(fmt::format("{}: {}, {} left", printable(*running_.begin()), printable(stage_), left()));
}

std::string WorldFollower::left() const {
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const std::size_t begun = done_ + running_.size();
  const std::size_t waiting = count_ > begun ? count_ - begun : 0;
  // Packs found in the cache do not show how long the rest takes.
  const double baked = static_cast<double>(baked_);
  if (fraction_ > stage_from_) {
    const double rest = since(stage_start_) / (fraction_ - stage_from_) * (1 - fraction_);
    if (waiting == 0) return clockText(rest);
    return baked > 0 ? clockText(rest + since(start_) / baked * static_cast<double>(waiting)) : "?";
  }
  if (baked == 0) return "?";
  return clockText(since(start_) / baked * static_cast<double>(count_ - done_));
}

void WorldFollower::redraw() {
  if (running_.empty()) return line_.clear();
  std::string at_work = printable(*running_.begin());
  if (!stage_.empty()) at_work += ": " + printable(stage_);
  const double done = static_cast<double>(done_) + fraction_;
  line_.show(fmt::format("{}/{}, {} left", done_, count_, left()), at_work,
             done / static_cast<double>(count_));
}

}  // namespace galactic::bake
