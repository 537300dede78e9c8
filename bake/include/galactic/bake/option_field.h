#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "galactic/bake/episode_generator.h"
#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/pose.h"
#include "support/option_table.h"

namespace galactic::bake {

/// One value as given on a command line or in a file. A text is read as if it were typed.
using GivenWord = std::variant<bool, std::int64_t, double, std::string>;

/// One occurrence of an option: "1,2,3" is one text, [1, 2, 3] in a file is three numbers.
struct GivenValue {
  /// For an entry NAME = VALUE in a table, its name; otherwise empty.
  std::string name;
  std::vector<GivenWord> words;
};

/// What kind of values an option has.
enum class OptionKind {
  kSwitch,
  kChoice,
  kWhole,
  kNumber,
  /// Several numbers, separated by commas.
  kNumbers,
  kText,
  /// A file or folder, whose content is what matters.
  kPath,
  /// NAME=VALUE.
  kNamedText,
  kNamedPath
};

/// The numbers that an option accepts, both ends included unless `above` is set.
struct OptionRange {
  double least = 0;
  double most = 0;
  /// Whether `least` itself is excluded.
  bool above = false;
};

/// One option of a struct: reads and writes the field that it stands for.
class OptionField {
 public:
  OptionField() = default;
  virtual ~OptionField() = default;
  OptionField(const OptionField&) = delete;
  OptionField& operator=(const OptionField&) = delete;

  [[nodiscard]] virtual OptionKind kind() const = 0;
  /// Whether the option may be given several times.
  [[nodiscard]] virtual bool repeats() const { return false; }
  /// Sets the field to the value of `given`, which has at least one element. Returns what is wrong
  /// with it ("found 3, expected a number from 0 to 1"), or an empty string. After a fault, the
  /// field's value is unspecified.
  [[nodiscard]] virtual std::string read(std::span<const GivenValue> given) = 0;
  /// The field's value as it would be typed, one text for each occurrence of the option. None if it
  /// has no value, as for a switch that is off or an option that was not given.
  [[nodiscard]] virtual std::vector<std::string> texts() const = 0;
  /// The files and folders that the field names.
  [[nodiscard]] virtual std::vector<std::filesystem::path*> paths() { return {}; }
  /// The memory of the field, for checking that no field is left out.
  [[nodiscard]] virtual std::span<const std::byte> memory() const = 0;
};

using FieldPointer = std::unique_ptr<OptionField>;

/// The name and the explanation of an option.
struct OptionInfo {
  /// Long name without dashes.
  std::string_view name;
  /// What a value looks like: "METERS", "column|cell"; empty for switches.
  std::string_view form;
  std::string_view help;
};

/// Visits each option of a struct, in a fixed order.
class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;
  /// Begins a group: the options that follow belong together.
  virtual void group(std::string_view /*heading*/) {}
  virtual void option(const OptionInfo& info, OptionField& field) = 0;
  /// A field that is not an option: threads, handles, data read from files.
  virtual void internal(std::span<const std::byte> /*memory*/) {}

  void option(const OptionInfo& info, const FieldPointer& field) { option(info, *field); }
  template <class... T>
  void internals(const T&... fields) {
    (internal(std::as_bytes(std::span(&fields, 1))), ...);
  }
};

// The fields that options are made of. Each keeps a reference to its variable.

/// One number. For std::optional, "not given" is a value of its own.
[[nodiscard]] FieldPointer number(float& field, OptionRange range);
[[nodiscard]] FieldPointer number(double& field, OptionRange range);
[[nodiscard]] FieldPointer number(std::optional<float>& field, OptionRange range);
[[nodiscard]] FieldPointer number(std::optional<double>& field, OptionRange range);
/// A whole number, without sign and leading zeros.
[[nodiscard]] FieldPointer whole(std::uint32_t& field, Within<std::uint64_t> range);
[[nodiscard]] FieldPointer whole(std::uint64_t& field, Within<std::uint64_t> range);
[[nodiscard]] FieldPointer whole(std::optional<std::uint32_t>& field, Within<std::uint64_t> range);
[[nodiscard]] FieldPointer whole(std::optional<std::uint64_t>& field, Within<std::uint64_t> range);
/// A power of two within the range.
[[nodiscard]] FieldPointer powerOfTwo(std::uint32_t& field, Within<std::uint64_t> range);
/// Several numbers. If the option is given again, its numbers are appended.
[[nodiscard]] FieldPointer numbers(std::vector<float>& field, OptionRange range);
/// 12 numbers (three rows) or 16 (four rows, the last one 0,0,0,1).
[[nodiscard]] FieldPointer transform(std::optional<Affine>& field);
/// X,Y,Z; may be repeated.
[[nodiscard]] FieldPointer points(std::vector<Vec3>& field);
/// N, or LEAST,MOST.
[[nodiscard]] FieldPointer counts(CountRange& field, Within<std::uint64_t> range);
/// LEAST, or LEAST,MOST.
[[nodiscard]] FieldPointer distances(DistanceRange& field);
/// The same for a field whose default is treated differently from a given value; `is_default` tells
/// which it is.
[[nodiscard]] FieldPointer distances(DistanceRange& field, bool& is_default);
/// LEAST,MOST.
[[nodiscard]] FieldPointer bounds(DistanceRange& field);
/// A switch: the field gets `when_typed`.
[[nodiscard]] FieldPointer flag(bool& field, bool when_typed = true);
[[nodiscard]] FieldPointer path(std::filesystem::path& field);
/// One file or folder each time.
[[nodiscard]] FieldPointer paths(std::vector<std::filesystem::path>& field);
[[nodiscard]] FieldPointer text(std::string& field);
/// One text each time.
[[nodiscard]] FieldPointer texts(std::vector<std::string>& field);
/// Names, separated by commas.
[[nodiscard]] FieldPointer names(std::vector<std::string>& field);
/// NAME=VALUE each time, with each NAME at most once. `form` is for messages: "OLD=NEW".
[[nodiscard]] FieldPointer namedTexts(std::map<std::string, std::string>& field,
                                      std::string_view form);
[[nodiscard]] FieldPointer namedPaths(std::map<std::string, std::filesystem::path>& field,
                                      std::string_view form);

/// Access to a choice by its position in a list of names, for `choice` below.
struct ChoiceAccess {
  std::vector<std::string_view> names;
  std::function<std::optional<std::size_t>()> get;
  std::function<void(std::size_t)> set;
  std::span<const std::byte> memory;
};
[[nodiscard]] FieldPointer choice(ChoiceAccess access);

/// One of the names. `T` may be the value's type, or a std::optional of it.
template <class T, class V, std::size_t N>
[[nodiscard]] FieldPointer choice(T& field, const std::array<Named<V>, N>& names) {
  ChoiceAccess access;
  for (const Named<V>& one : names) access.names.push_back(one.name);
  access.get = [&field, &names]() -> std::optional<std::size_t> {
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const Named<V>& one) { return field == one.value; });
    if (found == names.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names.begin());
  };
  access.set = [&field, &names](std::size_t n) { field = names[n].value; };
  access.memory = std::as_bytes(std::span(&field, 1));
  return choice(std::move(access));
}

/// A name for values of several fields. The fields' own options may also be given, and then take
/// precedence. The preset itself has no value.
[[nodiscard]] FieldPointer preset(std::vector<std::string_view> names,
                                  std::function<void(std::size_t)> set);

/// An option as given on a command line or in a file.
struct GivenOption {
  /// Long name without dashes.
  std::string name;
  /// At least one.
  std::vector<GivenValue> values;
  /// For messages: "--eps", or "world.toml:7: eps".
  std::string place;
};

/// The options in a TOML file. A list of numbers is one value; a list of texts or of lists is
/// several values; each entry of a table is a NAME=VALUE. Fails with kIo if the file cannot be
/// read, and with kInvalidInput on broken TOML and on values of other kinds.
[[nodiscard]] Result<std::vector<GivenOption>> readOptionFile(const std::filesystem::path& file);

/// A visitor that sets the options of structs to the values that were given.
class OptionReader final : public OptionVisitor {
 public:
  /// Resolves a given path; empty: paths stay as they are.
  using FindPath = std::function<Result<std::filesystem::path>(const std::filesystem::path&)>;

  /// `given` must outlive the reader. If a name occurs twice, the last one counts.
  explicit OptionReader(std::span<const GivenOption> given, FindPath find = {})
      : given_(given), find_(std::move(find)) {}

  using OptionVisitor::option;
  void option(const OptionInfo& info, OptionField& field) override;

  [[nodiscard]] bool isGiven(std::string_view name) const;
  /// The error for a given option that is refused; no error if it was not given.
  [[nodiscard]] Result<void> refuse(std::string_view name, std::string message) const;
  /// Fails with the first fault, or if an option was given that none of the structs has: it is for
  /// other structs than those of `what` ("--as scene"), or it is not among the `known` options.
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
