#pragma once
#include "pack_tool/diff/diff_text.h"
#include "pack_tool/verbs/verbs.h"

namespace galactic::pack_tool {

/// The descriptions (describePack) of two packs of one kind.
struct DescribedPair {
  Json a;
  Json b;
};

/// Compares two packs of objects, or two of robots, by their descriptions: what the runtime reads
/// goes to `difference.content`; provenance, statistics and meshes go to `difference.provenance`.
/// Objects and links are paired by name; the order of a robot's positions and controlled joints
/// counts. Spheres are summarized: their numbers by radius, else how
/// many moved and how far.
void compareAssets(DescribedPair packs, const DiffOptions& options, PackDifference& difference);

}  // namespace galactic::pack_tool
