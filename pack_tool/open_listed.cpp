#include "pack_tool/open_listed.h"

#include <utility>

#include "galactic/pack_reference.h"
#include "pack_tool/output_file.h"

namespace galactic::pack_tool {

Result<std::vector<PackFile>> openListed(const ListedPacks& wanted) {
  std::vector<PackFile> packs;
  for (const std::filesystem::path& path : wanted.packs) {
    auto pack = PackFile::open(path, wanted.trust);
    if (!pack) return tl::unexpected(pack.error());
    if (pack->kind() == PackKind::kWorld) {
      const auto references = packReferences(*pack);
      if (!references) return tl::unexpected(references.error());
      for (const PackReference& reference : *references) {
        if (reference.kind == PackKind::kTexture) continue;
        auto listed = openReference(*pack, reference, wanted.trust);
        if (!listed) return tl::unexpected(listed.error());
        packs.push_back(std::move(*listed));
      }
    }
    packs.push_back(std::move(*pack));
  }
  for (const PackFile& pack : packs) {
    if (auto checked = checkOutput(pack, wanted.output); !checked) {
      return tl::unexpected(checked.error());
    }
  }
  return packs;
}

}  // namespace galactic::pack_tool
