#include <fmt/format.h>

#include <utility>

#include "galactic/pack_reference.h"
#include "pack_tool/figure/shared_textures_of.h"
#include "pack_tool/output_file.h"
#include "pack_tool/pack_description.h"
#include "pack_tool/verbs.h"
#include "view/page.h"

namespace galactic::pack_tool {

namespace {

/// The pack, and what it lists if it is a world: textures are parts of what shows them.
Result<std::vector<PackFile>> openWithListed(const ViewOptions& options) {
  std::vector<PackFile> packs;
  auto pack = PackFile::open(options.pack, options.trust);
  if (!pack) return tl::unexpected(pack.error());
  if (pack->kind() == PackKind::kWorld) {
    const auto references = packReferences(*pack);
    if (!references) return tl::unexpected(references.error());
    for (const PackReference& reference : *references) {
      if (reference.kind == PackKind::kTexture) continue;
      auto listed = openReference(*pack, reference, options.trust);
      if (!listed) return tl::unexpected(listed.error());
      packs.push_back(std::move(*listed));
    }
  }
  packs.push_back(std::move(*pack));
  return packs;
}

bool hasMeshes(const PackFile& pack) {
  return pack.kind() == PackKind::kScene || pack.kind() == PackKind::kObjects ||
         pack.kind() == PackKind::kRobot;
}

Result<void> viewPack(const ViewOptions& options) {
  const auto packs = openWithListed(options);
  if (!packs) return tl::unexpected(packs.error());
  std::vector<PageAsset> assets;
  for (const PackFile& pack : *packs) {
    if (auto checked = checkOutput(pack, options.output); !checked) return checked;
    Json facts = describePack(pack, Detail::kSummary);
    // Where the pack lay is nobody's business who is sent the page.
    facts["file"] = std::filesystem::path(pack.where()).filename().string();
    assets.push_back({.pack = &pack,
                      .meshes = hasMeshes(pack) ? renderMeshesWithTextures(pack) : nullptr,
                      .facts = jsonText(facts)});
  }
  const auto page = viewPage(assets, {},
                             {.title = options.pack.filename().string(),
                              .generator = "galactic-pack",
                              .texture_size = options.texture_size});
  if (!page) return tl::unexpected(page.error());
  return writeOutput(options.output, *page);
}

}  // namespace

int runView(const ViewOptions& options, const Console& console) {
  const auto done = viewPack(options);
  return done ? kExitOk : reportError(console, done.error());
}

}  // namespace galactic::pack_tool
