// docs/simulation.md: it has a row for each part of observations and for each end of an episode,
// and names the options of sensors and of the reward.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "galactic/option_text.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/homes/every_option.h"
#include "support/homes/task_twins.h"

namespace galactic::test::simulation_document_test {
namespace {

std::string document() { return fileContent(sourceFolder() / "docs/simulation.md"); }

SimulationOptions everyOption() {
  SimulationOptions options;
  options.threads = 1;
  options.sensors = everySensor();
  options.task = everyReward();
  return options;
}

TEST(SimulationDocument, HasARowForEachPartOfAnObservation) {
  const SmallHome home;
  const BatchSimulator simulator = simulatorOf(home.world(), everyOption());
  const std::string text = document();
  for (const ObservationPart& part : simulator.observationParts()) {
    EXPECT_TRUE(text.find(fmt::format("\n| `{}` |", part.name)) != std::string::npos)
        << "docs/simulation.md has no row \"| `" << part.name << "` |\"; add it to Observations";
  }
}

TEST(SimulationDocument, HasARowForEachEndOfAnEpisode) {
  const std::string text = document();
  for (std::size_t n = 1; n < kEpisodeEnds; ++n) {
    // "wrong object" is kWrongObject.
    std::string name = "k";
    bool begins = true;
    for (const char letter : nameOf(static_cast<EpisodeEnd>(n))) {
      if (letter != ' ') name += begins ? static_cast<char>(letter - 'a' + 'A') : letter;
      begins = letter == ' ';
    }
    EXPECT_TRUE(text.find(fmt::format(" | `{}` |", name)) != std::string::npos)
        << "docs/simulation.md has no row with \"| `" << name << "` |\"; add it to Task";
  }
}

TEST(SimulationDocument, NamesTheOptionsOfSensorsAndOfTheReward) {
  const std::string text = document();
  SimulationOptions plain;
  plain.task.most_steps = everyReward().most_steps;
  plain.task.success_distance = everyReward().success_distance;
  const std::vector<OptionText> defaults = listOptions(plain);
  int named = 0;
  for (const OptionText& option : listOptions(everyOption())) {
    if (std::ranges::find(defaults, option) != defaults.end()) continue;
    std::string field = option.name;
    std::ranges::replace(field, '-', '_');
    ++named;
    EXPECT_TRUE(text.find("`--" + option.name) != std::string::npos ||
                text.find(field + "`") != std::string::npos)
        << "docs/simulation.md names neither `--" << option.name << "` nor `" << field
        << "`; say there what it does";
  }
  EXPECT_GT(named, 20);
}

}  // namespace
}  // namespace galactic::test::simulation_document_test
