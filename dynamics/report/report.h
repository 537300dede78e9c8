#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/episodes/comparison.h"
#include "dynamics/options.h"
#include "dynamics/report/moments.h"
#include "galactic/world.h"

namespace galactic::dynamics {

/// A share with its 95 % interval (Wilson 1927).
struct Share {
  std::uint32_t count = 0;
  std::uint32_t of = 0;
  double share = 0;
  double low = 0;
  double high = 0;
};
[[nodiscard]] Share wilson(std::uint32_t count, std::uint32_t of);

/// What a report is about.
struct ReportSubject {
  ComparisonMode mode = ComparisonMode::kReplay;
  /// Name of the recording that was replayed, or of the policy that closed the loop.
  std::string played;
  WorldOptions world;
  /// Only for a closed loop.
  LoopOptions loop;
  std::vector<std::string> warnings;
};

/// The options that affect the report, including those of the closed loop if it is one.
[[nodiscard]] std::vector<OptionText> optionsOf(const ReportSubject& subject);

/// Everything from which a report is made.
struct Comparisons {
  std::vector<EpisodeComparison> episodes;
  std::vector<Moment> worst;
};

/// The report as JSON, and as a table for people. Only reports of replays say how far the worlds
/// are apart step by step, as actions differ in a closed loop. Reports contain no times, so they do
/// not depend on the number of threads.
[[nodiscard]] std::string reportJson(const Comparisons& comparisons, const World& world,
                                     const ReportSubject& subject);
[[nodiscard]] std::string reportTable(const Comparisons& comparisons, const World& world,
                                      const ReportSubject& subject);

}  // namespace galactic::dynamics
