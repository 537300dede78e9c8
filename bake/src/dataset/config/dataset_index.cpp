#include "dataset/config/dataset_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "dataset/config/dataset_paths.h"
#include "galactic/bake/habitat_names.h"
#include "import/source_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr JsonFileKind kDatasetFile{
    .what = "a scene dataset", .suffix = kDatasetSuffix, .max_bytes = std::size_t{64} << 20U};

constexpr std::array<TemplateKindNames, kTemplateKinds> kNames{{
    {"stages", kStageSuffix, "stage"},
    {"objects", kObjectSuffix, "object"},
    {"articulated_objects", kArticulatedSuffix, "articulated object"},
    {"scene_instances", kSceneSuffix, "scene"},
}};

class IndexReader {
 public:
  IndexReader(const fs::path& config, DatasetIndex& index)
      : json_(config.string()), index_(index) {}

  Result<void> read(const Json& root);

 private:
  void readBlock(TemplateKind kind, const JsonNode& block);
  void readPaths(TemplateKind kind, const JsonNode& paths);
  void addMatches(TemplateKind kind, const std::string& ending, const JsonNode& pattern);
  void addFile(TemplateKind kind, const fs::path& file);
  void readInline(TemplateKind kind, const JsonNode& node);
  [[nodiscard]] bool wantsObject(const JsonNode& node);
  DatasetBlock& block(TemplateKind kind) { return index_.blocks[static_cast<std::size_t>(kind)]; }

  JsonReader json_;
  DatasetIndex& index_;
};

bool IndexReader::wantsObject(const JsonNode& node) {
  if (node.json == nullptr) return false;
  if (!node.json->is_object()) json_.error(node.place, "expected an object");
  return node.json->is_object();
}

void IndexReader::addFile(TemplateKind kind, const fs::path& file) {
  const std::string_view suffix = namesOf(kind).suffix;
  DatasetTemplate entry;
  entry.name = habitatName(file.string(), file.extension().string());
  entry.folder = file.parent_path();
  if (file.filename().string().ends_with(suffix)) {
    entry.config = file;
  } else {
    entry.asset = file;
    // As in Habitat: attributes beside a mesh or URDF belong to it. Of NAME.basis.glb they may have
    // either name.
    for (const std::string& name : {file.stem().string(), entry.name}) {
      const fs::path beside = entry.folder / (name + std::string(suffix));
      std::error_code ignored;
      if (entry.config.empty() && fs::is_regular_file(beside, ignored)) entry.config = beside;
    }
  }
  entry.handle = nameRelativeTo(index_.config, entry.config.empty() ? entry.asset : entry.config);
  block(kind).templates.add(entry);
}

void IndexReader::addMatches(TemplateKind kind, const std::string& ending,
                             const JsonNode& pattern_node) {
  const std::string pattern = json_.text(pattern_node);
  if (json_.failed()) return;
  const bool attributes = ending.find(".json") != std::string::npos;
  const std::string suffix = attributes ? std::string(namesOf(kind).suffix) : ending;
  std::error_code ignored;
  std::size_t files = 0;
  const auto matches = matchingPaths(index_.folder, pattern);
  if (!matches) {
    return json_.error(
        pattern_node.place,
        fmt::format("'{}' finds more than {} files and folders; narrow it", pattern, kMostMatches));
  }
  for (const fs::path& match : *matches) {
    if (auto near = index_.checkReach(match, pattern_node.place); !near) {
      return json_.error(pattern_node.place, near.error().message);
    }
    if (fs::is_directory(match, ignored)) {
      block(kind).searched.push_back({nameRelativeTo(index_.config, match), suffix});
      for (const fs::path& file : filesIn(match, suffix)) {
        addFile(kind, file);
        ++files;
      }
    } else if (match.filename().string().ends_with(suffix)) {
      addFile(kind, match);
      ++files;
    }
  }
  if (files == 0) {
    index_.warnings.push_back(
        fmt::format("{}: '{}' finds no {} file", pattern_node.place, pattern, suffix));
  }
}

void IndexReader::readPaths(TemplateKind kind, const JsonNode& paths) {
  if (!wantsObject(paths)) return;
  for (auto item = paths.json->begin(); item != paths.json->end(); ++item) {
    const JsonNode list{&*item, fmt::format("{}['{}']", paths.place, item.key())};
    if (item.key().size() < 2) {
      json_.error(list.place, "expected a file extension, for example '.json'");
    }
    for (const JsonNode& pattern : json_.elements(list)) {
      addMatches(kind, item.key(), pattern);
      if (json_.failed()) return;
    }
  }
}

void IndexReader::readInline(TemplateKind kind, const JsonNode& node) {
  if (!wantsObject(node)) return;
  const JsonNode attributes = json_.require(node, "attributes");
  if (!wantsObject(attributes)) return;
  const JsonNode original = JsonReader::member(node, "original_file");
  const JsonNode handle = JsonReader::member(node, "template_handle");
  if (original.json == nullptr && handle.json == nullptr) {
    json_.error(node.place, "it has neither 'original_file' nor 'template_handle'; give one");
  }
  const std::string original_name = json_.text(original);
  const std::string handle_name = json_.text(handle);
  if (json_.failed()) return;
  TemplateList& templates = block(kind).templates;
  AttributeLayer layer{json_.file(), attributes.place, *attributes.json};
  DatasetTemplate entry;
  entry.folder = index_.folder;
  if (original.json != nullptr) {
    const FoundTemplate found = templates.find(original_name);
    if (found.found == nullptr) {
      index_.warnings.push_back(fmt::format("{}: '{}' is in none of the paths; it is left out",
                                            original.place, original_name));
      return;
    }
    if (handle.json == nullptr) {
      return templates.addLayer(std::string(found.found->handle), std::move(layer));
    }
    entry = *found.found;
  }
  entry.handle = handle_name;
  entry.name = habitatName(handle_name);
  entry.layers.push_back(std::move(layer));
  templates.replace(std::move(entry));
}

void IndexReader::readBlock(TemplateKind kind, const JsonNode& node) {
  if (!wantsObject(node)) return;
  const JsonNode defaults = JsonReader::member(node, "default_attributes");
  if (wantsObject(defaults)) {
    block(kind).defaults = AttributeLayer{json_.file(), defaults.place, *defaults.json};
  }
  readPaths(kind, JsonReader::member(node, "paths"));
  for (const JsonNode& config : json_.elements(JsonReader::member(node, "configs"))) {
    readInline(kind, config);
    if (json_.failed()) return;
  }
}

Result<void> IndexReader::read(const Json& root) {
  const JsonNode node{&root, ""};
  if (!root.is_object()) json_.error("the file", "expected an object");
  for (std::size_t i = 0; i < kTemplateKinds && !json_.failed(); ++i) {
    readBlock(static_cast<TemplateKind>(i), JsonReader::member(node, kNames[i].block));
  }
  if (json_.failed()) return json_.failure();
  return {};
}

}  // namespace

const TemplateKindNames& namesOf(TemplateKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

Result<void> DatasetIndex::checkReach(const fs::path& file, const std::string& where) const {
  if (allow_outside || isBelow(file, folder / "..")) return {};
  return fail(ErrorCode::kInvalidInput, where,
              fmt::format("'{}' lies outside of the folder above the dataset's; put it there, or "
                          "bake with `allow-outside`",
                          nameRelativeTo(config, file)));
}

Result<DatasetIndex> readDatasetIndex(const fs::path& config, bool allow_outside) {
  ASSIGN_OR_RETURN(const auto root, readJsonFile(config, kDatasetFile));
  DatasetIndex index;
  index.allow_outside = allow_outside;
  std::error_code ignored;
  index.config = fs::absolute(config, ignored).lexically_normal();
  index.folder = index.config.parent_path();
  RETURN_IF_ERROR(IndexReader(config, index).read(root));
  return index;
}

}  // namespace galactic::bake
