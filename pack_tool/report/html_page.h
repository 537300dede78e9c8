#pragma once
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

/// One self-contained HTML file: a table of the packs, then each with its warnings, what `info`
/// prints and its pictures. The same packs give the same bytes.
[[nodiscard]] std::string htmlPage(const std::string& title, const std::vector<PackEntry>& packs);

}  // namespace galactic::pack_tool
