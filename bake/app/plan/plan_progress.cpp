#include "plan/plan_progress.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "galactic/printable.h"

namespace galactic::bake {
namespace {

std::string clockText(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(seconds));
  const std::uint64_t minutes = whole / 60;
  if (minutes < 60) return fmt::format("{}:{:02}", minutes, whole % 60);
  return fmt::format("{}:{:02}:{:02}", minutes / 60, minutes % 60, whole % 60);
}

}  // namespace

PlanProgress::PlanProgress(std::size_t count, Verbosity verbosity)
    : count_(count), verbosity_(verbosity), line_(verbosity >= Verbosity::kNormal) {}

void PlanProgress::begin(const std::string& pack) {
  const std::lock_guard lock(mutex_);
  running_.insert(pack);
  show();
}

void PlanProgress::end(const PackOutcome& pack) {
  const std::lock_guard lock(mutex_);
  running_.erase(pack.name);
  ++done_;
  if (pack.state == PackState::kBaked) ++baked_;
  line_.clear();
  if (pack.error) printError(*pack.error);
  const bool is_news = pack.state == PackState::kBaked || verbosity_ == Verbosity::kVerbose;
  if (verbosity_ >= Verbosity::kNormal && is_news && !pack.error) {
    fmt::print("  [{}/{}] {} {} in {:.1f} s\n", done_, count_, printable(pack.name),
               nameOf(pack.state), pack.seconds);
    std::fflush(stdout);
  }
  show();
}

void PlanProgress::show() {
  if (running_.empty()) return line_.clear();
  std::string left = "?";
  // What was found in the cache says nothing of how long the rest takes.
  if (baked_ > 0) {
    const double each = secondsSince(start_) / static_cast<double>(baked_);
    left = clockText(each * static_cast<double>(count_ - done_));
  }
  line_.show(fmt::format("{}/{}, {} left", done_, count_, left), printable(*running_.begin()),
             static_cast<double>(done_) / static_cast<double>(count_));
}

}  // namespace galactic::bake
