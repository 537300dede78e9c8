#include "dynamics/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "dynamics/episodes/robot_driver.h"
#include "dynamics/report/names.h"
#include "dynamics/report/report_sums.h"
#include "support/text/counted.h"

namespace galactic::dynamics {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const Share& share) {
  return {{"count", share.count},
          {"of", share.of},
          {"share", share.share},
          {"interval", {share.low, share.high}}};
}

/// Options as JSON. Numbers and truth values keep their type, unless the option is a word;
/// everything else is text.
Json jsonOf(const std::vector<OptionText>& options) {
  Json json = Json::object();
  for (const auto& [name, text, is_word] : options) {
    const Json value = Json::parse(text, nullptr, /*allow_exceptions=*/false);
    const bool is_plain = !is_word && (value.is_number() || value.is_boolean());
    json[name] = is_plain ? value : Json(text);
  }
  return json;
}

Json successOf(const Sums& sums) {
  const Outcomes& outcomes = sums.outcomes;
  const auto share = [&](std::uint32_t count) { return jsonOf(wilson(count, sums.episodes)); };
  return {{"simulation", share(outcomes.in_simulation)},
          {"dynamics", share(outcomes.in_dynamics)},
          {"dynamics_after_2_s", share(outcomes.settled)},
          {"both", share(outcomes.both)},
          {"picked_in_dynamics", share(outcomes.picked)},
          {"lost_before_picking", outcomes.lost_picking},
          {"lost_after_picking", outcomes.lost_later}};
}

Json contactsOf(const Sums& sums, const World& world) {
  Json causes = Json::object();
  for (const auto& [cause, count] : sums.missedByCause()) {
    causes[std::string(nameOf(cause))] = sums.perThousand(count);
  }
  Json missed = Json::array();
  for (const auto& [key, count] : sums.missed) {
    const auto& [link, thing, cause] = key;
    missed.push_back({{"link", world.robot().linkName(link)},
                      {"in", nameOf(thing)},
                      {"cause", nameOf(cause)},
                      {"per_1000_steps", sums.perThousand(count)}});
  }
  Json invented = Json::object();
  for (const auto& [cause, count] : sums.invented) {
    invented[std::string(nameOf(cause))] = sums.perThousand(count);
  }
  return {{"tolerance", kTolerance},
          {"missed_per_1000_steps", sums.perThousand(sums.missed_steps)},
          {"missed_by_cause", causes},
          {"missed", missed},
          {"hindered_per_1000_steps", sums.perThousand(sums.hindered)},
          {"invented_per_1000_steps", sums.perThousand(sums.inventedSteps())},
          {"invented_by_cause", invented}};
}

Json releasesOf(const Sums& sums) {
  const auto count = static_cast<std::uint32_t>(sums.displacements.size());
  if (count == 0) return {{"count", 0}};
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

/// The gap after the last step; none if the dynamics made no step.
std::optional<float> lastOf(std::span<const float> gaps) {
  return gaps.empty() ? std::nullopt : std::optional(gaps.back());
}

template <class T>
Json jsonOf(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json jsonOf(const EpisodeComparison& episode) {
  Json rests = Json::array();
  for (const Rest& rest : episode.rests) {
    rests.push_back({{"step", rest.step + 1},
                     {"displacement", rest.displacement},
                     {"lean", rest.lean},
                     {"drop", rest.drop}});
  }
  Json parted = nullptr;
  if (episode.parted) parted = *episode.parted + 1;
  return {{"env", episode.env},
          {"episode", episode.episode},
          {"steps", episode.steps},
          {"end", nameOf(episode.end)},
          {"steps_in_dynamics", episode.steps_in_dynamics},
          {"end_in_dynamics", nameOf(episode.end_in_dynamics)},
          {"success_settled", episode.success_settled},
          {"picked_in_dynamics", episode.picked_in_dynamics},
          {"parted", parted},
          {"last_base_gap", jsonOf(lastOf(episode.base_gap))},
          {"last_grip_gap", jsonOf(lastOf(episode.grip_gap))},
          {"missed_steps", episode.missed_steps},
          {"disturbed", episode.disturbed},
          {"rests", rests}};
}

Json worstOf(const Comparisons& comparisons, const World& world) {
  Json worst = Json::array();
  for (const Moment& moment : comparisons.worst) {
    const EpisodeComparison& episode = comparisons.episodes[moment.comparison];
    worst.push_back({{"kind", nameOf(moment.kind)},
                     {"episode", episode.episode},
                     {"step", moment.step + 1},
                     {"meters", moment.meters},
                     {"text", describe(moment, episode, world)}});
  }
  return worst;
}

double meanTracking(const Sums& sums, const World& world) {
  const double count = static_cast<double>(sums.steps_in_dynamics) *
                       static_cast<double>(world.robot().controlledJoints().size());
  return count == 0 ? 0 : sums.tracking_sum / count;
}

std::string percent(const Share& share) {
  return fmt::format("{:5.1f} % ({:.1f} to {:.1f})", 100 * share.share, 100 * share.low,
                     100 * share.high);
}

Sums sumsOf(const Comparisons& comparisons, const ReportSubject& subject) {
  Sums sums = sumOf(comparisons.episodes);
  if (subject.mode == ComparisonMode::kClosedLoop) sums.gaps.clear();
  return sums;
}

/// Lines of names and values, with the values aligned.
class Table {
 public:
  void line(std::string name, std::string value) {
    lines_.emplace_back(std::move(name), std::move(value));
  }
  void line(std::string name, double value) { line(std::move(name), fmt::format("{:.2f}", value)); }
  [[nodiscard]] std::string text() const {
    std::size_t width = 0;
    for (const auto& [name, value] : lines_) width = std::max(width, name.size());
    std::string text;
    for (const auto& [name, value] : lines_)
      text += fmt::format("{:<{}}  {}\n", name, width, value);
    return text;
  }

 private:
  std::vector<std::pair<std::string, std::string>> lines_;
};

void addSuccess(const Sums& sums, Table& table) {
  const Outcomes& outcomes = sums.outcomes;
  const auto share = [&](std::uint32_t count) { return percent(wilson(count, sums.episodes)); };
  table.line("success in the simulation", share(outcomes.in_simulation));
  table.line("success in the dynamics", share(outcomes.in_dynamics));
  table.line("  and still after 2 s", share(outcomes.settled));
  table.line("target picked in the dynamics", share(outcomes.picked));
  table.line("successes lost before, after picking",
             fmt::format("{}, {}", outcomes.lost_picking, outcomes.lost_later));
}

/// A line about the released objects; just "0" if there are none.
std::string releasesText(const Sums& sums) {
  if (sums.displacements.empty()) return "0";
  return fmt::format(
      "{}; 2 s later {:.3f} m away, 95 % {:.3f} m; {} over 5 cm, {} tipped, {} fallen",
      sums.displacements.size(), quantile(sums.displacements, 0.5),
      quantile(sums.displacements, 0.95), sums.away(), sums.tipped, sums.fallen);
}

void addContacts(const Sums& sums, const World& world, Table& table) {
  table.line("missed contacts, of 1,000 steps", sums.perThousand(sums.missed_steps));
  for (const auto& [cause, count] : sums.missedByCause()) {
    table.line(fmt::format("  {}", nameOf(cause)), sums.perThousand(count));
    for (const auto& [key, steps] : sums.missed) {
      const auto& [link, thing, of] = key;
      if (of != cause) continue;
      table.line(fmt::format("    {} in {}", world.robot().linkName(link), nameOf(thing)),
                 sums.perThousand(steps));
    }
  }
  table.line("hindered steps, of 1,000", sums.perThousand(sums.hindered));
  table.line("  by nothing", sums.perThousand(sums.inventedSteps()));
  for (const auto& [cause, count] : sums.invented) {
    table.line(fmt::format("    {}", nameOf(cause)), sums.perThousand(count));
  }
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

std::vector<OptionText> optionsOf(const ReportSubject& subject) {
  std::vector<OptionText> options = listOptions(subject.world);
  if (subject.mode == ComparisonMode::kClosedLoop) {
    std::ranges::move(listOptions(subject.loop), std::back_inserter(options));
  }
  return options;
}

std::string reportJson(const Comparisons& comparisons, const World& world,
                       const ReportSubject& subject) {
  const Sums sums = sumsOf(comparisons, subject);
  Json each = Json::array();
  for (const EpisodeComparison& episode : comparisons.episodes) each.push_back(jsonOf(episode));
  const Json report{
      {"mode", nameOf(subject.mode)},
      {subject.mode == ComparisonMode::kReplay ? "recording" : "policy", subject.played},
      {"options", jsonOf(optionsOf(subject))},
      {"episodes", sums.episodes},
      {"steps", sums.steps},
      {"steps_in_dynamics", sums.steps_in_dynamics},
      {"success", successOf(sums)},
      {"tracking_error", {{"mean", meanTracking(sums, world)}, {"worst", sums.tracking_worst}}},
      {"divergence", gapsOf(sums)},
      {"contacts", contactsOf(sums, world)},
      {"disturbed_objects", sums.disturbed},
      {"releases", releasesOf(sums)},
      {"worst", worstOf(comparisons, world)},
      {"warnings", subject.warnings},
      {"each", each}};
  return report.dump(2) + "\n";
}

std::string reportTable(const Comparisons& comparisons, const World& world,
                        const ReportSubject& subject) {
  const Sums sums = sumsOf(comparisons, subject);
  Table table;
  table.line("episodes, steps in both worlds",
             fmt::format("{}, {}, {}", sums.episodes, sums.steps, sums.steps_in_dynamics));
  addSuccess(sums, table);
  table.line("joint error, mean and worst",
             fmt::format("{:.4f}, {:.3f}", meanTracking(sums, world), sums.tracking_worst));
  for (const Gap& gap : sums.gaps) {
    table.line("apart after " + counted(gap.step, "step"),
               fmt::format("base {:.3f} m, 95 % {:.3f} m; grip {:.3f} m, 95 % {:.3f} m",
                           quantile(gap.base, 0.5), quantile(gap.base, 0.95),
                           quantile(gap.grip, 0.5), quantile(gap.grip, 0.95)));
  }
  addContacts(sums, world, table);
  table.line("objects disturbed", fmt::format("{}", sums.disturbed));
  table.line("objects let go", releasesText(sums));
  for (const Moment& moment : comparisons.worst) {
    table.line(&moment == comparisons.worst.data() ? "worst moments" : "",
               describe(moment, comparisons.episodes[moment.comparison], world));
  }
  return table.text();
}

}  // namespace galactic::dynamics
