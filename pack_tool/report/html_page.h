#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pack_tool/describe/pack_description.h"
#include "pack_tool/report/thumbnails.h"

namespace galactic::pack_tool {

/// What a page shows of one pack.
struct PackEntry {
  /// As describePack tells, without details.
  Json description;
  std::vector<Thumbnail> thumbnails;
};

/// The texture packs that worlds list. A page counts them; they are shown with what they lie on.
struct ListedTextures {
  std::size_t count = 0;
  std::uint64_t bytes = 0;
};

/// One self-contained HTML file: a table of the packs, then each with its warnings, what `info`
/// prints and its pictures. The same packs give the same bytes.
[[nodiscard]] std::string htmlPage(const std::string& title, const std::vector<PackEntry>& packs,
                                   const ListedTextures& textures);

}  // namespace galactic::pack_tool
