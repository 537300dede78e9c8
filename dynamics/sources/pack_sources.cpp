#include "dynamics/sources/pack_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "galactic/object_set.h"
#include "galactic/schema/pack_generated.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

using bake::SourceFile;

std::vector<SourceFile> sourcesOf(const PackFile& pack) {
  std::vector<SourceFile> sources;
  for (const schema::SourceFile* file : *pack.root().provenance()->sources()) {
    sources.push_back({.name = file->name()->str(),
                       .bytes = file->bytes(),
                       .hash_low = file->hash()->low(),
                       .hash_high = file->hash()->high()});
  }
  return sources;
}

/// The prefix of an asset's files in its pack: several objects share a pack, which puts the files
/// of each below the object's name.
std::string prefixOf(PackKind kind, std::string_view name) {
  return kind == PackKind::kObjects ? std::string(name) + "/" : std::string();
}

std::string_view nounOf(PackKind kind) {
  if (kind == PackKind::kObjects) return "object";
  return kind == PackKind::kRobot ? "robot" : "scene";
}

}  // namespace

PackSources::PackSources(const World& world) {
  for (const PackFile& pack : world.packs()) {
    const std::size_t index = sources_.size();
    sources_.push_back(sourcesOf(pack));
    if (const schema::Scene* scene = pack.root().asset_as_Scene()) {
      pack_of_.emplace(std::pair(PackKind::kScene, scene->name()->str()), index);
    } else if (const schema::Robot* robot = pack.root().asset_as_Robot()) {
      pack_of_.emplace(std::pair(PackKind::kRobot, robot->name()->str()), index);
    } else if (const schema::ObjectSet* set = pack.root().asset_as_ObjectSet()) {
      for (const schema::Object* object : *set->objects()) {
        pack_of_.emplace(std::pair(PackKind::kObjects, object->name()->str()), index);
      }
    }
  }
}

const std::vector<SourceFile>* PackSources::of(PackKind kind, std::string_view name) const {
  const auto found = pack_of_.find(std::pair(kind, std::string(name)));
  return found == pack_of_.end() ? nullptr : &sources_[found->second];
}

std::vector<SourceFile> PackSources::listed(PackKind kind, std::string_view name) const {
  std::vector<SourceFile> files;
  const std::vector<SourceFile>* all = of(kind, name);
  if (all == nullptr) return files;
  const std::string prefix = prefixOf(kind, name);
  for (const SourceFile& file : *all) {
    if (!file.name.starts_with(prefix)) continue;
    SourceFile& own = files.emplace_back(file);
    own.name.erase(0, prefix.size());
  }
  return files;
}

Result<std::vector<std::string>> PackSources::differences(const AssetSources& now) const {
  std::vector<std::string> sentences;
  const std::vector<SourceFile>* listed = of(now.kind, now.name);
  if (listed == nullptr || listed->empty()) return sentences;
  const auto compare = [&](const SourceFile& file, const std::string& prefix) {
    const auto named = std::ranges::find(*listed, prefix + file.name, &SourceFile::name);
    const bool is_listed = named != listed->end();
    const bool is_same = is_listed ? sameContent(*named, file)
                                   : std::ranges::any_of(*listed, [&](const SourceFile& one) {
                                       return sameContent(one, file);
                                     });
    if (is_same) return;
    const std::string what = is_listed
                                 ? fmt::format("from another '{}' than is there now", file.name)
                                 : fmt::format("without '{}', which belongs to it now", file.name);
    sentences.push_back(fmt::format("{} '{}' was baked {}; bake the world again", nounOf(now.kind),
                                    now.name, what));
  };
  for (const SourceFile& file : now.files) compare(file, prefixOf(now.kind, now.name));
  for (const std::filesystem::path& path : now.named) {
    if (path.empty()) continue;
    ASSIGN_OR_RETURN(const SourceFile file, bake::describeFile(path));
    compare(file, {});
  }
  return sentences;
}

std::string digestOf(const bake::ReadLog& log) {
  std::set<std::string> lines;
  for (const bake::ReadFile& file : log.files()) {
    if (!file.content) continue;
    lines.insert(fmt::format("{} {}\n", hexOf(*file.content),
                             file.path.lexically_normal().generic_string()));
  }
  std::string text;
  for (const std::string& line : lines) text += line;
  return hexOf(bake::describeBytes({}, std::as_bytes(std::span(text))));
}

}  // namespace galactic::dynamics
