#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/world.h"
#include "replay.h"

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
struct ReplaySubject {
  std::string recording;
  ArmDrive arm = ArmDrive::kMotors;
  std::vector<std::string> warnings;
};

/// The report as JSON, and as a table for people. The same for any number of threads: no times.
[[nodiscard]] std::string reportJson(const std::vector<EpisodeReplay>& episodes, const World& world,
                                     const ReplaySubject& subject);
[[nodiscard]] std::string reportTable(const std::vector<EpisodeReplay>& episodes,
                                      const World& world);

}  // namespace galactic::dynamics
