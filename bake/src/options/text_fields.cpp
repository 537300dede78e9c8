#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "galactic/bake/option_field.h"
#include "options/given_text.h"

namespace galactic::bake {
namespace {

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

class PathsField final : public OptionField {
 public:
  explicit PathsField(std::vector<std::filesystem::path>& field) : field_(field) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kPath; }
  [[nodiscard]] bool repeats() const override { return true; }
  std::string read(std::span<const GivenValue> given) override {
    field_.clear();
    for (const GivenValue& value : given) field_.emplace_back(textOf(value));
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    std::vector<std::string> all;
    all.reserve(field_.size());
    for (const std::filesystem::path& path : field_) all.push_back(path.string());
    return all;
  }
  [[nodiscard]] std::vector<std::filesystem::path*> paths() override {
    std::vector<std::filesystem::path*> all;
    all.reserve(field_.size());
    for (std::filesystem::path& path : field_) all.push_back(&path);
    return all;
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  std::vector<std::filesystem::path>& field_;
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

/// A list of texts, one per occurrence of the option, or of names separated by commas.
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

FieldPointer flag(bool& field, bool when_typed) {
  return std::make_unique<FlagField>(field, when_typed);
}
FieldPointer path(std::filesystem::path& field) { return std::make_unique<PathField>(field); }
FieldPointer paths(std::vector<std::filesystem::path>& field) {
  return std::make_unique<PathsField>(field);
}
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
