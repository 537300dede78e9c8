#include <cstddef>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "galactic/pack_reference.h"
#include "pack_tool/report/html_page.h"
#include "pack_tool/support/open_listed.h"
#include "pack_tool/support/output_file.h"
#include "pack_tool/verbs/verbs.h"
#include "support/files/output_files.h"
#include "support/threads/workers.h"
#include "support/try.h"

namespace galactic::pack_tool {

namespace {

/// A pack as seen from `folder`, or its file's name where that would lead upwards: what pages say
/// does not depend on where packs lie.
std::string nameFrom(const std::filesystem::path& folder, const std::filesystem::path& pack) {
  std::error_code ignored;
  const std::filesystem::path relative =
      std::filesystem::absolute(pack, ignored).lexically_normal().lexically_relative(folder);
  const bool is_below = !relative.empty() && *relative.begin() != "..";
  return (is_below ? relative : pack.filename()).generic_string();
}

Result<PackEntry> entryOf(const std::vector<PackFile>& packs, std::size_t number,
                          const std::filesystem::path& folder, AbsentTextures& absent) {
  const PackFile& pack = packs[number];
  PackEntry entry{.description = describePack(pack, Detail::kSummary), .thumbnails = {}};
  entry.description["file"] = nameFrom(folder, entry.description.at("file").get<std::string>());
  ASSIGN_OR_RETURN(auto thumbnails, thumbnailsOf(packs, number, absent));
  entry.thumbnails = std::move(thumbnails);
  return entry;
}

/// On all cores; what becomes of a pack does not depend on which thread draws it.
std::vector<Result<PackEntry>> entriesOf(const std::vector<PackFile>& packs,
                                         const std::filesystem::path& folder,
                                         AbsentTextures& absent) {
  std::vector<Result<PackEntry>> entries(packs.size());
  detail::forEachPart(detail::threadCount(0), packs.size(),
                      [&](std::size_t n) { entries[n] = entryOf(packs, n, folder, absent); });
  return entries;
}

/// Those that the worlds among the packs list, each once.
Result<ListedTextures> listedTextures(const std::vector<PackFile>& packs) {
  ListedTextures textures;
  std::set<std::filesystem::path> seen;
  for (const PackFile& pack : packs) {
    if (pack.kind() != PackKind::kWorld) continue;
    ASSIGN_OR_RETURN(const auto references, packReferences(pack));
    for (const PackReference& reference : references) {
      if (reference.kind != PackKind::kTexture) continue;
      if (!seen.insert(pathOf(reference, pack).lexically_normal()).second) continue;
      ++textures.count;
      textures.bytes += reference.bytes;
    }
  }
  return textures;
}

Result<void> makeReport(const ReportOptions& options, AbsentTextures& absent) {
  RETURN_IF_ERROR(checkExtension(options.output, kPageFile));
  ASSIGN_OR_RETURN(
      const auto packs,
      openListed({.packs = options.packs, .output = options.output, .trust = options.trust}));
  std::vector<PackEntry> entries;
  entries.reserve(packs.size());
  std::error_code ignored;
  const std::filesystem::path folder =
      std::filesystem::absolute(options.packs.front(), ignored).lexically_normal().parent_path();
  for (Result<PackEntry>& entry : entriesOf(packs, folder, absent)) {
    if (!entry) return tl::unexpected(entry.error());
    entries.push_back(std::move(*entry));
  }
  ASSIGN_OR_RETURN(const auto textures, listedTextures(packs));
  return writeOutput(options.output,
                     htmlPage(options.packs.front().filename().string(), entries, textures));
}

}  // namespace

int runReport(const ReportOptions& options, const Console& console) {
  AbsentTextures absent;
  const auto done = makeReport(options, absent);
  if (!done) return reportError(console, done.error());
  reportWarning(console, absent.warning());
  return kExitOk;
}

}  // namespace galactic::pack_tool
