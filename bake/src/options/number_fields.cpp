#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

#include "galactic/bake/option_field.h"
#include "options/given_text.h"
#include "support/text/number_text.h"

namespace galactic::bake {
namespace {

/// Larger than any sensible length, factor or count.
constexpr double kMostNumber = 1e12;

/// Numbers, or the reason why the value is not a list of numbers.
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

/// The numbers in all words, with texts split at their commas.
ReadNumbers readNumbers(const GivenValue& value) {
  ReadNumbers numbers;
  for (const GivenWord& word : value.words) {
    if (!numbers.fault.empty()) break;
    readText(textOf(word), numbers);
  }
  return numbers;
}

std::string expectedOf(const OptionRange& range) {
  const bool has_most = range.most < kMostNumber;
  if (!range.above && has_most) {
    return fmt::format("a number from {} to {}", range.least, range.most);
  }
  std::string expected =
      fmt::format("a number {} {}", range.above ? "above" : "of at least", range.least);
  return has_most ? expected + fmt::format(" and up to {}", range.most) : expected;
}

bool isWithin(double number, const OptionRange& range) {
  // False for NaN.
  const bool is_high_enough = range.above ? number > range.least : number >= range.least;
  return is_high_enough && number <= std::min(range.most, kMostNumber);
}

/// A field that holds one value, or none if it is optional.
template <class Field>
class SingleField : public OptionField {
 public:
  explicit SingleField(Field& field) : field_(field) {}
  [[nodiscard]] std::vector<std::string> texts() const override {
    const std::optional<Value> value = field_;
    if (!value) return {};
    return {fmt::format("{}", *value)};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 protected:
  using Value = typename decltype(std::optional(std::declval<Field>()))::value_type;

  template <class T>
  void set(T value) {
    field_ = static_cast<Value>(value);
  }

 private:
  Field& field_;
};

/// A field that takes one number.
template <class Field>
class NumberField final : public SingleField<Field> {
 public:
  NumberField(Field& field, OptionRange range) : SingleField<Field>(field), range_(range) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kNumber; }
  std::string read(std::span<const GivenValue> given) override {
    const std::string shown = textOf(given.front());
    const std::optional<double> number = numberOf(shown);
    if (!number || !isWithin(*number, range_)) return found(shown, expectedOf(range_));
    this->set(*number);
    return {};
  }

 private:
  OptionRange range_;
};

/// A field that takes one whole number.
template <class Field>
class WholeField final : public SingleField<Field> {
 public:
  WholeField(Field& field, Within<std::uint64_t> range, bool is_power)
      : SingleField<Field>(field), range_(range), is_power_(is_power) {}
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
    this->set(value);
    return {};
  }

 private:
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
        if (!isWithin(number, range_)) return found(fmt::format("{}", number), expectedOf(range_));
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
  /// `fewest`: how many of the two ends must be given. `is_default` may be null.
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

}  // namespace

FieldPointer number(float& field, OptionRange range) {
  return std::make_unique<NumberField<float>>(field, range);
}
FieldPointer number(double& field, OptionRange range) {
  return std::make_unique<NumberField<double>>(field, range);
}
FieldPointer number(std::optional<float>& field, OptionRange range) {
  return std::make_unique<NumberField<std::optional<float>>>(field, range);
}
FieldPointer number(std::optional<double>& field, OptionRange range) {
  return std::make_unique<NumberField<std::optional<double>>>(field, range);
}
FieldPointer whole(std::uint32_t& field, Within<std::uint64_t> range) {
  return std::make_unique<WholeField<std::uint32_t>>(field, range, false);
}
FieldPointer whole(std::uint64_t& field, Within<std::uint64_t> range) {
  return std::make_unique<WholeField<std::uint64_t>>(field, range, false);
}
FieldPointer whole(std::optional<std::uint32_t>& field, Within<std::uint64_t> range) {
  using Field = std::optional<std::uint32_t>;
  return std::make_unique<WholeField<Field>>(field, range, false);
}
FieldPointer whole(std::optional<std::uint64_t>& field, Within<std::uint64_t> range) {
  using Field = std::optional<std::uint64_t>;
  return std::make_unique<WholeField<Field>>(field, range, false);
}
FieldPointer powerOfTwo(std::uint32_t& field, Within<std::uint64_t> range) {
  return std::make_unique<WholeField<std::uint32_t>>(field, range, true);
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
}  // namespace galactic::bake
