#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"

namespace galactic::pack_tool {

namespace {

/// "0.1, 0, -0.2 UNIT"; nothing where all three are 0.
std::string threeText(const Json& three, const std::string& before, const std::string& unit) {
  if (std::ranges::all_of(three, [](const Json& one) { return numberOf(one) == 0; })) return "";
  return fmt::format("{}{:.4g}, {:.4g}, {:.4g} {}", before, numberOf(three.at(0)),
                     numberOf(three.at(1)), numberOf(three.at(2)), unit);
}

std::string imageText(const Json& image) {
  if (image.is_null()) return "none";
  std::string channels = image.at("color").get<bool>() ? "color" : "";
  if (image.at("depth").get<bool>()) {
    channels += fmt::format("{}depth to {} m", channels.empty() ? "" : " and ",
                            lengthOf(image.at("depth_limit")));
  }
  std::string text = fmt::format("{} x {}, {}, camera {}", countOf(image.at("width")),
                                 countOf(image.at("height")), channels, textOf(image.at("camera")));
  const double fov = numberOf(image.at("vertical_fov"));
  if (fov > 0) text += fmt::format(", {:.4g} degrees", fov * 180 / std::numbers::pi);
  text += threeText(image.at("position"), ", at ", "m ahead, left, up");
  text += threeText(image.at("rpy_degrees"), ", turned by ", "degrees of roll, pitch, yaw");
  if (const double near = numberOf(image.at("near")); near > 0) {
    text += fmt::format(", drawn from {:.4g} m", near);
  }
  return text;
}

/// Beside its kind and inputs: numbers as they are, weights by their count.
std::string fieldsText(const Json& layer) {
  std::string text;
  for (const auto& [name, value] : layer.items()) {
    if (name == "kind" || name == "inputs" || value.is_null() || value.is_object()) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, value.dump());
  }
  return text;
}

std::string inputsText(const Json& inputs) {
  std::string text;
  for (const Json& input : inputs) text += (text.empty() ? "" : ", ") + countOf(input);
  return text;
}

std::size_t weightsOf(const Json& layer) {
  std::size_t count = 0;
  for (const Json& field : layer) {
    if (field.is_object()) count += field.at("count").get<std::size_t>();
  }
  return count;
}

std::string actionsText(const Json& policy) {
  const Json& continuous = policy.at("continuous");
  const std::string numbers = continuous.is_null() ? "0" : countOf(continuous.at("count"));
  return fmt::format("{} continuous, {} discrete", numbers, policy.at("discrete").size());
}

}  // namespace

std::string policyText(const Json& policy) {
  std::string options;
  for (const Json& option : policy.at("options")) {
    if (!options.empty()) options += ", ";
    options += textOf(option.at("name")) + " " + textOf(option.at("value"));
  }
  std::string observation;
  for (const Json& part : policy.at("observation")) {
    if (!observation.empty()) observation += ", ";
    observation += fmt::format("{} ({})", textOf(part.at("name")), countOf(part.at("size")));
  }
  const std::string robot = textOf(policy.at("robot"));
  TextTable table(4);
  table.add({"layer", "reads", "weights"});
  std::size_t number = 0;
  for (const Json& layer : policy.at("layers")) {
    const std::string fields = fieldsText(layer);
    table.add({fmt::format("{} {}{}{}", number++, textOf(layer.at("kind")),
                           fields.empty() ? "" : ": ", fields),
               inputsText(layer.at("inputs")), countOf(Json(weightsOf(layer)))});
  }
  return labeled("policy", textOf(policy.at("name"))) +
         labeled("robot", robot.empty() ? "any with as many actions" : robot) +
         labeled("options", options.empty() ? "as the world has them" : options) +
         labeled("observation", observation.empty() ? "none" : observation) +
         labeled("image", imageText(policy.at("image"))) + labeled("actions", actionsText(policy)) +
         labeled("weights", countOf(policy.at("weights"))) + table.text();
}

}  // namespace galactic::pack_tool
