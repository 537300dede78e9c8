#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
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

/// The outermost table of a TOML file. Fails with kIo (missing, unreadable or a folder) or
/// kInvalidInput (broken TOML, with its line; more than 1 MiB).
[[nodiscard]] Result<TomlTable> readToml(const std::filesystem::path& path);

}  // namespace galactic::bake
