#pragma once
#include "galactic/pack.h"
#include "pack_tool/diff/diff_text.h"
#include "pack_tool/verbs/verbs.h"

namespace galactic::pack_tool {

/// Compares two packs of episodes: names and numbers, then episode by episode in their order. What
/// differs goes to `difference.content`, the provenance to `difference.provenance`. Names count,
/// not the indices behind them; of the objects of an episode, their names are compared, and where
/// these agree, how many lie elsewhere and how far. The set's own name is no content.
/// `options.tolerance` applies to lengths, angles and the parts of quaternions.
[[nodiscard]] Result<void> compareEpisodes(const PackFile& a, const PackFile& b,
                                           const DiffOptions& options, PackDifference& difference);

}  // namespace galactic::pack_tool
