#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "galactic/bake/episode_set_import.h"
#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// Adds the indices of one line; returns the first part that is not an index, or "".
std::string_view addIndices(std::string_view line, std::vector<std::uint32_t>& indices) {
  line = line.substr(0, line.find('#'));
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return "";
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    std::uint32_t index = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (problem != std::errc() || end != word.data() + word.size()) return word;
    indices.push_back(index);
    line.remove_prefix(word.size());
  }
}

}  // namespace

Result<std::vector<std::uint32_t>> readEpisodeList(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
  std::vector<std::uint32_t> indices;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view wrong = addIndices(text.substr(0, end), indices);
    if (!wrong.empty()) {
      return fail(ErrorCode::kInvalidInput, fmt::format("{}:{}", path.string(), number),
                  fmt::format("has \"{}\", expected indices of episodes, from 0 on, separated by "
                              "blanks",
                              wrong.substr(0, 40)));
    }
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return indices;
}

}  // namespace galactic::bake
