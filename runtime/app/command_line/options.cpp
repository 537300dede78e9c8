#include "command_line/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/command_line_visitor.h"
#include "command_line/render_command_line.h"
#include "galactic/error.h"
#include "run/tracked_run.h"
#include "support/console/standard_streams.h"
#include "support/option_rules.h"
#include "support/option_table.h"
#include "support/text/help_lines.h"
#include "support/text/nearest_name.h"
#include "support/text/printable.h"

namespace galactic {
namespace {

constexpr const char* kFooter =
    "Any option of the groups below \"Options\" starts a simulation; without one, packs are\n"
    "described.\n"
    "Examples:\n"
    "  galactic-run world.pack\n"
    "  galactic-run world.pack --envs 1024 --steps 1000 --policy random\n"
    "  galactic-run world.pack --steps 100 --record run.rec\n"
    "  galactic-run world.pack --steps 100 --envs 4 --render rgbd --contact-sheet run.png\n"
    "  galactic-run world.pack --policy picker.pack --contact-sheet run.png --render rgb\n"
    "  galactic-run world.pack --policy scripted --steps 500 --envs 4 --view run.html\n"
    "  galactic-run world.pack --policy replay:run.rec";
/// Perhaps the first message that a newcomer reads.
constexpr const char* kNoPack =
    "found no pack; name one to open and verify it (galactic-run world.pack), or a world to step "
    "(galactic-run world.pack --steps 1000); galactic-bake makes packs";
constexpr const char* kPackOption = "PACK,--pack";
constexpr const char* kReplayPrefix = "replay:";
constexpr const char* kPolicySuffix = ".pack";

/// PACK and --pack are one option with two lines in --help, of which only the first says that it is
/// required.
class RunHelp : public HelpLines<CLI::Formatter, CLI::Option> {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    if (is_positional || !option->get_positional()) {
      return HelpLines::make_option(option, is_positional);
    }
    std::ostringstream line;
    CLI::detail::format_help(line, make_option_name(option, false) + " FILE ...",
                             "The same as PACK", get_column_width());
    return line.str();
  }
};

void addPlainOptions(CLI::App& app, RunOptions& options) {
  app.set_version_flag("--version", "galactic-run " GALACTIC_VERSION);
  app.add_option(kPackOption, options.packs, "Packs to open: one world, or packs of any kind")
      ->required()
      ->type_name("FILE");
}

/// What is wrong with the options taken together; empty if nothing is.
std::string faultOf(const RunOptions& options) {
  if (options.bench && options.simulates) {
    return "--bench measures queries and simulates nothing; leave it out, or the other options";
  }
  if (options.bench && options.is_quiet) {
    return "--quiet leaves out the table, which is all that --bench makes; leave out one of them";
  }
  if (options.bench && options.simulation.seed > std::numeric_limits<std::uint32_t>::max()) {
    return "--bench takes a --seed up to 4294967295";
  }
  if (options.is_deterministic && options.policyFile().empty()) {
    return "--deterministic applies to learned policies only; add --policy FILE.pack";
  }
  const bool is_tracked = !options.view.empty() || !options.animation.empty();
  const std::uint64_t kept =
      options.view.empty() ? 1 : std::min(options.view_envs, options.simulation.envs);
  if (is_tracked && options.steps > TrackedRun::kMostSteps / kept) {
    return fmt::format(
        "--view and --animation keep what envs do: {} steps of {} envs were asked for, at most {} "
        "together fit; ask for fewer --steps or --view-envs",
        options.steps, kept, TrackedRun::kMostSteps);
  }
  if (!isOneOfRanks(options.simulation)) {
    return fmt::format("--rank is {}, expected a number below --ranks, which is {}",
                       options.simulation.rank, options.simulation.ranks);
  }
  return {};
}

/// Reports an option that was typed without the option that it is a detail of; empty if there is
/// none.
std::string loneDetail(const CLI::App& app, const RunOptions& options) {
  if (options.view.empty() && app.count("--view-envs") > 0) {
    return "--view-envs applies to the page of a run only; add --view FILE.html";
  }
  if (options.policyFile().empty() && app.count("--sampled") > 0) {
    return "--sampled applies to learned policies only; add --policy FILE.pack";
  }
  if (!options.simulates && !options.bench && app.count("--seed") > 0) {
    return "--seed applies to simulations and --bench only; add --steps N, for example";
  }
  return {};
}

std::vector<std::string> longNamesOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
  return names;
}

/// What is wrong with a command line that cannot be parsed. The parser complains about missing
/// packs before it complains about an unknown option, which may be what was typed in their place.
std::string complaintOf(const CLI::App& app, const CLI::ParseError& error) {
  std::string complaint = error.what();
  if (error.get_name() == "RequiredError") {
    const std::vector<std::string> rest = app.remaining();
    const auto unknown =
        std::ranges::find_if(rest, [](const std::string& word) { return word.starts_with('-'); });
    if (unknown == rest.end()) return kNoPack;
    complaint = "The following argument was not expected: " + *unknown;
  }
  return withSuggestions(complaint, longNamesOf(app));
}

/// Options that begin with `prefix`, except `main`, and that have no effect if `is_off`.
struct Details {
  std::string_view prefix;
  std::string_view main;
  bool is_off;
  std::string_view what_to_do;
};

/// Reports a simulation option that was typed but has no effect; empty if there is none.
std::string withoutEffect(const CLI::App& app, const SimulationOptions& simulation) {
  const SensorOptions& sensors = simulation.sensors;
  const TaskOptions& task = simulation.task;
  const std::array details{
      Details{"--laser-", "--laser-beams", sensors.laser.beams == 0,
              "applies to a laser scan only; add --laser-beams N"},
      Details{"--geodesic-megabytes",
              {},
              !findsPaths(simulation),
              "applies to paths along the floor only; add --geodesic or --geodesic-weight X"},
      Details{"--drop-penalty",
              {},
              task.drop_fails,
              "applies to what safe drop overlooks only; add --safe-drop"},
      Details{"--terminate-after",
              {},
              !task.needs_terminate || task.kind != TaskKind::kRearrange,
              "applies to a task that ends with the terminate action only: rearrange without "
              "--no-terminate"},
      Details{"--slide-", "--slide-attempts", simulation.slide.attempts == 0,
              "applies to robots that slide, and sliding is off; leave it out"},
      Details{"--place-", "--place-attempts", simulation.placement.attempts == 0,
              "applies to objects that are placed, and --place-attempts is 0; leave it out"}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_name();
    for (const Details& one : details) {
      if (!one.is_off || !name.starts_with(one.prefix) || name == one.main) continue;
      return fmt::format("{} {}", name, one.what_to_do);
    }
    if (task.kind == TaskKind::kNone && option->get_group() == kRewardGroup) {
      return name + " applies to the reward of a task, and --task is none; leave it out";
    }
  }
  return {};
}

}  // namespace

int refuseCommandLine(std::string_view message) {
  printToStderr(fmt::format("galactic-run: command line: {}; see --help\n", printable(message)));
  return kExitUsage;
}

std::string RunOptions::replayFile() const {
  const std::string_view prefix = kReplayPrefix;
  return policy.starts_with(prefix) ? policy.substr(prefix.size()) : std::string();
}

std::string RunOptions::policyFile() const {
  return replayFile().empty() && policy.ends_with(kPolicySuffix) ? policy : std::string();
}

std::optional<int> parseCommandLine(int argc, const char* const* argv, RunOptions& options) {
  CLI::App app{"Opens and verifies packs, or steps a world of them.", "galactic-run"};
  app.footer(std::string(kFooter) + "\n\n" + kExitCodesHelp);
  constexpr std::size_t kHelpColumn = 34;
  app.formatter(std::make_shared<RunHelp>());
  app.get_formatter()->column_width(kHelpColumn);
  addPlainOptions(app, options);
  CommandLineVisitor visitor(app);
  visitRunOptions(options, visitor);
  visitBatchOptions(options.simulation, visitor);
  visitWorldTask(options.simulation, visitor);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // For --help and --version.
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return refuseCommandLine(complaintOf(app, error));
  }
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results()) {
      if (value.empty()) return refuseCommandLine(option->get_name() + " has an empty value");
    }
    options.simulates |= option->count() > 0 && option->get_group() != kPlainGroup;
  }
  std::string fault = faultOf(options);
  if (fault.empty()) fault = loneDetail(app, options);
  options.drawing.policy_may_draw = !options.policyFile().empty();
  if (fault.empty()) fault = drawingFault(options.drawing, app);
  options.simulation.body_transforms |= options.drawing.draws();
  options.without_effect = withoutEffect(app, options.simulation);
  return fault.empty() ? std::nullopt : std::optional<int>(refuseCommandLine(fault));
}

}  // namespace galactic
