#include "galactic/option_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include "support/option_rules.h"
#include "support/option_table.h"
#include "support/text/height_text.h"
#include "support/text/range_text.h"

namespace galactic {
namespace {

/// Collects names.
class Namer {
 public:
  Namer(std::vector<std::string>& names, bool with_presets)
      : names_(names), with_presets_(with_presets) {}

  void group(std::string_view) {}
  template <class... Rest>
  void whole(std::string_view name, const Rest&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void seed(std::string_view name, const Rest&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void real(std::string_view name, const Rest&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void drawn(std::string_view name, const Rest&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void heights(std::string_view name, const Rest&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void flag(std::string_view name, const Rest&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void choice(std::string_view name, const Rest&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void preset(std::string_view name, const Rest&...) {
    if (with_presets_) names_.emplace_back(name);
  }

 private:
  std::vector<std::string>& names_;
  bool with_presets_;
};

/// Collects names of numbers that episodes may draw.
class DrawnNamer {
 public:
  explicit DrawnNamer(std::vector<std::string>& names) : names_(names) {}

  template <class... Rest>
  void drawn(std::string_view name, const Rest&...) {
    names_.emplace_back(name);
  }
  void group(std::string_view) {}
  template <class... Rest>
  void whole(const Rest&...) {}
  template <class... Rest>
  void seed(const Rest&...) {}
  template <class... Rest>
  void real(const Rest&...) {}
  template <class... Rest>
  void heights(const Rest&...) {}
  template <class... Rest>
  void flag(const Rest&...) {}
  template <class... Rest>
  void choice(const Rest&...) {}
  template <class... Rest>
  void preset(const Rest&...) {}

 private:
  std::vector<std::string>& names_;
};

/// Collects names and values.
class Lister {
 public:
  explicit Lister(std::vector<OptionText>& list) : list_(list) {}

  void group(std::string_view) {}
  void whole(std::string_view name, std::uint32_t value, Within<std::uint32_t>, std::string_view) {
    add(name, fmt::format("{}", value), false);
  }
  void seed(std::string_view name, std::uint64_t value, std::string_view) {
    add(name, fmt::format("{}", value), false);
  }
  void real(std::string_view name, float value, Within<float>, std::string_view) {
    add(name, fmt::format("{}", value), false);
  }
  void drawn(std::string_view name, const auto& value, const auto&, std::string_view) {
    add(name, drawnText(value), value.isRange());
  }
  void heights(std::string_view name, std::span<const Span> value, const Span&, std::string_view) {
    add(name, heightText(value), true);
  }
  void flag(std::string_view name, const Switch& value, std::string_view) {
    add(name, value.field == value.when_typed ? "true" : "false", false);
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T value, const std::array<Named<T>, N>& names,
              std::string_view) {
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const Named<T>& one) { return one.value == value; });
    add(name, found == names.end() ? "" : std::string(found->name), true);
  }
  /// The values are in its parts.
  template <class T>
  void preset(std::string_view, const T&, const Preset<T>&, std::string_view) {}

 private:
  void add(std::string_view name, std::string value, bool is_word) {
    list_.push_back({std::string(name), std::move(value), is_word});
  }

  std::vector<OptionText>& list_;
};

/// Sets the options from texts.
class Setter {
 public:
  Setter(std::span<const OptionText> texts, bool with_presets)
      : texts_(texts), taken_(texts.size()), with_presets_(with_presets) {}

  void group(std::string_view) {}
  void whole(std::string_view name, std::uint32_t& field, Within<std::uint32_t> within,
             std::string_view) {
    number(name, field, within);
  }
  void seed(std::string_view name, std::uint64_t& field, std::string_view) {
    number(name, field, Within<std::uint64_t>{0, UINT64_MAX});
  }
  void real(std::string_view name, float& field, Within<float> within, std::string_view) {
    number(name, field, within);
  }
  template <class T>
  void drawn(std::string_view name, T& field, const auto& within, std::string_view) {
    const std::string* text = take(name);
    if (text == nullptr) return;
    const std::optional<T> number = drawnFrom(*text, within);
    require(number.has_value(), wantedDrawn(within));
    if (number) field = *number;
  }
  void heights(std::string_view name, std::vector<Span>& field, const Span& within,
               std::string_view) {
    const std::string* text = take(name);
    if (text == nullptr) return;
    std::optional<std::vector<Span>> heights = heightsFrom(*text, within);
    require(heights.has_value(), wantedHeights(within));
    if (heights) field = std::move(*heights);
  }
  void flag(std::string_view name, const Switch& value, std::string_view) {
    const std::string* text = take(name);
    if (text == nullptr) return;
    require(*text == "true" || *text == "false", "true or false");
    value.field = (*text == "true") == value.when_typed;
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& field, const std::array<Named<T>, N>& names,
              std::string_view) {
    choose<T>(name, field, names);
  }
  template <class T>
  void preset(std::string_view name, T& field, const Preset<T>& preset, std::string_view) {
    if (with_presets_) choose<T>(name, field, preset.names);
  }

  [[nodiscard]] std::optional<OptionFault> fault() const {
    if (fault_) return fault_;
    const auto left = std::find(taken_.begin(), taken_.end(), false);
    if (left == taken_.end()) return std::nullopt;
    return OptionFault{static_cast<std::size_t>(left - taken_.begin()), {}};
  }

 private:
  const std::string* take(std::string_view name) {
    for (std::size_t n = 0; n < texts_.size(); ++n) {
      if (texts_[n].name != name) continue;
      last_ = n;
      taken_[n] = true;
      return &texts_[n].value;
    }
    return nullptr;
  }

  template <class T>
  void choose(std::string_view name, T& field, std::span<const Named<T>> names) {
    const std::string* text = take(name);
    if (text == nullptr) return;
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const Named<T>& one) { return one.name == *text; });
    require(found != names.end(), namesOf<T>(names));
    if (found != names.end()) field = found->value;
  }

  template <class T>
  void number(std::string_view name, T& field, Within<T> within) {
    const std::string* text = take(name);
    if (text == nullptr) return;
    T value{};
    const char* end = text->data() + text->size();
    const auto [stop, problem] = std::from_chars(text->data(), end, value);
    const bool is_good =
        problem == std::errc() && stop == end && value >= within.least && value <= within.most;
    require(is_good, fmt::format("{} to {}", within.least, within.most));
    if (is_good) field = value;
  }

  /// For the text that was taken last.
  void require(bool is_good, std::string wanted) {
    if (!is_good && !fault_) fault_ = OptionFault{last_, std::move(wanted)};
  }

  std::span<const OptionText> texts_;
  std::vector<bool> taken_;
  bool with_presets_;
  std::size_t last_ = 0;
  std::optional<OptionFault> fault_;
};

/// Finds the first value that is out of its range.
class Checker {
 public:
  void group(std::string_view) {}
  void whole(std::string_view name, std::uint32_t value, Within<std::uint32_t> within,
             std::string_view) {
    number(name, value, within);
  }
  void seed(std::string_view, std::uint64_t, std::string_view) {}
  void real(std::string_view name, float value, Within<float> within, std::string_view) {
    number(name, value, within);
  }
  void drawn(std::string_view name, const auto& value, const auto& within, std::string_view) {
    if (!isDrawnWithin(value, within)) refuse(name, drawnText(value), wantedDrawn(within));
  }
  void heights(std::string_view name, std::span<const Span> value, const Span& within,
               std::string_view) {
    if (!areHeights(value, within)) refuse(name, heightText(value), wantedHeights(within));
  }
  void flag(std::string_view, const Switch&, std::string_view) {}
  template <class T, std::size_t N>
  void choice(std::string_view name, T value, const std::array<Named<T>, N>& names,
              std::string_view) {
    const bool is_good =
        std::ranges::any_of(names, [&](const Named<T>& one) { return one.value == value; });
    if (!is_good) refuse(name, static_cast<unsigned>(value), namesOf<T>(names));
  }
  /// The values are in its parts.
  template <class T>
  void preset(std::string_view, const T&, const Preset<T>&, std::string_view) {}

  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  template <class T>
  void number(std::string_view name, T value, Within<T> within) {
    // Written so that NaN is not within.
    const bool is_good = value >= within.least && value <= within.most;
    if (!is_good) refuse(name, value, fmt::format("{} to {}", within.least, within.most));
  }
  template <class T>
  void refuse(std::string_view name, const T& value, std::string_view wanted) {
    if (fault_.empty()) fault_ = fmt::format("{} is {}, expected {}", name, value, wanted);
  }

  std::string fault_;
};

template <class Visitor>
void visit(SimulationOptions& options, OptionScope scope, Visitor& visitor) {
  if (scope == OptionScope::kTask) {
    visitWorldTask(options, visitor);
  } else if (scope == OptionScope::kRobotNoise) {
    visitNoiseOptions(options.noise, visitor);
  } else {
    visitOptions(options, visitor);
  }
}

}  // namespace

std::vector<std::string> optionNames(OptionScope scope) {
  std::vector<std::string> names;
  SimulationOptions options;
  Namer namer(names, scope == OptionScope::kTyped);
  visit(options, scope, namer);
  return names;
}

std::vector<std::string> drawnOptionNames() {
  std::vector<std::string> names;
  SimulationOptions options;
  DrawnNamer namer(names);
  visitOptions(options, namer);
  return names;
}

std::vector<OptionText> listOptions(const SimulationOptions& options, OptionScope scope) {
  std::vector<OptionText> list;
  SimulationOptions copy = options;
  Lister lister(list);
  visit(copy, scope, lister);
  return list;
}

std::optional<OptionFault> setOptions(std::span<const OptionText> texts, OptionScope scope,
                                      SimulationOptions& options) {
  Setter setter(texts, scope == OptionScope::kTyped);
  visit(options, scope, setter);
  return setter.fault();
}

Result<void> checkOptions(const SimulationOptions& options) {
  SimulationOptions copy = options;
  Checker checker;
  visitOptions(copy, checker);
  if (!checker.fault().empty()) {
    return fail(ErrorCode::kInvalidInput, "simulation options", checker.fault());
  }
  if (!isOneOfRanks(options)) {
    return fail(ErrorCode::kInvalidInput, "simulation options",
                fmt::format("rank is {}, expected a number below ranks, which is {}", options.rank,
                            options.ranks));
  }
  constexpr std::uint64_t kMostEnvs = std::uint64_t{1} << 32U;
  const std::uint64_t all = std::uint64_t{options.ranks} * options.envs;
  if (all <= kMostEnvs) return {};
  return fail(
      ErrorCode::kInvalidInput, "simulation options",
      fmt::format("ranks is {} and envs is {}: {} envs in all, expected at most {}, as envs "
                  "have numbers of 32 bits; take fewer ranks or fewer envs for each",
                  options.ranks, options.envs, all, kMostEnvs));
}

}  // namespace galactic
