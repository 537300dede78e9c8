#pragma once
#include <filesystem>
#include <vector>

#include "galactic/pack.h"

namespace galactic::pack_tool {

/// Which packs are wanted, and what is written of them.
struct ListedPacks {
  std::vector<std::filesystem::path> packs;
  std::filesystem::path output;
  Trust trust = Trust::kVerify;
};

/// The packs, each behind those that it lists if it is a world; textures are left out, they are
/// parts of what shows them. Fails with the errors of PackFile::open and openReference, and with
/// kInvalidInput when the output is one of the packs, or a texture.
[[nodiscard]] Result<std::vector<PackFile>> openListed(const ListedPacks& wanted);

}  // namespace galactic::pack_tool
