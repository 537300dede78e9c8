#pragma once
#include <CLI/CLI.hpp>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Numbers separated by commas. `option` names it in the error.
[[nodiscard]] Result<std::vector<double>> parseNumbers(const std::string& text, const char* option);

/// The same, of a fixed count.
[[nodiscard]] Result<std::vector<double>> parseExactly(const std::string& text, const char* option,
                                                       std::size_t count);

/// A single positive number, in metres.
[[nodiscard]] Result<double> parsePositive(const std::string& text, const char* option);

/// One of x, y, z, -x, -y, -z.
[[nodiscard]] Result<UpAxis> parseUp(const std::string& text, const char* option);

/// NAME=VALUE, both not empty; `wanted` shows the form in the error, for example "NAME=DIR".
[[nodiscard]] Result<std::pair<std::string, std::string>> parsePair(const std::string& text,
                                                                    const char* option,
                                                                    const char* wanted);

[[nodiscard]] std::string joined(const std::vector<std::string>& parts);

/// What stands between the commas of `texts`, none of which may be empty.
[[nodiscard]] Result<std::vector<std::string>> parseNames(const std::vector<std::string>& texts,
                                                          const char* option);

/// The long names of all options, with dashes.
[[nodiscard]] std::vector<std::string> longNamesOf(const CLI::App& app);

/// The name under which `value` is typed.
template <class T>
[[nodiscard]] std::string nameOf(const std::map<std::string, T>& names, T value) {
  for (const auto& [name, candidate] : names) {
    if (candidate == value) return name;
  }
  return {};
}

}  // namespace galactic::bake
