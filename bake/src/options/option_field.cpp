#include "galactic/bake/option_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

#include "support/number_text.h"

namespace galactic::bake {
namespace {

/// Beyond every length, factor and count that is meant.
constexpr double kMostNumber = 1e12;

template <class T>
std::span<const std::byte> memoryOf(const T& field) {
  return std::as_bytes(std::span(&field, 1));
}

struct WordText {
  std::string operator()(bool truth) const { return truth ? "true" : "false"; }
  std::string operator()(std::int64_t whole) const { return fmt::format("{}", whole); }
  /// The shortest text that reads back as the same number.
  std::string operator()(double real) const { return fmt::format("{}", real); }
  std::string operator()(const std::string& text) const { return text; }
};

std::string textOf(const GivenWord& word) { return std::visit(WordText{}, word); }

/// As it would be typed.
std::string textOf(const GivenValue& value) {
  std::vector<std::string> words;
  words.reserve(value.words.size());
  for (const GivenWord& word : value.words) words.push_back(textOf(word));
  return fmt::format("{}{}{}", value.name, value.name.empty() ? "" : "=", fmt::join(words, ","));
}

std::string found(std::string_view shown, std::string_view wanted) {
  return fmt::format("found {}, expected {}", shown, wanted);
}

/// Numbers, or why they are none.
struct ReadNumbers {
  std::vector<double> values;
  std::string fault;
};

std::optional<double> numberOf(std::string_view text) {
  double number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

void readText(std::string_view text, ReadNumbers& numbers) {
  for (std::size_t begin = 0; begin <= text.size() && numbers.fault.empty();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    const std::optional<double> number = numberOf(part);
    if (!number || !std::isfinite(*number)) {
      numbers.fault =
          fmt::format("has \"{}\" in \"{}\", expected numbers separated by commas", part, text);
    } else if (std::fabs(*number) > kMostNumber) {
      numbers.fault =
          fmt::format("has \"{}\" in \"{}\", expected numbers up to {:g}", part, text, kMostNumber);
    } else {
      numbers.values.push_back(*number);
    }
    begin = end + 1;
  }
}

/// The numbers of all words, texts split at their commas.
ReadNumbers readNumbers(const GivenValue& value) {
  ReadNumbers numbers;
  for (const GivenWord& word : value.words) {
    if (!numbers.fault.empty()) break;
    readText(textOf(word), numbers);
  }
  return numbers;
}

std::string wantedOf(const OptionRange& range) {
  const bool has_most = range.most < kMostNumber;
  if (!range.above && has_most) {
    return fmt::format("a number from {} to {}", range.least, range.most);
  }
  std::string wanted =
      fmt::format("a number {} {}", range.above ? "above" : "of at least", range.least);
  return has_most ? wanted + fmt::format(" and up to {}", range.most) : wanted;
}

bool isWithin(double number, const OptionRange& range) {
  // False for NaN.
  const bool is_high_enough = range.above ? number > range.least : number >= range.least;
  return is_high_enough && number <= std::min(range.most, kMostNumber);
}

/// A field that takes one number.
template <class Field, class Value>
class NumberField final : public OptionField {
 public:
  NumberField(Field& field, OptionRange range) : field_(field), range_(range) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kNumber; }
  std::string read(std::span<const GivenValue> given) override {
    const std::string shown = textOf(given.front());
    const std::optional<double> number = numberOf(shown);
    if (!number || !isWithin(*number, range_)) return found(shown, wantedOf(range_));
    field_ = static_cast<Value>(*number);
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    const std::optional<Value> value = field_;
    if (!value) return {};
    return {fmt::format("{}", *value)};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  Field& field_;
  OptionRange range_;
};

/// A field that takes one whole number.
template <class Field, class Value>
class WholeField final : public OptionField {
 public:
  WholeField(Field& field, Within<std::uint64_t> range, bool is_power)
      : field_(field), range_(range), is_power_(is_power) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kWhole; }
  std::string read(std::span<const GivenValue> given) override {
    const std::string shown = textOf(given.front());
    std::string fault = wholeFault(shown, range_.least, range_.most);
    if (!fault.empty()) return fault;
    std::uint64_t value = 0;
    (void)std::from_chars(shown.data(), shown.data() + shown.size(), value);
    if (is_power_ && !std::has_single_bit(value)) {
      return found(shown, fmt::format("a power of two up to {}", range_.most));
    }
    field_ = static_cast<Value>(value);
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    const std::optional<Value> value = field_;
    if (!value) return {};
    return {fmt::format("{}", *value)};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  Field& field_;
  Within<std::uint64_t> range_;
  bool is_power_;
};

class NumbersField final : public OptionField {
 public:
  NumbersField(std::vector<float>& field, OptionRange range) : field_(field), range_(range) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kNumbers; }
  [[nodiscard]] bool repeats() const override { return true; }
  std::string read(std::span<const GivenValue> given) override {
    field_.clear();
    for (const GivenValue& value : given) {
      const ReadNumbers read = readNumbers(value);
      if (!read.fault.empty()) return read.fault;
      for (const double number : read.values) {
        if (!isWithin(number, range_)) return found(fmt::format("{}", number), wantedOf(range_));
        field_.push_back(static_cast<float>(number));
      }
    }
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (field_.empty()) return {};
    return {fmt::format("{}", fmt::join(field_, ","))};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  std::vector<float>& field_;
  OptionRange range_;
};

class TransformField final : public OptionField {
 public:
  explicit TransformField(std::optional<Affine>& field) : field_(field) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kNumbers; }
  std::string read(std::span<const GivenValue> given) override {
    const auto [values, fault] = readNumbers(given.front());
    if (!fault.empty()) return fault;
    const bool has_last_row = values.size() == 16 && values[12] == 0 && values[13] == 0 &&
                              values[14] == 0 && values[15] == 1;
    if (values.size() != 12 && !has_last_row) {
      return fmt::format(
          "has {} numbers, expected 12 (three rows of four), or 16 whose last row is 0,0,0,1",
          values.size());
    }
    field_.emplace();
    std::copy_n(values.begin(), field_->size(), field_->begin());
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (!field_) return {};
    return {fmt::format("{}", fmt::join(*field_, ","))};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  std::optional<Affine>& field_;
};

class PointsField final : public OptionField {
 public:
  explicit PointsField(std::vector<Vec3>& field) : field_(field) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kNumbers; }
  [[nodiscard]] bool repeats() const override { return true; }
  std::string read(std::span<const GivenValue> given) override {
    field_.clear();
    for (const GivenValue& value : given) {
      const auto [values, fault] = readNumbers(value);
      if (!fault.empty()) return fault;
      if (values.size() != 3) {
        return fmt::format("has {} numbers in \"{}\", expected 3", values.size(), textOf(value));
      }
      field_.push_back({static_cast<float>(values[0]), static_cast<float>(values[1]),
                        static_cast<float>(values[2])});
    }
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    std::vector<std::string> all;
    for (const Vec3& at : field_) all.push_back(fmt::format("{},{},{}", at.x, at.y, at.z));
    return all;
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  std::vector<Vec3>& field_;
};

class CountsField final : public OptionField {
 public:
  CountsField(CountRange& field, Within<std::uint64_t> range) : field_(field), range_(range) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kNumbers; }
  std::string read(std::span<const GivenValue> given) override {
    const auto [values, fault] = readNumbers(given.front());
    if (!fault.empty()) return fault;
    const auto is_count = [&](double number) {
      return number == std::floor(number) && number >= static_cast<double>(range_.least) &&
             number <= static_cast<double>(range_.most);
    };
    if (values.size() > 2 || !std::all_of(values.begin(), values.end(), is_count)) {
      return fmt::format("is \"{}\", expected a whole number from {} to {} or two of them",
                         textOf(given.front()), range_.least, range_.most);
    }
    field_ = {static_cast<std::uint32_t>(values.front()),
              static_cast<std::uint32_t>(values.back())};
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    return {fmt::format("{},{}", field_.least, field_.most)};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  CountRange& field_;
  Within<std::uint64_t> range_;
};

class DistancesField final : public OptionField {
 public:
  /// `fewest`: how many of the two ends have to be given. `is_default` may be null.
  DistancesField(DistanceRange& field, std::size_t fewest, bool* is_default)
      : field_(field), fewest_(fewest), is_default_(is_default) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kNumbers; }
  std::string read(std::span<const GivenValue> given) override {
    const auto [values, fault] = readNumbers(given.front());
    if (!fault.empty()) return fault;
    if (values.size() < fewest_ || values.size() > 2) {
      return fmt::format("has {} numbers in \"{}\", expected {}", values.size(),
                         textOf(given.front()), fewest_ == 2 ? "2" : "one or two");
    }
    field_ = {.least = static_cast<float>(values.front())};
    if (values.size() == 2) field_.most = static_cast<float>(values.back());
    if (is_default_ != nullptr) *is_default_ = false;
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (is_default_ != nullptr && *is_default_) return {};
    if (std::isinf(field_.most)) return {fmt::format("{}", field_.least)};
    return {fmt::format("{},{}", field_.least, field_.most)};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  DistanceRange& field_;
  std::size_t fewest_;
  bool* is_default_;
};

class FlagField final : public OptionField {
 public:
  FlagField(bool& field, bool when_typed) : field_(field), when_typed_(when_typed) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kSwitch; }
  std::string read(std::span<const GivenValue> given) override {
    const std::string shown = textOf(given.front());
    if (shown != "true" && shown != "false") return found(shown, "true or false");
    field_ = (shown == "true") == when_typed_;
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (field_ != when_typed_) return {};
    return {"true"};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  bool& field_;
  bool when_typed_;
};

class ChoiceField final : public OptionField {
 public:
  explicit ChoiceField(ChoiceAccess access) : access_(std::move(access)) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kChoice; }
  std::string read(std::span<const GivenValue> given) override {
    const std::string shown = textOf(given.front());
    const auto one = std::find(access_.names.begin(), access_.names.end(), shown);
    if (one == access_.names.end()) {
      return fmt::format("is \"{}\", expected one of {}", shown, fmt::join(access_.names, ", "));
    }
    access_.set(static_cast<std::size_t>(one - access_.names.begin()));
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    const std::optional<std::size_t> chosen = access_.get ? access_.get() : std::nullopt;
    if (!chosen) return {};
    return {std::string(access_.names[*chosen])};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return access_.memory; }

 private:
  ChoiceAccess access_;
};

class PathField final : public OptionField {
 public:
  explicit PathField(std::filesystem::path& field) : field_(field) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kPath; }
  std::string read(std::span<const GivenValue> given) override {
    field_ = textOf(given.front());
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (field_.empty()) return {};
    return {field_.string()};
  }
  [[nodiscard]] std::vector<std::filesystem::path*> paths() override {
    if (field_.empty()) return {};
    return {&field_};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  std::filesystem::path& field_;
};

class TextField final : public OptionField {
 public:
  explicit TextField(std::string& field) : field_(field) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kText; }
  std::string read(std::span<const GivenValue> given) override {
    field_ = textOf(given.front());
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (field_.empty()) return {};
    return {field_};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  std::string& field_;
};

/// Texts, each given once; or names, which commas separate.
class TextsField final : public OptionField {
 public:
  TextsField(std::vector<std::string>& field, bool are_names)
      : field_(field), are_names_(are_names) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kText; }
  [[nodiscard]] bool repeats() const override { return true; }
  std::string read(std::span<const GivenValue> given) override {
    field_.clear();
    for (const GivenValue& value : given) {
      const std::string text = textOf(value);
      if (!are_names_) {
        field_.push_back(text);
        continue;
      }
      for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        if (end == begin) {
          return fmt::format("has an empty name in \"{}\", expected names separated by commas",
                             text);
        }
        field_.push_back(text.substr(begin, end - begin));
        begin = end + 1;
      }
    }
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (field_.empty() || !are_names_) return field_;
    return {fmt::format("{}", fmt::join(field_, ","))};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  std::vector<std::string>& field_;
  bool are_names_;
};

template <class Value>
class NamedField final : public OptionField {
 public:
  NamedField(std::map<std::string, Value>& field, std::string_view form)
      : field_(field), form_(form) {}
  [[nodiscard]] OptionKind kind() const override {
    return kHasPaths ? OptionKind::kNamedPath : OptionKind::kNamedText;
  }
  [[nodiscard]] bool repeats() const override { return true; }
  std::string read(std::span<const GivenValue> given) override {
    field_.clear();
    for (const GivenValue& value : given) {
      const std::string pair = textOf(value);
      const std::size_t equals = value.name.empty() ? pair.find('=') : value.name.size();
      if (equals == std::string::npos || equals == 0 || equals + 1 >= pair.size()) {
        return fmt::format("is \"{}\", expected {}", pair, form_);
      }
      const std::string name = pair.substr(0, equals);
      if (!field_.emplace(name, pair.substr(equals + 1)).second) {
        return fmt::format("names {} twice; give each once", name);
      }
    }
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    std::vector<std::string> all;
    for (const auto& [name, value] : field_) {
      all.push_back(name + "=" + std::filesystem::path(value).string());
    }
    return all;
  }
  [[nodiscard]] std::vector<std::filesystem::path*> paths() override {
    std::vector<std::filesystem::path*> all;
    if constexpr (kHasPaths) {
      for (auto& [name, value] : field_) all.push_back(&value);
    }
    return all;
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  static constexpr bool kHasPaths = std::is_same_v<Value, std::filesystem::path>;

  std::map<std::string, Value>& field_;
  std::string_view form_;
};

}  // namespace

FieldPointer number(float& field, OptionRange range) {
  return std::make_unique<NumberField<float, float>>(field, range);
}
FieldPointer number(double& field, OptionRange range) {
  return std::make_unique<NumberField<double, double>>(field, range);
}
FieldPointer number(std::optional<float>& field, OptionRange range) {
  return std::make_unique<NumberField<std::optional<float>, float>>(field, range);
}
FieldPointer number(std::optional<double>& field, OptionRange range) {
  return std::make_unique<NumberField<std::optional<double>, double>>(field, range);
}
FieldPointer whole(std::uint32_t& field, Within<std::uint64_t> range) {
  return std::make_unique<WholeField<std::uint32_t, std::uint32_t>>(field, range, false);
}
FieldPointer whole(std::uint64_t& field, Within<std::uint64_t> range) {
  return std::make_unique<WholeField<std::uint64_t, std::uint64_t>>(field, range, false);
}
FieldPointer whole(std::optional<std::uint32_t>& field, Within<std::uint64_t> range) {
  using Field = std::optional<std::uint32_t>;
  return std::make_unique<WholeField<Field, std::uint32_t>>(field, range, false);
}
FieldPointer powerOfTwo(std::uint32_t& field, Within<std::uint64_t> range) {
  return std::make_unique<WholeField<std::uint32_t, std::uint32_t>>(field, range, true);
}
FieldPointer numbers(std::vector<float>& field, OptionRange range) {
  return std::make_unique<NumbersField>(field, range);
}
FieldPointer transform(std::optional<Affine>& field) {
  return std::make_unique<TransformField>(field);
}
FieldPointer points(std::vector<Vec3>& field) { return std::make_unique<PointsField>(field); }
FieldPointer counts(CountRange& field, Within<std::uint64_t> range) {
  return std::make_unique<CountsField>(field, range);
}
FieldPointer distances(DistanceRange& field) {
  return std::make_unique<DistancesField>(field, 1, nullptr);
}
FieldPointer distances(DistanceRange& field, bool& is_default) {
  return std::make_unique<DistancesField>(field, 1, &is_default);
}
FieldPointer bounds(DistanceRange& field) {
  return std::make_unique<DistancesField>(field, 2, nullptr);
}
FieldPointer flag(bool& field, bool when_typed) {
  return std::make_unique<FlagField>(field, when_typed);
}
FieldPointer path(std::filesystem::path& field) { return std::make_unique<PathField>(field); }
FieldPointer text(std::string& field) { return std::make_unique<TextField>(field); }
FieldPointer texts(std::vector<std::string>& field) {
  return std::make_unique<TextsField>(field, false);
}
FieldPointer names(std::vector<std::string>& field) {
  return std::make_unique<TextsField>(field, true);
}
FieldPointer namedTexts(std::map<std::string, std::string>& field, std::string_view form) {
  return std::make_unique<NamedField<std::string>>(field, form);
}
FieldPointer namedPaths(std::map<std::string, std::filesystem::path>& field,
                        std::string_view form) {
  return std::make_unique<NamedField<std::filesystem::path>>(field, form);
}
FieldPointer choice(ChoiceAccess access) {
  return std::make_unique<ChoiceField>(std::move(access));
}
FieldPointer preset(std::vector<std::string_view> names, std::function<void(std::size_t)> set) {
  return choice({.names = std::move(names), .get = {}, .set = std::move(set), .memory = {}});
}

}  // namespace galactic::bake
