#include "pack_tool/describe/info_text.h"

#include <fmt/format.h>

#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"

namespace galactic::pack_tool {

namespace {

std::string headerText(const Json& pack) {
  const Json& provenance = pack.at("provenance");
  std::string text = textOf(pack.at("file")) + '\n';
  text += labeled("kind", fmt::format("{}, format version {}", textOf(pack.at("kind")),
                                      pack.at("format_version").get<std::uint32_t>()));
  text += labeled("size", fmt::format("{} bytes, payload XXH64 {}", countOf(pack.at("bytes")),
                                      textOf(pack.at("payload_xxh64"))));
  text += labeled("written by", fmt::format("{} {}", textOf(provenance.at("tool")),
                                            textOf(provenance.at("tool_version"))));
  return text;
}

/// A label, and a table with its rows to the right of it; "none" without rows.
std::string listText(std::string_view label, const std::vector<std::string>& rows) {
  if (rows.empty()) return labeled(label, "none");
  std::string text;
  for (const std::string& row : rows) {
    text += labeled(text.empty() ? label : std::string_view(), row);
  }
  return text;
}

std::string provenanceText(const Json& provenance) {
  std::vector<std::string> options;
  for (const Json& option : provenance.at("options")) {
    options.push_back(
        fmt::format("--{} {}", textOf(option.at("name")), textOf(option.at("value"))));
  }
  // Objects and robots come from very many files.
  constexpr std::size_t kMostSources = 12;
  std::vector<std::string> sources;
  const std::size_t shown = provenance.at("sources").size() > kMostSources + 1
                                ? kMostSources
                                : provenance.at("sources").size();
  for (const Json& source : provenance.at("sources")) {
    if (sources.size() == shown) {
      sources.push_back(fmt::format("and {} more; --json lists them all",
                                    provenance.at("sources").size() - shown));
      break;
    }
    const Json& hash = source.at("xxh3_128");
    sources.push_back(fmt::format("{}, {} bytes, XXH3-128 {}", textOf(source.at("name")),
                                  countOf(source.at("bytes")),
                                  hash.is_null() ? "not recorded" : textOf(hash)));
  }
  std::vector<std::string> warnings;
  for (const Json& warning : provenance.at("warnings")) warnings.push_back(textOf(warning));
  return listText("options", options) + listText("sources", sources) +
         listText("warnings", warnings);
}

}  // namespace

std::string infoText(const Json& description) {
  std::string text = headerText(description) + provenanceText(description.at("provenance"));
  if (description.contains("scene")) text += sceneText(description.at("scene"));
  if (description.contains("object_set")) text += objectsText(description.at("object_set"));
  if (description.contains("robot")) text += robotText(description.at("robot"));
  if (description.contains("render_meshes")) {
    text += renderMeshesText(description.at("render_meshes"));
  }
  if (description.contains("episode_set")) text += episodesText(description.at("episode_set"));
  if (description.contains("world")) text += worldText(description.at("world"));
  if (description.contains("texture")) text += textureText(description.at("texture"));
  if (description.contains("policy")) text += policyText(description.at("policy"));
  return text;
}

}  // namespace galactic::pack_tool
