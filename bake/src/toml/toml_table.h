#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

struct TomlValue;
struct TomlEntry;
using TomlArray = std::vector<TomlValue>;
/// By key.
using TomlTable = std::vector<TomlEntry>;

/// A value of a TOML file; dates and times are delivered as text.
struct TomlValue {
  std::variant<bool, std::int64_t, double, std::string, TomlArray, TomlTable> value;
  /// Line in the file, from 1.
  std::uint32_t line = 0;
};

struct TomlEntry {
  std::string key;
  TomlValue value;
};

/// The outermost table of a text. Fails with kInvalidInput: broken TOML (`where` and its line),
/// keys of very many parts, more than 1 MiB.
[[nodiscard]] Result<TomlTable> parseToml(std::string_view text, const std::string& where);

/// The same of a file; fails with kIo, too (missing, unreadable or a folder).
[[nodiscard]] Result<TomlTable> readToml(const std::filesystem::path& path);

}  // namespace galactic::bake
