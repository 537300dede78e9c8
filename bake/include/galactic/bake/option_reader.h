#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/option_field.h"
#include "galactic/bake/toml_table.h"
#include "galactic/error.h"

namespace galactic::bake {

/// An option as a command line or a file gives it.
struct GivenOption {
  /// Long name without dashes.
  std::string name;
  /// At least one.
  std::vector<GivenValue> values;
  /// For messages: "--eps", or "world.toml:7: eps".
  std::string place;
};

/// The options of a table in `file`, without those that `passes` lets pass. A list of numbers is
/// one value, a list of texts or of lists are several, a table gives NAME=VALUE each. Fails with
/// kInvalidInput on values that are none of these.
[[nodiscard]] Result<std::vector<GivenOption>> givenIn(
    const TomlTable& table, const std::string& file,
    const std::function<bool(std::string_view)>& passes = {});

/// Gives the options of structs the values that were given, as a visitor of these structs.
class OptionReader final : public OptionVisitor {
 public:
  /// What becomes of a path that is given; empty: it stays as it is.
  using FindPath = std::function<Result<std::filesystem::path>(const std::filesystem::path&)>;

  /// `given` outlives the reader. Of two with one name the last counts.
  explicit OptionReader(std::span<const GivenOption> given, FindPath find = {})
      : given_(given), find_(std::move(find)) {}

  using OptionVisitor::option;
  void option(const OptionInfo& info, OptionField& field) override;

  [[nodiscard]] bool isGiven(std::string_view name) const;
  /// A fault of a given option; nothing where it is not given.
  [[nodiscard]] Result<void> refuse(std::string_view name, std::string message) const;
  /// Fails with the first fault, or where an option was given that none of the structs has: it is
  /// for other structs than those of `what` ("--as scene"), or not among the `known`.
  [[nodiscard]] Result<void> finish(std::string_view what,
                                    const std::vector<std::string>& known) const;

 private:
  [[nodiscard]] const GivenOption* find(std::string_view name) const;

  std::span<const GivenOption> given_;
  FindPath find_;
  std::set<std::string, std::less<>> taken_;
  std::optional<Error> error_;
};

}  // namespace galactic::bake
