#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace galactic::bake {

/// What `pattern` means, seen from `folder`: existing files and folders, ascending, each once.
/// '*', '?' and '[...]' stand for any text inside one part of the path, but for a leading dot; a
/// slash at the end allows folders only. Folders that cannot be read are as if empty.
[[nodiscard]] std::vector<std::filesystem::path> matchingPaths(const std::filesystem::path& folder,
                                                               const std::string& pattern);

/// The regular files in `folder` whose names end with `suffix`, ascending.
[[nodiscard]] std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder,
                                                         std::string_view suffix);

/// `text` in lower case, ASCII only.
[[nodiscard]] std::string lowerCase(std::string_view text);

}  // namespace galactic::bake
