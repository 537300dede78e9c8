#include <filesystem>
#include <utility>
#include <vector>

#include "pack_tool/describe/pack_description.h"
#include "pack_tool/figure/shared_textures_of.h"
#include "pack_tool/support/open_listed.h"
#include "pack_tool/support/output_file.h"
#include "pack_tool/verbs/verbs.h"
#include "support/files/output_files.h"
#include "support/try.h"
#include "view/page.h"

namespace galactic::pack_tool {

namespace {

bool hasMeshes(const PackFile& pack) {
  return pack.kind() == PackKind::kScene || pack.kind() == PackKind::kObjects ||
         pack.kind() == PackKind::kRobot;
}

Result<void> viewPack(const ViewOptions& options, AbsentTextures& absent) {
  RETURN_IF_ERROR(checkExtension(options.output, kPageFile));
  ASSIGN_OR_RETURN(
      const auto packs,
      openListed({.packs = {options.pack}, .output = options.output, .trust = options.trust}));
  std::vector<PageAsset> assets;
  for (const PackFile& pack : packs) {
    Json facts = describePack(pack, Detail::kSummary);
    // Where the pack lay is nobody's business who is sent the page.
    facts["file"] = std::filesystem::path(pack.where()).filename().string();
    auto meshes = hasMeshes(pack) ? renderMeshesWithTextures(pack) : nullptr;
    absent.note(pack, meshes.get());
    assets.push_back({.pack = &pack, .meshes = std::move(meshes), .facts = jsonText(facts)});
  }
  ASSIGN_OR_RETURN(const auto page, viewPage(assets, {},
                                             {.title = options.pack.filename().string(),
                                              .generator = "galactic-pack",
                                              .texture_size = options.texture_size}));
  return writeOutput(options.output, page);
}

}  // namespace

int runView(const ViewOptions& options, const Console& console) {
  AbsentTextures absent;
  const auto done = viewPack(options, absent);
  if (!done) return reportError(console, done.error());
  reportWarning(console, absent.warning());
  return kExitOk;
}

}  // namespace galactic::pack_tool
