#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pack_tool/verbs/verbs.h"

// What the texts of options mean. A text that means nothing is a CLI::ValidationError, which says
// what was found and what was expected.
namespace galactic::pack_tool {

/// Fills `numbers` with as many finite ones as it has room for, separated by commas.
void parseNumbers(const std::string& option, const std::string& text, std::span<double> numbers);

/// Exactly `Count` of them.
template <std::size_t Count>
std::array<double, Count> parseNumbers(const std::string& option, const std::string& text) {
  std::array<double, Count> numbers{};
  parseNumbers(option, text, numbers);
  return numbers;
}

/// "name=value,name=value" as joint values, of --joints.
[[nodiscard]] std::vector<JointValue> parseJoints(const std::string& text);

/// "mesh,spheres", of --what.
[[nodiscard]] LayerSet parseLayers(const std::string& text);

/// Turns one of `names` into the number of its value. CLI's own transformer takes these numbers,
/// too.
template <class T>
CLI::Validator choice(std::map<std::string, T> names) {
  return CLI::Validator(
      [names = std::move(names)](std::string& text) {
        const auto found = names.find(text);
        if (found != names.end()) {
          text = std::to_string(static_cast<int>(found->second));
          return std::string();
        }
        std::string wanted;
        for (const auto& [name, value] : names) wanted += (wanted.empty() ? "" : ", ") + name;
        return fmt::format("found \"{}\", expected one of {}", text, wanted);
      },
      "", "choice");
}

}  // namespace galactic::pack_tool
