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
/// Entries with their keys.
using TomlTable = std::vector<TomlEntry>;

/// A value of a TOML file. Dates and times become text.
struct TomlValue {
  std::variant<bool, std::int64_t, double, std::string, TomlArray, TomlTable> value;
  /// Line in the file, from 1.
  std::uint32_t line = 0;
};

struct TomlEntry {
  std::string key;
  TomlValue value;
};

/// The outermost table of a text. Fails with kInvalidInput if the TOML is malformed (naming `where`
/// and the line), if a key has too many parts, or if the text is longer than 1 MiB.
[[nodiscard]] Result<TomlTable> parseToml(std::string_view text, const std::string& where);

/// The same for a file. Also fails with kIo (missing, unreadable or a folder).
[[nodiscard]] Result<TomlTable> readToml(const std::filesystem::path& path);

}  // namespace galactic::bake
