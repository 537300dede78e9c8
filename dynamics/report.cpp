#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "robot_driver.h"

namespace galactic::dynamics {
namespace {

using Json = nlohmann::ordered_json;

/// Farther is away, leaning more is tipped, lower is fallen: meters, radians, meters.
constexpr double kAway = 0.05;
constexpr double kTipped = std::numbers::pi / 6;
constexpr double kFallen = 0.1;

/// The value that `share` of the values do not exceed, 0 of none.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

/// How far the worlds are apart after so many steps, of the episodes that are as long.
struct Gap {
  std::size_t step = 0;
  std::vector<double> base;
  std::vector<double> grip;
};

/// All episodes together.
struct Sums {
  std::uint32_t here = 0;
  std::uint32_t there = 0;
  std::uint32_t settled = 0;
  std::uint32_t both = 0;
  std::uint32_t picked = 0;
  std::uint32_t disturbed = 0;
  std::uint64_t steps = 0;
  std::uint64_t missed_steps = 0;
  std::uint64_t hindered = 0;
  std::uint64_t invented = 0;
  std::map<std::pair<std::uint32_t, Thing>, std::uint64_t> missed;
  double tracking_sum = 0;
  double tracking_worst = 0;
  std::vector<double> displacements;
  std::uint32_t tipped = 0;
  std::uint32_t fallen = 0;
  std::vector<Gap> gaps;

  [[nodiscard]] double perThousand(std::uint64_t count) const {
    return steps == 0 ? 0 : 1000 * static_cast<double>(count) / static_cast<double>(steps);
  }
  [[nodiscard]] std::uint32_t away() const {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(displacements, [](double d) { return d > kAway; }));
  }
};

void addGaps(const EpisodeReplay& episode, Sums& sums) {
  for (Gap& gap : sums.gaps) {
    if (episode.base_gap.size() < gap.step) continue;
    gap.base.push_back(static_cast<double>(episode.base_gap[gap.step - 1]));
    gap.grip.push_back(static_cast<double>(episode.grip_gap[gap.step - 1]));
  }
}

void addRests(const EpisodeReplay& episode, Sums& sums) {
  for (const Rest& rest : episode.rests) {
    sums.displacements.push_back(static_cast<double>(rest.displacement));
    sums.tipped += static_cast<double>(rest.lean) > kTipped ? 1U : 0U;
    sums.fallen += static_cast<double>(rest.drop) > kFallen ? 1U : 0U;
  }
}

Sums sumOf(const std::vector<EpisodeReplay>& episodes) {
  Sums sums;
  for (const std::size_t step : std::to_array<std::size_t>({1, 10, 20, 50, 100, 200, 500})) {
    sums.gaps.push_back({.step = step, .base = {}, .grip = {}});
  }
  for (const EpisodeReplay& episode : episodes) {
    const bool here = episode.end == EpisodeEnd::kSuccess;
    sums.here += here ? 1U : 0U;
    sums.there += episode.success_there ? 1U : 0U;
    sums.settled += episode.success_settled ? 1U : 0U;
    sums.both += here && episode.success_there ? 1U : 0U;
    sums.picked += episode.picked_there ? 1U : 0U;
    sums.disturbed += episode.disturbed;
    sums.steps += episode.base_gap.size();
    sums.missed_steps += episode.missed_steps;
    sums.hindered += episode.hindered;
    sums.invented += episode.invented;
    for (const auto& [where, count] : episode.missed) sums.missed[where] += count;
    sums.tracking_sum += episode.tracking_sum;
    sums.tracking_worst = std::max(sums.tracking_worst, episode.tracking_worst);
    addGaps(episode, sums);
    addRests(episode, sums);
  }
  std::erase_if(sums.gaps, [](const Gap& gap) { return gap.base.empty(); });
  return sums;
}

std::string_view nameOf(Thing thing) { return thing == Thing::kScene ? "scene" : "object"; }

std::string_view nameOf(EpisodeEnd end) {
  switch (end) {
    case EpisodeEnd::kNone:
      return "none";
    case EpisodeEnd::kSuccess:
      return "success";
    case EpisodeEnd::kWrongTerminate:
      return "wrong terminate";
    case EpisodeEnd::kWrongRelease:
      return "wrong release";
    case EpisodeEnd::kWrongObject:
      return "wrong object";
    case EpisodeEnd::kTimeOut:
      return "time out";
  }
  return "none";
}

Json jsonOf(const Share& share) {
  return {{"count", share.count},
          {"of", share.of},
          {"share", share.share},
          {"interval", {share.low, share.high}}};
}

Json contactsOf(const Sums& sums, const World& world) {
  Json missed = Json::array();
  for (const auto& [where, count] : sums.missed) {
    missed.push_back({{"link", world.robot().linkName(where.first)},
                      {"in", nameOf(where.second)},
                      {"per_1000_steps", sums.perThousand(count)}});
  }
  return {{"tolerance", kTolerance},
          {"missed_per_1000_steps", sums.perThousand(sums.missed_steps)},
          {"missed", missed},
          {"hindered_per_1000_steps", sums.perThousand(sums.hindered)},
          {"invented_per_1000_steps", sums.perThousand(sums.invented)}};
}

Json releasesOf(const Sums& sums) {
  const auto count = static_cast<std::uint32_t>(sums.displacements.size());
  return {{"count", count},
          {"seconds", 2},
          {"displacement",
           {{"median", quantile(sums.displacements, 0.5)},
            {"p95", quantile(sums.displacements, 0.95)}}},
          {"over_5_cm", jsonOf(wilson(sums.away(), count))},
          {"tipped", jsonOf(wilson(sums.tipped, count))},
          {"fallen", jsonOf(wilson(sums.fallen, count))}};
}

Json gapsOf(const Sums& sums) {
  Json gaps = Json::array();
  for (const Gap& gap : sums.gaps) {
    const auto line = [](const std::vector<double>& values) {
      return Json{{"median", quantile(values, 0.5)}, {"p95", quantile(values, 0.95)}};
    };
    gaps.push_back({{"step", gap.step},
                    {"episodes", gap.base.size()},
                    {"base", line(gap.base)},
                    {"grip", line(gap.grip)}});
  }
  return gaps;
}

Json jsonOf(const EpisodeReplay& episode) {
  Json rests = Json::array();
  for (const Rest& rest : episode.rests) {
    rests.push_back(
        {{"displacement", rest.displacement}, {"lean", rest.lean}, {"drop", rest.drop}});
  }
  return {{"env", episode.env},
          {"episode", episode.episode},
          {"steps", episode.base_gap.size()},
          {"end", nameOf(episode.end)},
          {"success_there", episode.success_there},
          {"success_settled", episode.success_settled},
          {"picked_there", episode.picked_there},
          {"last_base_gap", episode.base_gap.back()},
          {"last_grip_gap", episode.grip_gap.back()},
          {"missed_steps", episode.missed_steps},
          {"disturbed", episode.disturbed},
          {"rests", rests}};
}

double meanTracking(const Sums& sums, const World& world) {
  const double count = static_cast<double>(sums.steps) *
                       static_cast<double>(world.robot().controlledJoints().size());
  return count == 0 ? 0 : sums.tracking_sum / count;
}

std::string percent(const Share& share) {
  return fmt::format("{:5.1f} % ({:.1f} to {:.1f})", 100 * share.share, 100 * share.low,
                     100 * share.high);
}

}  // namespace

Share wilson(std::uint32_t count, std::uint32_t of) {
  if (of == 0) return {};
  constexpr double kZ = 1.959963984540054;
  const double n = of;
  const double share = count / n;
  const double middle = (share + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half =
      kZ / (1 + kZ * kZ / n) * std::sqrt(share * (1 - share) / n + kZ * kZ / (4 * n * n));
  return {count, of, share, std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string reportJson(const std::vector<EpisodeReplay>& episodes, const World& world,
                       const ReplaySubject& subject) {
  const Sums sums = sumOf(episodes);
  const auto count = static_cast<std::uint32_t>(episodes.size());
  Json each = Json::array();
  for (const EpisodeReplay& episode : episodes) each.push_back(jsonOf(episode));
  const Json report{
      {"recording", subject.recording},
      {"arm", subject.arm == ArmDrive::kMotors ? "motors" : "kinematic"},
      {"episodes", count},
      {"steps", sums.steps},
      {"success",
       {{"simulation", jsonOf(wilson(sums.here, count))},
        {"dynamics", jsonOf(wilson(sums.there, count))},
        {"dynamics_after_2_s", jsonOf(wilson(sums.settled, count))},
        {"both", jsonOf(wilson(sums.both, count))},
        {"picked_in_dynamics", jsonOf(wilson(sums.picked, count))}}},
      {"tracking_error", {{"mean", meanTracking(sums, world)}, {"worst", sums.tracking_worst}}},
      {"divergence", gapsOf(sums)},
      {"contacts", contactsOf(sums, world)},
      {"disturbed_objects", sums.disturbed},
      {"releases", releasesOf(sums)},
      {"warnings", subject.warnings},
      {"each", each}};
  return report.dump(2) + "\n";
}

std::string reportTable(const std::vector<EpisodeReplay>& episodes, const World& world) {
  const Sums sums = sumOf(episodes);
  const auto count = static_cast<std::uint32_t>(episodes.size());
  std::string text;
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("{:<34} {}\n", name, value);
  };
  line("episodes, steps", fmt::format("{}, {}", count, sums.steps));
  line("success in the simulation", percent(wilson(sums.here, count)));
  line("success in the dynamics", percent(wilson(sums.there, count)));
  line("  and still after 2 s", percent(wilson(sums.settled, count)));
  line("target picked in the dynamics", percent(wilson(sums.picked, count)));
  line("joint error, mean and worst",
       fmt::format("{:.4f}, {:.3f}", meanTracking(sums, world), sums.tracking_worst));
  for (const Gap& gap : sums.gaps) {
    line(fmt::format("apart after {} steps", gap.step),
         fmt::format("base {:.3f} m, 95 % {:.3f} m; grip {:.3f} m, 95 % {:.3f} m",
                     quantile(gap.base, 0.5), quantile(gap.base, 0.95), quantile(gap.grip, 0.5),
                     quantile(gap.grip, 0.95)));
  }
  line("missed contacts, of 1,000 steps",
       fmt::format("{:.2f}", sums.perThousand(sums.missed_steps)));
  for (const auto& [where, steps] : sums.missed) {
    line(fmt::format("  {} in {}", world.robot().linkName(where.first), nameOf(where.second)),
         fmt::format("{:.2f}", sums.perThousand(steps)));
  }
  line("hindered steps, of 1,000", fmt::format("{:.2f}", sums.perThousand(sums.hindered)));
  line("  by nothing", fmt::format("{:.2f}", sums.perThousand(sums.invented)));
  line("objects disturbed", fmt::format("{}", sums.disturbed));
  line("objects let go",
       fmt::format("{}; 2 s later {:.3f} m away, 95 % {:.3f} m; {} over 5 cm, {} tipped, {} fallen",
                   sums.displacements.size(), quantile(sums.displacements, 0.5),
                   quantile(sums.displacements, 0.95), sums.away(), sums.tipped, sums.fallen));
  return text;
}

}  // namespace galactic::dynamics
