#include "cache/cache_entry.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "json/figure_json.h"
#include "support/files/mapped_file.h"

namespace galactic::bake {
namespace {

using Json = OrderedJson;

/// Raise this if the form of entries changes, or if a bake makes something else of the same inputs
/// without a new version of the program. Older entries are then ignored.
constexpr int kEntryVersion = 5;

Json jsonOf(const SourceFile& file) { return Json::array({file.name, file.bytes, hexOf(file)}); }

bool readHex(std::string_view text, std::uint64_t& value) {
  const auto [end, problem] =
      std::from_chars(text.data(), text.data() + text.size(), value, /*base=*/16);
  return problem == std::errc() && end == text.data() + text.size();
}

/// Throws what nlohmann::json throws if a value has another type.
bool read(const Json& json, SourceFile& file) {
  constexpr std::size_t kDigits = 16;
  file.name = json.at(0).get<std::string>();
  file.bytes = json.at(1).get<std::uint64_t>();
  const auto hex = json.at(2).get<std::string>();
  return hex.size() == 2 * kDigits &&
         readHex(std::string_view(hex).substr(0, kDigits), file.hash_high) &&
         readHex(std::string_view(hex).substr(kDigits), file.hash_low);
}

std::optional<CacheEntry> decode(const Json& json) {
  if (json.at("version") != kEntryVersion) return std::nullopt;
  CacheEntry entry;
  entry.inputs.key = json.at("key").get<std::string>();
  entry.inputs.read.absent = json.at("absent").get<std::vector<std::string>>();
  const Json& files = json.at("files");
  entry.inputs.read.files.resize(files.size());
  for (std::size_t n = 0; n < files.size(); ++n) {
    if (!read(files[n], entry.inputs.read.files[n])) return std::nullopt;
  }
  if (!read(json.at("pack"), entry.pack)) return std::nullopt;
  if (!readFigures(json.at("figures"), entry.figures)) return std::nullopt;
  return entry;
}

}  // namespace

std::string encodeCacheEntry(const CacheEntry& entry) {
  Json files = Json::array();
  for (const SourceFile& file : entry.inputs.read.files) files.push_back(jsonOf(file));
  const Json json{{"version", kEntryVersion},   {"key", entry.inputs.key},
                  {"files", std::move(files)},  {"absent", entry.inputs.read.absent},
                  {"pack", jsonOf(entry.pack)}, {"figures", jsonOf(entry.figures)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<CacheEntry> readCacheEntry(const std::filesystem::path& file) {
  const auto content = MappedFile::open(file);
  if (!content) return std::nullopt;
  const auto bytes = content->bytes();
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  // Only encodeCacheEntry() writes entries, so any error just means that there is no entry.
  try {
    const Json json = Json::parse(text, text + bytes.size(), nullptr, /*allow_exceptions=*/false);
    return json.is_object() ? decode(json) : std::nullopt;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace galactic::bake
