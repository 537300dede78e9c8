#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/render_options.h"
#include "galactic/drawn_number.h"
#include "galactic/sensor_noise.h"
#include "support/option_table.h"
#include "support/text/number_text.h"

namespace galactic {

/// Turns each option of the tables (visitRunOptions, visitOptions) into an option of the command
/// line. Fields change only if their options are typed.
class CommandLineVisitor {
 public:
  explicit CommandLineVisitor(CLI::App& app) : app_(app) {}

  void group(std::string_view heading) { heading_ = heading; }
  template <class T>
  void whole(std::string_view name, T& field, Within<T> within, std::string_view help) {
    add(name, field, help)
        ->check(wholeCheck(within.least, within.most))
        ->option_text(fmt::format("N [{}]", field));
  }
  void seed(std::string_view name, std::uint64_t& field, std::string_view help);
  void real(std::string_view name, float& field, Within<float> within, std::string_view help);
  void wish(std::string_view name, float& field, Within<float> within, Shown shown,
            std::string_view help);
  void three(std::string_view name, std::array<float, 3>& field, float most, Shown shown,
             std::string_view help);
  void point(std::string_view name, std::optional<std::array<float, 3>>& field, float most,
             Shown shown, std::string_view help);
  void drawn(std::string_view name, DrawnNumber& field, const Span& within, std::string_view help);
  void drawn(std::string_view name, DrawnCount& field, std::uint32_t most, std::string_view help);
  void heights(std::string_view name, std::vector<Span>& field, const Span& within,
               std::string_view help);
  void flag(std::string_view name, const Switch& value, std::string_view help);
  void text(std::string_view name, std::string& field, Shown shown, std::string_view help);
  void word(std::string_view name, std::string& field, std::span<const std::string_view> words,
            std::string_view help);
  void size(std::string_view name, DrawingOptions& drawing, std::string_view help);
  void policy(std::string_view name, std::string& field, std::string_view help);
  /// Comes with its opposite, --sampled.
  void likeliest(std::string_view name, bool& field);
  template <class Options>
  void sensor(const SensorOption<Options>& option, Options& options) {
    addDrawn(option.name, options.*option.value, Span{0, option.most}, option.text)
        ->option_text(fmt::format("{}|LOW-HIGH [0]", option.unit));
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& field, const std::array<Named<T>, N>& names,
              std::string_view help) {
    std::string_view now;
    for (const Named<T>& one : names) {
      if (one.value == field) now = one.name;
    }
    addNamed<T>(name, field, names, help)->option_text(shownNames<T>(names, now));
  }
  /// Options are read in the order in which they are added, so that the parts of a preset refine
  /// it.
  template <class T>
  void preset(std::string_view name, T& field, const Preset<T>& preset, std::string_view help) {
    addNamed<T>(name, field, preset.names, help)
        ->option_text(shownNames<T>(preset.names, preset.names.front().name));
  }

 private:
  /// The option as it is typed, with its letter if it has one.
  static std::string dashed(std::string_view name);
  /// Parses "0.1,0,-2": three numbers from -most to most.
  static std::optional<std::array<float, 3>> threeOf(std::string_view text, float most);

  template <class T>
  CLI::Option* add(std::string_view name, T& field, std::string_view help) {
    return app_.add_option(dashed(name), field, std::string(help))->group(heading_);
  }
  /// Adds an option whose text `set` reads.
  template <class Set>
  CLI::Option* addRead(std::string_view name, const Set& set, std::string_view help) {
    return app_.add_option_function<std::string>(dashed(name), set, std::string(help))
        ->group(heading_);
  }
  template <class T, class Limits>
  CLI::Option* addDrawn(std::string_view name, T& field, const Limits& within,
                        std::string_view help) {
    const auto parse = [within](const std::string& text) { return drawnFrom(text, within); };
    return addParsed(name, field, parse, wantedDrawn(within), help);
  }
  /// Adds an option whose text `parse` turns into the value of `field`; if it returns none, the
  /// message asks for `wanted`.
  template <class T, class Parse>
  CLI::Option* addParsed(std::string_view name, T& field, const Parse& parse,
                         const std::string& wanted, std::string_view help) {
    const auto fault_of = [parse, wanted](const std::string& text) {
      if (parse(text)) return std::string();
      return fmt::format("found {}, expected {}", text.empty() ? "nothing" : text, wanted);
    };
    const auto set = [&field, parse](const std::string& text) { field = *parse(text); };
    return addRead(name, set, help)->check(fault_of);
  }
  template <class T>
  CLI::Option* addThree(std::string_view name, T& field, float most, std::string_view help) {
    const auto parse = [most](const std::string& text) { return threeOf(text, most); };
    return addParsed(name, field, parse,
                     fmt::format("three numbers from {} to {} with commas between", -most, most),
                     help);
  }
  template <class T>
  CLI::Option* addNamed(std::string_view name, T& field, std::span<const Named<T>> names,
                        std::string_view help) {
    std::map<std::string, T> values;
    for (const Named<T>& one : names) values.emplace(one.name, one.value);
    const auto set = [&field, values](const std::string& text) { field = values.at(text); };
    return addRead(name, set, help)->check(CLI::IsMember(values));
  }
  template <class T>
  static std::string shownNames(std::span<const Named<T>> names, std::string_view now) {
    std::string listed;
    for (const Named<T>& one : names) {
      listed += (listed.empty() ? "" : "|") + std::string(one.name);
    }
    return fmt::format("{} [{}]", listed, now);
  }

  CLI::App& app_;
  std::string heading_;
};

}  // namespace galactic
