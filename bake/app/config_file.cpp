#include "config_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string>
#include <variant>

#include "galactic/bake/toml_table.h"
#include "galactic/nearest_name.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

/// They ask for something else than a bake.
constexpr std::array<std::string_view, 4> kNotInFiles{"config", "help", "print-recipe", "version"};

/// A single value as it would be typed.
std::optional<std::string> textOf(const TomlValue& value) {
  if (const auto* text = std::get_if<std::string>(&value.value)) return *text;
  if (const auto* truth = std::get_if<bool>(&value.value)) return *truth ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value.value)) return fmt::format("{}", *whole);
  // The shortest text that reads back as the same number.
  if (const auto* real = std::get_if<double>(&value.value)) return fmt::format("{}", *real);
  return std::nullopt;
}

/// One value, or those of a list.
std::optional<std::vector<std::string>> textsOf(const TomlValue& value) {
  std::vector<std::string> texts;
  const auto* list = std::get_if<TomlArray>(&value.value);
  if (list == nullptr) {
    auto text = textOf(value);
    if (!text) return std::nullopt;
    texts.push_back(std::move(*text));
    return texts;
  }
  for (const TomlValue& element : *list) {
    auto text = textOf(element);
    if (!text) return std::nullopt;
    texts.push_back(std::move(*text));
  }
  return texts;
}

}  // namespace

// Nobody asks for it.
std::string ConfigFile::to_config(const CLI::App*, bool, bool, std::string) const { return {}; }

std::vector<CLI::ConfigItem> ConfigFile::from_config(std::istream& input) const {
  const std::string text{std::istreambuf_iterator<char>(input), {}};
  const std::string file = app_.get_config_ptr()->as<std::string>();
  const auto table = parseToml(text, file);
  if (!table) {
    throw CLI::ConfigError(fmt::format("{}: {}", table.error().where, table.error().message));
  }
  std::vector<CLI::ConfigItem> found;
  for (const TomlEntry& entry : *table) {
    const auto refuse = [&](const std::string& message) {
      throw CLI::ConfigError(
          fmt::format("{}:{}: {} {}", file, entry.value.line, entry.key, message));
    };
    const bool is_known = app_.get_option_no_throw("--" + entry.key) != nullptr;
    if (!is_known) refuse("is no option; " + suggestNames("--" + entry.key, longNamesOf(app_)));
    if (std::ranges::find(kNotInFiles, entry.key) != kNotInFiles.end()) {
      refuse("belongs on the command line; leave it out");
    }
    auto texts = textsOf(entry.value);
    if (!texts) refuse("is a table or a list of lists, a value or a list of values is wanted");
    CLI::ConfigItem item;
    item.name = entry.key;
    item.inputs = std::move(*texts);
    found.push_back(std::move(item));
  }
  return found;
}

}  // namespace galactic::bake
