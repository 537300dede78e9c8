#include "pack_tool/support/open_listed.h"

#include <utility>

#include "galactic/pack_reference.h"
#include "pack_tool/support/output_file.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::pack_tool {

Result<std::vector<PackFile>> openListed(const ListedPacks& wanted) {
  std::vector<PackFile> packs;
  for (const std::filesystem::path& path : wanted.packs) {
    ASSIGN_OR_RETURN(auto pack, PackFile::open(path, wanted.trust));
    if (pack.kind() == PackKind::kWorld) {
      ASSIGN_OR_RETURN(const auto references, packReferences(pack));
      for (const PackReference& reference : references) {
        if (reference.kind == PackKind::kTexture) {
          RETURN_IF_ERROR(checkNotInput(wanted.output, pathOf(reference, pack)));
          continue;
        }
        ASSIGN_OR_RETURN(auto listed, openReference(pack, reference, wanted.trust));
        packs.push_back(std::move(listed));
      }
    }
    packs.push_back(std::move(pack));
  }
  for (const PackFile& pack : packs) {
    RETURN_IF_ERROR(checkOutput(pack, wanted.output));
  }
  return packs;
}

}  // namespace galactic::pack_tool
