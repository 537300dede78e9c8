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

/// One value as a command line or a file gives it. A text is read as it would be typed.
using GivenWord = std::variant<bool, std::int64_t, double, std::string>;

/// An option that is given once: "1,2,3" as one text, [1, 2, 3] of a file as three numbers.
struct GivenValue {
  /// Of an entry in a table, NAME = VALUE; else empty.
  std::string name;
  std::vector<GivenWord> words;
};

/// What the values of an option are.
enum class OptionKind {
  kSwitch,
  kChoice,
  kWhole,
  kNumber,
  /// Several numbers, separated by commas.
  kNumbers,
  kText,
  /// A file or folder: what counts is its content.
  kPath,
  /// NAME=VALUE.
  kNamedText,
  kNamedPath
};

/// The numbers that an option takes, both ends included unless `above`.
struct OptionRange {
  double least = 0;
  double most = 0;
  /// Whether `least` itself is too small.
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
  /// Whether it may be given several times.
  [[nodiscard]] virtual bool repeats() const { return false; }
  /// Gives the field the value of `given`, which has at least one element. Returns what is wrong
  /// with it ("found 3, expected a number from 0 to 1"), else nothing. After a fault the field is
  /// of no use.
  [[nodiscard]] virtual std::string read(std::span<const GivenValue> given) = 0;
  /// The field's value as it would be typed, one text for each time that the option would be given.
  /// None where it has no value: a switch that is off, an option that was not given.
  [[nodiscard]] virtual std::vector<std::string> texts() const = 0;
  /// The files and folders that it names.
  [[nodiscard]] virtual std::vector<std::filesystem::path*> paths() { return {}; }
  /// The memory of the field, for whoever sees that no field is left out.
  [[nodiscard]] virtual std::span<const std::byte> memory() const = 0;
};

using FieldPointer = std::unique_ptr<OptionField>;

/// How an option is called and explained.
struct OptionInfo {
  /// Long name without dashes.
  std::string_view name;
  /// What a value looks like: "METERS", "column|cell"; empty for switches.
  std::string_view form;
  std::string_view help;
};

/// Is told each option of a struct, in a fixed order.
class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;
  /// The options that follow belong together.
  virtual void group(std::string_view /*heading*/) {}
  virtual void option(const OptionInfo& info, OptionField& field) = 0;
  /// A field that the user has no say in: threads, handles, what is read from files.
  virtual void internal(std::span<const std::byte> /*memory*/) {}

  void option(const OptionInfo& info, const FieldPointer& field) { option(info, *field); }
  template <class... T>
  void internals(const T&... fields) {
    (internal(std::as_bytes(std::span(&fields, 1))), ...);
  }
};

// The fields that options are made of. Each keeps a reference.

/// One number. In the optional ones, "not given" is a value of its own.
[[nodiscard]] FieldPointer number(float& field, OptionRange range);
[[nodiscard]] FieldPointer number(double& field, OptionRange range);
[[nodiscard]] FieldPointer number(std::optional<float>& field, OptionRange range);
[[nodiscard]] FieldPointer number(std::optional<double>& field, OptionRange range);
/// A whole number without sign and leading zeros.
[[nodiscard]] FieldPointer whole(std::uint32_t& field, Within<std::uint64_t> range);
[[nodiscard]] FieldPointer whole(std::uint64_t& field, Within<std::uint64_t> range);
[[nodiscard]] FieldPointer whole(std::optional<std::uint32_t>& field, Within<std::uint64_t> range);
[[nodiscard]] FieldPointer whole(std::optional<std::uint64_t>& field, Within<std::uint64_t> range);
/// One of these powers of two.
[[nodiscard]] FieldPointer powerOfTwo(std::uint32_t& field, Within<std::uint64_t> range);
/// Several numbers; given again, they follow the others.
[[nodiscard]] FieldPointer numbers(std::vector<float>& field, OptionRange range);
/// 12 numbers (three rows) or 16 (four rows, the last one 0,0,0,1).
[[nodiscard]] FieldPointer transform(std::optional<Affine>& field);
/// X,Y,Z; may be repeated.
[[nodiscard]] FieldPointer points(std::vector<Vec3>& field);
/// N, or LEAST,MOST.
[[nodiscard]] FieldPointer counts(CountRange& field, Within<std::uint64_t> range);
/// LEAST, or LEAST,MOST.
[[nodiscard]] FieldPointer distances(DistanceRange& field);
/// The same of a field whose default counts for less than what is given; `is_default` tells which.
[[nodiscard]] FieldPointer distances(DistanceRange& field, bool& is_default);
/// LEAST,MOST.
[[nodiscard]] FieldPointer bounds(DistanceRange& field);
/// A switch: the field gets `when_typed`.
[[nodiscard]] FieldPointer flag(bool& field, bool when_typed = true);
[[nodiscard]] FieldPointer path(std::filesystem::path& field);
/// Each time one file or folder.
[[nodiscard]] FieldPointer paths(std::vector<std::filesystem::path>& field);
[[nodiscard]] FieldPointer text(std::string& field);
/// Each time one text.
[[nodiscard]] FieldPointer texts(std::vector<std::string>& field);
/// Names, separated by commas.
[[nodiscard]] FieldPointer names(std::vector<std::string>& field);
/// NAME=VALUE each time, and each NAME once. `form` is for messages: "OLD=NEW".
[[nodiscard]] FieldPointer namedTexts(std::map<std::string, std::string>& field,
                                      std::string_view form);
[[nodiscard]] FieldPointer namedPaths(std::map<std::string, std::filesystem::path>& field,
                                      std::string_view form);

/// A choice by position in a list of names, for `choice` below.
struct ChoiceAccess {
  std::vector<std::string_view> names;
  std::function<std::optional<std::size_t>()> get;
  std::function<void(std::size_t)> set;
  std::span<const std::byte> memory;
};
[[nodiscard]] FieldPointer choice(ChoiceAccess access);

/// One of the names. `T` may be the value's type, or its optional.
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

/// A name for values of several fields, whose own options may be given besides and then count. It
/// has no value itself.
[[nodiscard]] FieldPointer preset(std::vector<std::string_view> names,
                                  std::function<void(std::size_t)> set);

/// An option as a command line or a file gives it.
struct GivenOption {
  /// Long name without dashes.
  std::string name;
  /// At least one.
  std::vector<GivenValue> values;
  /// For messages: "--eps", or "world.toml:7: eps".
  std::string place;
};

/// The options that a TOML file gives. A list of numbers is one value, a list of texts or of lists
/// are several, a table gives NAME=VALUE each. Fails with kIo where the file cannot be read, and
/// with kInvalidInput on broken TOML and on values that are none of these.
[[nodiscard]] Result<std::vector<GivenOption>> readOptionFile(const std::filesystem::path& file);

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
