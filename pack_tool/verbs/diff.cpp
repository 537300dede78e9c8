#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

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

/// Takes the folder that has the world's own name out of the paths of a world's packs, so that one
/// baked under another name has the same.
void leaveOutOwnFolder(Json& description, const std::string& file) {
  const std::string folder = std::filesystem::path(file).stem().string() + "/";
  const auto shorten = [&folder](Json& list, const char* key) {
    for (Json& element : list) {
      const std::string path = element.at(key).get<std::string>();
      if (path.starts_with(folder)) element[key] = path.substr(folder.size());
    }
  };
  shorten(description.at("world").at("packs"), "path");
  shorten(description.at("provenance").at("sources"), "name");
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
    if (a.kind() == PackKind::kWorld) {
      leaveOutOwnFolder(descriptions.a, difference.a);
      leaveOutOwnFolder(descriptions.b, difference.b);
    }
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
