#include "dataset/scene_layout.h"

#include <fmt/format.h>

#include <map>
#include <system_error>
#include <utility>

#include "import/source_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

bool isFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Looks up one item after the other; the attributes of each template are read once.
class ItemLookUp {
 public:
  explicit ItemLookUp(const DatasetIndex& index) : index_(index) {}

  Result<PlacedItem> find(TemplateKind kind, const SceneItem& item) {
    const DatasetBlock& block = index_.block(kind);
    const std::string_view noun = namesOf(kind).noun;
    PlacedItem placed{.kind = kind, .item = &item};
    const FoundTemplate found = block.templates.find(item.template_name);
    placed.entry = found.found;
    if (placed.entry == nullptr) {
      placed.missing =
          fmt::format("{} '{}' is in none of the dataset's paths", noun, item.template_name);
      for (const SearchedFolder& searched : block.searched) {
        placed.absent.push_back(index_.folder / searched.folder /
                                (item.template_name + searched.ending));
      }
      return placed;
    }
    const DatasetTemplate& entry = *placed.entry;
    if (found.ambiguous) {
      placed.warning = fmt::format("{} '{}' may be several; '{}' is taken, the first", noun,
                                   item.template_name, entry.handle);
    }
    ASSIGN_OR_RETURN(placed.attributes, attributesOf(entry, kind));
    const bool is_articulated = kind == TemplateKind::kArticulated;
    ASSIGN_OR_RETURN(auto file, is_articulated ? Result<fs::path>(urdfOf(entry, *placed.attributes))
                                               : meshFileOf(entry, *placed.attributes));
    RETURN_IF_ERROR(index_.checkReach(file, placeOf(entry)));
    if (isFile(file)) {
      placed.file = std::move(file);
      return placed;
    }
    placed.missing =
        fmt::format("{} '{}': its {} '{}' is missing", noun, entry.name,
                    is_articulated ? "URDF" : "mesh", nameRelativeTo(index_.config, file));
    placed.absent.push_back(std::move(file));
    return placed;
  }

 private:
  using Attributes = std::shared_ptr<const TemplateAttributes>;

  Result<Attributes> attributesOf(const DatasetTemplate& entry, TemplateKind kind) {
    Attributes& known = attributes_[&entry];
    if (known) return known;
    ASSIGN_OR_RETURN(auto read, readAttributes(entry, index_.block(kind), kind));
    known = std::make_shared<const TemplateAttributes>(std::move(read));
    return known;
  }

  const DatasetIndex& index_;
  std::map<const DatasetTemplate*, Attributes> attributes_;
};

}  // namespace

Result<SceneLayout> layOutScene(const DatasetIndex& index, const SceneInstance& instance) {
  ItemLookUp look_up(index);
  SceneLayout layout{.instance = &instance};
  const auto add = [&](TemplateKind kind, const SceneItem& item) -> Result<void> {
    ASSIGN_OR_RETURN(auto placed, look_up.find(kind, item));
    layout.items.push_back(std::move(placed));
    return {};
  };
  if (instance.stage) RETURN_IF_ERROR(add(TemplateKind::kStage, *instance.stage));
  for (const SceneItem& item : instance.objects) {
    RETURN_IF_ERROR(add(TemplateKind::kObject, item));
  }
  for (const SceneItem& item : instance.articulated) {
    RETURN_IF_ERROR(add(TemplateKind::kArticulated, item));
  }
  return layout;
}

}  // namespace galactic::bake
