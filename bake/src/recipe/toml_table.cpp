#include "recipe/toml_table.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <exception>
#include <sstream>
#include <string_view>
#include <system_error>

#include "galactic/mapped_file.h"

namespace galactic::bake {
namespace {

constexpr std::size_t kMaxTomlBytes = std::size_t{1} << 20U;

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
    // The key's line says more than the line where a table's first key stands.
    converted.back().value.line = key.source().begin.line;
  }
  return converted;
}

}  // namespace

Result<TomlTable> readToml(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return fail(ErrorCode::kIo, path.string(), "it is a folder; give the path of a TOML file");
  }
  const auto file = MappedFile::open(path);
  if (!file) return tl::unexpected(file.error());
  const std::string_view text(reinterpret_cast<const char*>(file->bytes().data()),
                              file->bytes().size());
  if (text.size() > kMaxTomlBytes) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("it has {} bytes, at most {} are read; is it a recipe?", text.size(),
                            kMaxTomlBytes));
  }
  try {
    return convertTable(toml::parse(text));
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::kInvalidInput,
                fmt::format("{}:{}", path.string(), error.source().begin.line),
                fmt::format("it is not TOML: {}", error.description()));
  } catch (const std::exception& error) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("it cannot be read: {}", error.what()));
  }
}

}  // namespace galactic::bake
