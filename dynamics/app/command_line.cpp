#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <limits>
#include <map>
#include <memory>

#include "command_line/policy_command_line.h"
#include "galactic/error.h"
#include "run/policy.h"
#include "support/console/standard_streams.h"
#include "support/text/help_lines.h"
#include "support/text/nearest_name.h"
#include "support/text/number_text.h"
#include "support/text/printable.h"

namespace galactic::dynamics {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  galactic-run world.pack --policy scripted --order partition --record run.rec\n"
    "  galactic-dynamics world.toml world.pack --recording run.rec --report report.json\n"
    "  galactic-dynamics world.toml world.pack --policy scripted --view both.html\n"
    "  galactic-dynamics world.toml world.pack --policy picker.pack --arm kinematic";
constexpr std::string_view kPolicySuffix = ".pack";

std::vector<std::string> longNamesOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
  return names;
}

/// Adds the options that visitOptions() lists to the parser; the fields must outlive it.
class Registrar {
 public:
  explicit Registrar(CLI::App& app) : app_(app) {}

  /// An option whose value is one of several words.
  template <class T, std::size_t N>
  void choice(const char* name, T& field, const std::array<std::string_view, N>& names,
              const char* help) {
    std::map<std::string, T> values;
    std::string listed;
    for (std::size_t n = 0; n < N; ++n) {
      values.emplace(names[n], static_cast<T>(n));
      listed += (n == 0 ? "" : "|") + std::string(names[n]);
    }
    const auto set = [&field, values](const std::string& text) { field = values.at(text); };
    app_.add_option_function<std::string>(dashed(name), set, help)
        ->check(CLI::IsMember(values))
        ->option_text(fmt::format("{} [{}]", listed, names[static_cast<std::size_t>(field)]));
  }
  void real(const char* name, double& field, Within<double> range, const char* help) {
    app_.add_option(dashed(name), field, help)
        ->check(numberCheck(range.least, range.most))
        ->option_text(fmt::format("X [{}]", field));
  }
  void whole(const char* name, std::uint64_t& field, Within<std::uint64_t> range,
             const char* help) {
    app_.add_option(dashed(name), field, help)
        ->check(wholeCheck(range.least, range.most))
        ->option_text(fmt::format("N [{}]", field));
  }
  void sampling(bool& is_deterministic) { addSampling(app_, is_deterministic); }
  void task(const char* name, std::vector<OptionText>& field, const char* help) {
    const auto set = [&field](const std::vector<std::string>& texts) {
      for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        field.push_back({text.substr(0, equals), text.substr(equals + 1)});
      }
    };
    app_.add_option_function<std::vector<std::string>>(dashed(name), set, help)
        ->check([](const std::string& text) {
          const bool is_pair = text.find('=') != std::string::npos;
          return is_pair ? std::string() : "expected NAME=VALUE, found " + text;
        })
        ->allow_extra_args(false)
        ->option_text("NAME=VALUE");
  }

 private:
  static std::string dashed(const char* name) { return fmt::format("--{}", name); }

  CLI::App& app_;
};

CLI::Validator knownPolicy() {
  return CLI::Validator(
      [](const std::string& text) {
        if (text == kScriptedPolicy || text.ends_with(kPolicySuffix)) return std::string();
        return unknownPolicy(text, "scripted or FILE.pack");
      },
      "", "policy");
}

void addSources(CLI::App& app, Command& command) {
  app.set_version_flag("--version", "galactic-dynamics " GALACTIC_VERSION);
  app.add_option("RECIPE", command.recipe, "Recipe that the world was baked from: WORLD.toml")
      ->required()
      ->type_name("");
  app.add_option("PACK", command.packs, "The world's pack, or its packs")
      ->required()
      ->type_name("");
  app.add_option("--data", command.data, "Where files of the recipe are that are not beside it")
      ->type_name("DIR");
}

void addActions(CLI::App& app, Command& command) {
  app.add_option("--recording", command.recording, "Replay this recording of galactic-run")
      ->type_name("FILE");
  app.add_option("--policy", command.policy,
                 "Close the loop: this policy acts on what it observes in the dynamics")
      ->check(knownPolicy())
      ->option_text("scripted|FILE.pack");
  Registrar registrar(app);
  visitOptions(command.loop, registrar);
  app.add_option("--episodes", command.episodes, "How many episodes, the first ones; 0: all")
      ->check(wholeCheck(0, std::numeric_limits<std::uint32_t>::max()))
      ->option_text(fmt::format("N [{}]", command.episodes));
}

void addOutputs(CLI::App& app, Command& command) {
  app.add_option("-j,--threads", command.threads,
                 "Threads; the results do not depend on it; 0: one per processor")
      ->check(wholeCheck(0, 4096))
      ->option_text("N [0]");
  app.add_option("--report", command.report,
                 "Write the closing table and each episode as JSON; a run that is interrupted goes "
                 "on from FILE.json.partial")
      ->type_name("FILE.json");
  app.add_option("--view", command.shown.view,
                 "Write a page that plays the worst episodes in both worlds")
      ->type_name("FILE.html");
  app.add_option("--pictures", command.shown.pictures,
                 "Write a sheet of the worst moments, both worlds side by side")
      ->type_name("FILE.png");
  app.add_flag("-q,--quiet", command.is_quiet, "Only errors")->check(switchCheck());
}

/// What is wrong with the combination of options; empty if nothing is.
std::string faultOf(const CLI::App& app, const Command& command) {
  if (command.recording.empty() == command.policy.empty()) {
    return "give either --recording, to replay it, or --policy, to close the loop";
  }
  if (command.loop.is_deterministic && command.policyFile().empty()) {
    return "--deterministic applies to learned policies only; add --policy FILE.pack";
  }
  for (const char* option : {"--seed", "--set"}) {
    if (command.mode() == ComparisonMode::kReplay && app.count(option) > 0) {
      return fmt::format("{} applies to a closed loop only: a recording has its own", option);
    }
  }
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results()) {
      if (value.empty()) return option->get_name() + " has an empty value";
    }
  }
  return {};
}

}  // namespace

std::filesystem::path Command::policyFile() const {
  return policy.ends_with(kPolicySuffix) ? std::filesystem::path(policy) : std::filesystem::path();
}

std::optional<int> parseCommandLine(int argc, const char* const* argv, Command& command) {
  CLI::App app{"Plays episodes where things have mass, and says where the two worlds part.",
               "galactic-dynamics"};
  app.footer(std::string(kFooter) + "\n\n" + kExitCodesHelp);
  constexpr std::size_t kHelpColumn = 34;
  app.formatter(std::make_shared<HelpLines<CLI::Formatter, CLI::Option>>());
  app.get_formatter()->column_width(kHelpColumn);
  addSources(app, command);
  addActions(app, command);
  Registrar registrar(app);
  visitOptions(command.world, registrar);
  addOutputs(app, command);
  std::string fault;
  try {
    app.parse(argc, argv);
    fault = faultOf(app, command);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    fault = withSuggestions(error.what(), longNamesOf(app));
  }
  if (fault.empty()) return std::nullopt;
  printToStderr(fmt::format("galactic-dynamics: command line: {}; see --help\n", printable(fault)));
  return kExitUsage;
}

}  // namespace galactic::dynamics
