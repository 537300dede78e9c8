#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "galactic/error.h"
#include "support/nearest_name.h"
#include "support/printable.h"

namespace galactic::dynamics {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  galactic-run world.pack --policy scripted --order partition --record run.rec\n"
    "  galactic-dynamics world.toml --pack world.pack --recording run.rec --report report.json";

std::vector<std::string> longNamesOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
  return names;
}

void addOptions(CLI::App& app, Command& command) {
  app.set_version_flag("--version", "galactic-dynamics " GALACTIC_VERSION);
  app.add_option("recipe", command.recipe, "Recipe that the world was baked from")
      ->required()
      ->option_text("WORLD.toml");
  app.add_option("--pack", command.packs, "Pack of the world; repeat it for several")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE");
  app.add_option("--data", command.data, "Where files of the recipe are that are not beside it")
      ->type_name("DIR");
  app.add_option("--recording", command.recording, "Recording of galactic-run to replay")
      ->required()
      ->type_name("FILE");
  app.add_option("--episodes", command.episodes, "Episodes of the recording; 0: all")
      ->option_text(fmt::format("N [{}]", command.episodes));
  const std::map<std::string, ArmDrive> arms{{"motors", ArmDrive::kMotors},
                                             {"kinematic", ArmDrive::kKinematic}};
  app.add_option_function<std::string>(
         "--arm", [&command, arms](const std::string& text) { command.world.arm = arms.at(text); },
         "What moves the arm")
      ->check(CLI::IsMember(arms))
      ->option_text("motors|kinematic [motors]");
  app.add_option("--friction", command.world.friction,
                 "Of every surface; that of a pair is the product")
      ->check(CLI::Range(0.0, 10.0))
      ->option_text(fmt::format("X [{}]", command.world.friction));
  app.add_option("--threads", command.threads,
                 "Threads; the results do not depend on it; 0: one per processor")
      ->check(CLI::Range(0U, 4096U))
      ->option_text("N [0]");
  app.add_option("--report", command.report, "Write the closing table and each episode as JSON")
      ->type_name("FILE.json");
}

}  // namespace

std::optional<int> parseCommandLine(int argc, const char* const* argv, Command& command) {
  CLI::App app{"Replays a run where things have mass, and says where the two worlds part.",
               "galactic-dynamics"};
  app.footer(std::string(kFooter) + "\n\n" + kExitCodesHelp);
  constexpr std::size_t kHelpColumn = 34;
  app.get_formatter()->column_width(kHelpColumn);
  addOptions(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    fmt::print(stderr, "galactic-dynamics: command line: {}; see --help\n",
               printable(withSuggestions(error.what(), longNamesOf(app))));
    return kExitUsage;
  }
  return std::nullopt;
}

}  // namespace galactic::dynamics
