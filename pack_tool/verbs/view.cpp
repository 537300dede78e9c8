#include <filesystem>
#include <vector>

#include "pack_tool/describe/pack_description.h"
#include "pack_tool/figure/shared_textures_of.h"
#include "pack_tool/support/open_listed.h"
#include "pack_tool/support/output_file.h"
#include "pack_tool/verbs/verbs.h"
#include "support/output_files.h"
#include "support/try.h"
#include "view/page.h"

namespace galactic::pack_tool {

namespace {

bool hasMeshes(const PackFile& pack) {
  return pack.kind() == PackKind::kScene || pack.kind() == PackKind::kObjects ||
         pack.kind() == PackKind::kRobot;
}

Result<void> viewPack(const ViewOptions& options) {
  RETURN_IF_ERROR(checkExtension(options.output, kPageFile));
  ASSIGN_OR_RETURN(
      const auto packs,
      openListed({.packs = {options.pack}, .output = options.output, .trust = options.trust}));
  std::vector<PageAsset> assets;
  for (const PackFile& pack : packs) {
    Json facts = describePack(pack, Detail::kSummary);
    // Where the pack lay is nobody's business who is sent the page.
    facts["file"] = std::filesystem::path(pack.where()).filename().string();
    assets.push_back({.pack = &pack,
                      .meshes = hasMeshes(pack) ? renderMeshesWithTextures(pack) : nullptr,
                      .facts = jsonText(facts)});
  }
  ASSIGN_OR_RETURN(const auto page, viewPage(assets, {},
                                             {.title = options.pack.filename().string(),
                                              .generator = "galactic-pack",
                                              .texture_size = options.texture_size}));
  return writeOutput(options.output, page);
}

}  // namespace

int runView(const ViewOptions& options, const Console& console) {
  const auto done = viewPack(options);
  return done ? kExitOk : reportError(console, done.error());
}

}  // namespace galactic::pack_tool
