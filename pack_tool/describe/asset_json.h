#pragma once
#include "galactic/pack.h"
#include "pack_tool/describe/pack_description.h"

namespace galactic::pack_tool {

// The part of describePack that tells what is in one kind of pack; null on another kind.

[[nodiscard]] Json describeScene(const PackFile& pack);
[[nodiscard]] Json describeObjects(const PackFile& pack);
[[nodiscard]] Json describeRobot(const PackFile& pack);
[[nodiscard]] Json describeEpisodes(const PackFile& pack, Detail detail);
[[nodiscard]] Json describeWorld(const PackFile& pack);
[[nodiscard]] Json describePolicy(const PackFile& pack);
/// A texture that scenes share.
[[nodiscard]] Json describeTexture(const PackFile& pack);
/// What batch rendering draws; null where the pack has none.
[[nodiscard]] Json describeRenderMeshes(const PackFile& pack);

}  // namespace galactic::pack_tool
