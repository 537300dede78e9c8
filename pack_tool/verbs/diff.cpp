#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include "pack_tool/diff/asset_diff.h"
#include "pack_tool/diff/diff_text.h"
#include "pack_tool/diff/episode_diff.h"
#include "pack_tool/diff/render_diff.h"
#include "pack_tool/diff/report_diff.h"
#include "pack_tool/support/open_scene.h"
#include "pack_tool/verbs/verbs.h"
#include "support/try.h"

namespace galactic::pack_tool {

namespace {

/// Names a grid by its radius.
std::string gridField(const Json& grid) { return "grid(" + grid.at("radius").dump() + ')'; }

/// The part of a description that tells how the pack was made, not what the runtime reads.
Json provenanceOf(const Json& description) {
  Json json = description.at("provenance");
  json["import"] = description.at("scene").at("import");
  for (const Json& grid : description.at("scene").at("column_grids")) {
    json[gridField(grid)] = grid.at("statistics");
  }
  return json;
}

/// The part of a description that the runtime reads, without the grids' frames and spans.
Json contentOf(const Json& description) {
  const Json& scene = description.at("scene");
  return {{"name", scene.at("name")}, {"bounds", scene.at("bounds")}};
}

Json coverageOf(const Json& description, std::size_t grid) {
  const Json& described = description.at("scene").at("column_grids").at(grid);
  return {{gridField(described), {{"coverage", described.at("coverage")}}}};
}

/// One side of the comparison of scenes.
struct Side {
  Scene scene;
  Json description;

  [[nodiscard]] const std::vector<ColumnGrid>& grids() const { return scene.grids(); }
};

Result<Side> sideOf(const PackFile& pack) {
  ASSIGN_OR_RETURN(auto scene, sceneOf(pack));
  return Side{std::move(scene), describePack(pack)};
}

/// Pairs the grids by radius and compares each pair.
void compareAllGrids(const Side& a, const Side& b, double tolerance, PackDifference& difference) {
  for (std::size_t g = 0; g < a.grids().size(); ++g) {
    const ColumnGrid& grid = a.grids()[g];
    const auto other = b.scene.gridIndex(grid.radius());
    if (!other) {
      difference.radii_only_in_a.push_back(grid.radius());
      continue;
    }
    append(difference.content,
           compareFields(coverageOf(a.description, g), coverageOf(b.description, *other), 0));
    difference.grids.push_back(compareGrids(grid, b.grids()[*other], tolerance));
  }
  for (const ColumnGrid& grid : b.grids()) {
    if (!a.scene.gridIndex(grid.radius())) difference.radii_only_in_b.push_back(grid.radius());
  }
}

Result<void> compareScenes(const PackFile& a, const PackFile& b, const DiffOptions& options,
                           PackDifference& difference) {
  ASSIGN_OR_RETURN(const auto side_a, sideOf(a));
  ASSIGN_OR_RETURN(const auto side_b, sideOf(b));
  if (options.scope == DiffScope::kEverything) {
    difference.provenance =
        compareFields(provenanceOf(side_a.description), provenanceOf(side_b.description), 0);
  }
  difference.content = compareFields(contentOf(side_a.description), contentOf(side_b.description),
                                     options.tolerance);
  compareAllGrids(side_a, side_b, options.tolerance, difference);
  compareRenderMeshes({a, b}, {side_a.description, side_b.description}, options, difference);
  return {};
}

/// The key under which a description says all that is in a pack of this kind: of weights and texels
/// it has hashes. Null where there is more to compare.
const char* whollyDescribedAs(PackKind kind) {
  if (kind == PackKind::kWorld) return "world";
  if (kind == PackKind::kPolicy) return "policy";
  return kind == PackKind::kTexture ? "texture" : nullptr;
}

/// "home/" of "home/scenes/a.pack", "" of "a.pack".
std::string firstFolder(const std::string& path) {
  const std::size_t slash = path.find('/');
  return slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
}

/// Where the paths of a world's packs may begin.
struct WorldFolders {
  /// The folder of the world's name, "" where no path begins with it.
  std::string named;
  /// The one in which all packs are, "" where there is none.
  std::string common;
};

WorldFolders foldersOf(const Json& description, const std::string& file) {
  const std::string name = std::filesystem::path(file).stem().string() + "/";
  const Json& packs = description.at("world").at("packs");
  WorldFolders folders;
  for (const Json& pack : packs) {
    const std::string folder = firstFolder(pack.at("path").get<std::string>());
    if (folder == name) folders.named = name;
    if (&pack == &packs.front()) folders.common = folder;
    if (folder != folders.common) folders.common.clear();
  }
  return folders;
}

void leaveOut(const std::string& folder, Json& description) {
  for (Json& pack : description.at("world").at("packs")) {
    const std::string path = pack.at("path").get<std::string>();
    if (path.starts_with(folder)) pack["path"] = path.substr(folder.size());
  }
}

/// Takes out of a world's sources the packs that its list tells of.
void leaveOutListed(Json& description) {
  std::set<std::pair<Json, Json>> listed;
  for (const Json& pack : description.at("world").at("packs")) {
    listed.emplace(pack.at("path"), pack.at("xxh3_128"));
  }
  Json kept = Json::array();
  for (const Json& source : description.at("provenance").at("sources")) {
    if (!listed.contains({source.at("name"), source.at("xxh3_128")})) kept.push_back(source);
  }
  description.at("provenance")["sources"] = std::move(kept);
}

/// Takes the worlds' own folders out of the paths of their packs, so that one baked under another
/// name has the same. The file may have been renamed since: then it is the folder of all packs, if
/// the other world has one, too, as it may be "scenes/", which the other has beside "objects/".
void alignWorlds(DescribedPair& worlds, const PackDifference& files) {
  leaveOutListed(worlds.a);
  leaveOutListed(worlds.b);
  const WorldFolders a = foldersOf(worlds.a, files.a);
  const WorldFolders b = foldersOf(worlds.b, files.b);
  const auto own = [](const WorldFolders& of, const WorldFolders& other) {
    if (!of.named.empty()) return of.named;
    return other.named.empty() && other.common.empty() ? std::string() : of.common;
  };
  leaveOut(own(a, b), worlds.a);
  leaveOut(own(b, a), worlds.b);
}

void compareDescriptions(const DescribedPair& packs, const char* asset, const DiffOptions& options,
                         PackDifference& difference) {
  if (options.scope == DiffScope::kEverything) {
    difference.provenance = compareFields(packs.a.at("provenance"), packs.b.at("provenance"), 0);
  }
  const Json& a = packs.a.at(asset);
  const Json& b = packs.b.at(asset);
  difference.content = compareFields(a, b, 0);
  // A network is fed the parts of an observation one behind the other.
  if (a.contains("observation")) {
    append(difference.content,
           compareOrder("observation", a.at("observation"), b.at("observation")));
  }
}

Result<PackDifference> comparePacks(const PackFile& a, const PackFile& b,
                                    const DiffOptions& options) {
  if (a.kind() != b.kind()) {
    return fail(ErrorCode::kInvalidInput, b.where(),
                fmt::format("is a pack of kind {} and {} one of kind {}; give two of one kind",
                            packKindName(b.kind()), a.where(), packKindName(a.kind())));
  }
  PackDifference difference;
  difference.a = a.where();
  difference.b = b.where();
  difference.identical = std::ranges::equal(a.bytes(), b.bytes());
  if (difference.identical) return difference;
  if (a.kind() == PackKind::kObjects || a.kind() == PackKind::kRobot) {
    const DescribedPair descriptions{describePack(a), describePack(b)};
    compareAssets(descriptions, options, difference);
    compareRenderMeshes({a, b}, descriptions, options, difference);
    return difference;
  }
  if (const char* asset = whollyDescribedAs(a.kind())) {
    DescribedPair descriptions{describePack(a), describePack(b)};
    if (a.kind() == PackKind::kWorld) alignWorlds(descriptions, difference);
    compareDescriptions(descriptions, asset, options, difference);
    return difference;
  }
  RETURN_IF_ERROR(a.kind() == PackKind::kEpisodes ? compareEpisodes(a, b, options, difference)
                                                  : compareScenes(a, b, options, difference));
  return difference;
}

Result<PackDifference> compareFiles(const DiffOptions& options) {
  if (isReport(options.a)) return compareReports(options.a, options.b, options.share);
  ASSIGN_OR_RETURN(const auto a, PackFile::open(options.a, options.trust));
  ASSIGN_OR_RETURN(const auto b, PackFile::open(options.b, options.trust));
  return comparePacks(a, b, options);
}

}  // namespace

int runDiff(const DiffOptions& options, const Console& console) {
  const auto difference = compareFiles(options);
  if (!difference) return reportError(console, difference.error());
  console.out << (options.form == OutputForm::kJson ? jsonText(diffJson(*difference))
                                                    : diffText(*difference));
  return difference->differs() ? kExitDiffers : kExitOk;
}

}  // namespace galactic::pack_tool
