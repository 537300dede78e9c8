#include <fmt/format.h>

#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"

namespace galactic::pack_tool {

namespace {

/// How a spread is shown: its numbers, and what stands behind them and behind the mean.
struct SpreadForm {
  std::string (*number)(double);
  std::string_view unit;
  std::string (*mean)(double);
};

constexpr SpreadForm kObjectsPerEpisode{[](double count) { return fmt::format("{:.6g}", count); },
                                        " per episode",
                                        [](double mean) { return fmt::format("{:.3g}", mean); }};
constexpr SpreadForm kDistances{[](double length) { return fmt::format("{:.2f}", length); }, " m",
                                [](double mean) { return fmt::format("{:.2f} m", mean); }};

/// Least, greatest and mean; one number where all are the same.
std::string spreadOf(const Json& spread, const SpreadForm& form) {
  if (spread.is_null()) return "none";
  const std::string least = form.number(numberOf(spread.at("min")));
  const std::string most = form.number(numberOf(spread.at("max")));
  if (least == most) return fmt::format("{}{}", least, form.unit);
  return fmt::format("{} to {}{}, {} on average", least, most, form.unit,
                     form.mean(numberOf(spread.at("mean"))));
}

std::string namesOf(const Json& names) {
  std::string text;
  for (const Json& name : names) text += (text.empty() ? "" : ", ") + textOf(name);
  return text.empty() ? "none" : text;
}

}  // namespace

std::string episodesText(const Json& set) {
  TextTable scenes(4);
  scenes.add({"scene", "episodes"});
  for (const Json& scene : set.at("scenes")) {
    scenes.add({textOf(scene.at("name")), countOf(scene.at("episodes"))});
  }
  TextTable objects(4);
  objects.add({"object", "placed", "as target"});
  for (const Json& object : set.at("objects")) {
    objects.add({textOf(object.at("name")), countOf(object.at("placements")),
                 countOf(object.at("targets"))});
  }
  const Json& robot = set.at("robot");
  return labeled("name", textOf(set.at("name"))) +
         labeled("episodes", countOf(set.at("episode_count"))) +
         labeled("robot", robot.is_null() ? "any" : textOf(robot)) +
         labeled("start joints", namesOf(set.at("start_joints"))) +
         labeled("objects", spreadOf(set.at("objects_per_episode"), kObjectsPerEpisode)) +
         labeled("to the goal", spreadOf(set.at("target_to_goal"), kDistances)) + scenes.text() +
         objects.text();
}

}  // namespace galactic::pack_tool
