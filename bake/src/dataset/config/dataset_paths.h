#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace galactic::bake {

/// Whether `name` is what `pattern` describes: '*' is any text, '?' one byte, "[a-z]" and "[!a-z]"
/// one of a set (a backslash is nothing special); a leading dot has to be stated. Takes no longer
/// than the product of the lengths.
[[nodiscard]] bool matchesPattern(std::string_view name, std::string_view pattern);

/// A pattern that finds more is refused: it leads through the whole machine.
inline constexpr std::size_t kMostMatches = 1'000'000;

/// What `pattern` means, seen from `folder`: existing files and folders, ascending, each once. Each
/// part of the path is a pattern; a slash at the end allows folders only. Folders that cannot be
/// read are as if empty. None when there are more than kMostMatches.
[[nodiscard]] std::optional<std::vector<std::filesystem::path>> matchingPaths(
    const std::filesystem::path& folder, const std::string& pattern);

/// The regular files in `folder` whose names end with `suffix`, ascending.
[[nodiscard]] std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder,
                                                         std::string_view suffix);

}  // namespace galactic::bake
