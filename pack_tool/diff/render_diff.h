#pragma once
#include "galactic/pack.h"
#include "pack_tool/diff/asset_diff.h"

namespace galactic::pack_tool {

/// Two packs of one kind.
struct PackPair {
  const PackFile& a;
  const PackFile& b;
};

/// Compares the render meshes of two scenes, objects or robots. What is drawn goes to
/// `difference.content`: models by the names of their parts, with their clusters' triangles,
/// materials and sides, the places, texture coordinates and colors of their vertices (places and
/// texture coordinates within the tolerance); materials; textures by their texels; semantics. What
/// the source had and how far simplification went goes to `difference.provenance`. `descriptions`:
/// of the packs, by describePack.
void compareRenderMeshes(const PackPair& packs, const DescribedPair& descriptions,
                         const DiffOptions& options, PackDifference& difference);

}  // namespace galactic::pack_tool
