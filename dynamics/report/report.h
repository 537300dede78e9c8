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

/// What a report is of.
struct ReportSubject {
  ComparisonMode mode = ComparisonMode::kReplay;
  /// Name of the recording that was replayed, or of the policy that closed the loop.
  std::string played;
  WorldOptions world;
  /// Of a closed loop.
  LoopOptions loop;
  std::vector<std::string> warnings;
};

/// The options that decide what the report says: those of a closed loop where it is one.
[[nodiscard]] std::vector<OptionText> optionsOf(const ReportSubject& subject);

/// All that a report is made of.
struct Comparisons {
  std::vector<EpisodeComparison> episodes;
  std::vector<Moment> worst;
};

/// The report as JSON, and as a table for people. How far the worlds are apart step by step is told
/// of replays only: in a closed loop the actions differ. The same for any number of threads: no
/// times.
[[nodiscard]] std::string reportJson(const Comparisons& comparisons, const World& world,
                                     const ReportSubject& subject);
[[nodiscard]] std::string reportTable(const Comparisons& comparisons, const World& world,
                                      const ReportSubject& subject);

}  // namespace galactic::dynamics
