#include "run/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "support/text/counted.h"
#include "support/text/printable.h"

namespace galactic {
namespace {

constexpr double kNano = 1e-9;

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

double ratio(std::uint64_t part, std::uint64_t whole) {
  return ratio(static_cast<double>(part), static_cast<double>(whole));
}

std::string percent(double share) { return fmt::format("{:.2f} %", 100 * share); }

std::string line(std::string_view name, std::string_view text) {
  return fmt::format("  {:<14}{}\n", name, text);
}

std::string rate(const RunReport& report, double seconds) {
  const double per_second = ratio(static_cast<double>(report.sum.steps), seconds);
  return fmt::format("{:>12.0f} steps/s{:>12.3f} s", per_second, seconds);
}

std::string phaseTable(const RunReport& report) {
  double all = 0;
  for (const PhaseTime& phase : report.phases) all += phase.seconds;
  const auto stepped = static_cast<double>(report.sampled_steps) *
                       static_cast<double>(report.options.simulation.envs);
  std::string text = line("phase", fmt::format("{:>12}{:>12}", "ns per step", "share"));
  for (const PhaseTime& phase : report.phases) {
    text += line(fmt::format("  {}", phase.name),
                 fmt::format("{:>12.1f}{:>12}", ratio(phase.seconds / kNano, stepped),
                             percent(ratio(phase.seconds, all))));
  }
  return text;
}

std::string skippedLine(const RunReport& report) {
  constexpr std::size_t kListed = 10;
  std::string text = fmt::format("{} of {} episodes", report.skipped.size(), report.world_episodes);
  for (std::size_t n = 0; n < std::min(kListed, report.skipped.size()); ++n) {
    text += fmt::format("{}{}", n == 0 ? ": " : ", ", report.skipped[n]);
  }
  if (report.skipped.size() > kListed) text += ", ...";
  return line("skipped", text);
}

std::string episodeLines(const RunReport& report) {
  const SimulationStatistics& sum = report.sum;
  const EpisodeSums& episodes = report.episodes;
  const std::size_t playable = report.world_episodes - report.skipped.size();
  const bool is_once = report.options.simulation.order == EpisodeOrder::kPartition;
  const std::string of_all = is_once ? fmt::format(" of {}", playable) : "";
  // Without a task, nobody has to pick the target.
  const bool is_asked = report.options.simulation.task.kind != TaskKind::kNone;
  const std::string picked = is_asked ? fmt::format("; {} picked", sum.picks) : "";
  std::string text = line(
      "episodes", fmt::format("{}{} ended: {}, {}, {} out of time{}", sum.episodes, of_all,
                              counted(sum.successes, "success"), counted(sum.failures, "failure"),
                              sum.episodes - sum.successes - sum.failures, picked));
  // If no episode has ended, there is no mean.
  if (episodes.ended == 0) return text;
  return text +
         line("return", fmt::format("{:.4f} in {:.1f} steps, means of the episodes that ended",
                                    ratio(episodes.returns, static_cast<double>(episodes.ended)),
                                    ratio(episodes.steps, episodes.ended)));
}

/// Which options of the task come from the world, and which options of the world were overridden.
std::string taskLine(const RunReport& report) {
  if (report.world_task.empty()) return {};
  std::string in_force;
  std::string overridden;
  for (const OptionText& option : report.world_task) {
    std::string& list = isInForce(option, report.options) ? in_force : overridden;
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", option.name, option.value);
  }
  if (!overridden.empty()) {
    overridden = fmt::format("{}not {}", in_force.empty() ? "" : "; ", overridden);
  }
  return line("world's task", in_force + overridden);
}

std::string renderLines(const RunReport& report) {
  const DrawingOptions& drawing = report.options.drawing;
  const RenderReport& drawn = *report.rendering;
  constexpr double kMilli = 1e-3;
  const double larger = std::max(drawn.rendering.mean(), drawn.physics.mean());
  std::string text =
      line("drawing",
           fmt::format("{} {} x {}, camera {}, by {}", drawing.images, drawing.width,
                       drawing.height, printable(drawing.camera), printable(drawn.description))) +
      line("images", fmt::format("{:>12.0f} images/s{:>11.3f} s",
                                 ratio(static_cast<double>(drawn.images), report.step_seconds),
                                 report.step_seconds));
  // A short run may have no step of each kind to measure.
  if (drawn.overlapped.steps == 0) return text;
  return text +
         line("one step",
              fmt::format("{:.3f} ms of rendering, {:.3f} ms of physics",
                          drawn.rendering.mean() / kMilli, drawn.physics.mean() / kMilli)) +
         line("  overlapped",
              fmt::format("{:.3f} ms, {:.2f} of the larger part", drawn.overlapped.mean() / kMilli,
                          ratio(drawn.overlapped.mean(), larger)));
}

std::string learnedLine(const RunReport& report) {
  if (!report.learned) return {};
  constexpr double kMicro = 1e-6;
  const LearnedReport& learned = *report.learned;
  return line("learned",
              fmt::format("{}, its {} actions; {:.2f} us per env and step", printable(learned.name),
                          learned.samples ? "sampled" : "likeliest",
                          ratio(learned.seconds / kMicro, static_cast<double>(report.sum.steps))));
}

std::string replayLine(const RunReport& report) {
  if (report.options.replayFile().empty()) return {};
  if (report.first_difference) {
    return line("replay", fmt::format("differs at step {}", *report.first_difference));
  }
  return line("replay", counted(report.steps, "step") + ", bit for bit the same");
}

}  // namespace

bool isInForce(const OptionText& option, const RunOptions& options) {
  const std::vector<OptionText> all = listOptions(options.simulation, OptionScope::kTask);
  // Compare values as they are printed, because the pack may write them differently.
  SimulationOptions alone;
  (void)setOptions(std::span(&option, 1), OptionScope::kTask, alone);
  const std::vector<OptionText> wanted = listOptions(alone, OptionScope::kTask);
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (all[n].name == option.name) return all[n].value == wanted[n].value;
  }
  return false;
}

std::string tableOf(const RunReport& report) {
  const RunOptions& options = report.options;
  const SimulationStatistics& sum = report.sum;
  std::string text = fmt::format(
      "{}, {} each, {}, policy {}, seed {}{}\n", counted(options.simulation.envs, "env"),
      counted(report.steps, "step"), counted(report.threads, "thread"), printable(options.policy),
      options.simulation.seed,
      report.is_interrupted ? fmt::format(" (stopped; {} steps were asked for)", options.steps)
                            : "");
  text += taskLine(report);
  text += learnedLine(report);
  text += line("stepping", rate(report, report.step_seconds));
  text += line("whole loop", rate(report, report.loop_seconds));
  if (report.rendering) text += renderLines(report);
  text += line("start-up", fmt::format("{:.3f} s: packs {:.3f}, envs {:.3f}",
                                       report.open_seconds + report.create_seconds,
                                       report.open_seconds, report.create_seconds));
  constexpr double kMegabyte = 1e6;
  text += line("memory", fmt::format("{:.0f} bytes per env, {:.1f} MB for all beside the packs",
                                     ratio(report.memory_bytes, options.simulation.envs),
                                     static_cast<double>(report.shared_bytes) / kMegabyte));
  text += phaseTable(report);
  text += line("moves", fmt::format("{} refused, {} slid", percent(ratio(sum.refused, sum.steps)),
                                    percent(ratio(sum.slid, sum.steps))));
  text += line("hands", fmt::format("{}, {}, {} put back", counted(sum.grasps, "grasp"),
                                    counted(sum.drops, "drop"), sum.restored));
  text += episodeLines(report);
  text += skippedLine(report);
  if (sum.nan_actions > 0) {
    text += line("not a number", counted(sum.nan_actions, "action") + ", taken as 0");
  }
  return text + replayLine(report);
}

}  // namespace galactic
