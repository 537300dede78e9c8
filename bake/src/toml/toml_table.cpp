#include "toml/toml_table.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

constexpr std::size_t kMaxTomlBytes = std::size_t{1} << 20U;
/// Maximum number of parts of a key. The parser limits the depth of values, but not of keys, each
/// part of which is a nested table.
constexpr std::size_t kMostKeyParts = 32;

/// Checks dotted keys before the parser sees them, because the parser, and code that walks its
/// tree, recurse for each part.
class DottedKeys {
 public:
  explicit DottedKeys(std::string_view text) : text_(text) {}

  /// The first line, from 1, in which a key or the name of a table has more than kMostKeyParts
  /// parts.
  std::optional<std::size_t> lineOfDeepest() {
    std::size_t parts = 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skipString(c);
        continue;
      }
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
        continue;
      }
      if (c == '.' && ++parts > kMostKeyParts) return line_;
      if (std::string_view("\n=,{}[]").find(c) != std::string_view::npos) parts = 1;
      if (c == '\n') ++line_;
      ++at_;
    }
    return std::nullopt;
  }

 private:
  /// Skips the string that begins here. The parser reports one without an end.
  void skipString(char quote) {
    const std::string three(3, quote);
    const bool is_long = text_.substr(at_, 3) == three;
    const std::string_view end =
        is_long ? std::string_view(three) : std::string_view(three).substr(0, 1);
    at_ += end.size();
    while (at_ < text_.size() && text_.substr(at_, end.size()) != end) {
      if (text_[at_] == '\n') {
        if (!is_long) return;
        ++line_;
      }
      at_ += quote == '"' && text_[at_] == '\\' ? 2U : 1U;
    }
    at_ = std::min(at_ + end.size(), text_.size());
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

TomlTable convertTable(const toml::table& table);

TomlValue convert(const toml::node& node) {
  TomlValue value;
  value.line = node.source().begin.line;
  if (const auto* table = node.as_table()) {
    value.value = convertTable(*table);
  } else if (const auto* array = node.as_array()) {
    TomlArray elements;
    for (const toml::node& element : *array) elements.push_back(convert(element));
    value.value = std::move(elements);
  } else if (const auto* text = node.as_string()) {
    value.value = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.value = std::int64_t{integer->get()};
  } else if (const auto* number = node.as_floating_point()) {
    value.value = number->get();
  } else if (const auto* truth = node.as_boolean()) {
    value.value = truth->get();
  } else {
    std::ostringstream stream;
    node.visit([&](const auto& n) {
      if constexpr (toml::is_value<decltype(n)>) stream << n;
    });
    value.value = stream.str();
  }
  return value;
}

TomlTable convertTable(const toml::table& table) {
  TomlTable converted;
  for (const auto& [key, node] : table) {
    converted.push_back({.key = std::string(key.str()), .value = convert(node)});
    // The key's line is more useful than the line of a table's first key.
    converted.back().value.line = key.source().begin.line;
  }
  return converted;
}

}  // namespace

Result<TomlTable> parseToml(std::string_view text, const std::string& where) {
  if (text.size() > kMaxTomlBytes) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("it has {} bytes, at most {} are read; is it a recipe?", text.size(),
                            kMaxTomlBytes));
  }
  if (const auto line = DottedKeys(text).lineOfDeepest()) {
    return fail(ErrorCode::kInvalidInput, fmt::format("{}:{}", where, *line),
                fmt::format("it has a key of more than {} parts; is it a recipe?", kMostKeyParts));
  }
  try {
    return convertTable(toml::parse(text));
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::kInvalidInput, fmt::format("{}:{}", where, error.source().begin.line),
                fmt::format("it is not TOML: {}", error.description()));
  } catch (const std::exception& error) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("it cannot be read: {}", error.what()));
  }
}

Result<TomlTable> readToml(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return fail(ErrorCode::kIo, path.string(), "it is a folder; give the path of a TOML file");
  }
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  return parseToml({reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()},
                   path.string());
}

}  // namespace galactic::bake
