#include "asset/texture_packs.h"

#include "galactic/pack.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Whether an intact texture pack exists. Its content need not be compared, as the name is a hash
/// of it.
bool isThere(const std::filesystem::path& pack) {
  const auto opened = PackFile::open(pack);
  return opened && opened->kind() == PackKind::kTexture;
}

}  // namespace

bool TexturePacks::isWhole(const std::filesystem::path& pack) {
  Entry& entry = entryOf(pack);
  const std::lock_guard lock(entry.mutex);
  if (!entry.is_whole) entry.is_whole = isThere(pack);
  return entry.is_whole;
}

Result<void> TexturePacks::provide(const std::filesystem::path& pack,
                                   const std::function<Result<void>()>& make) {
  Entry& entry = entryOf(pack);
  const std::lock_guard lock(entry.mutex);
  if (!entry.is_whole && !isThere(pack)) RETURN_IF_ERROR(make());
  entry.is_whole = true;
  return {};
}

TexturePacks::Entry& TexturePacks::entryOf(const std::filesystem::path& pack) {
  const std::lock_guard lock(mutex_);
  // References to the elements of a std::map stay valid.
  return entries_[pack];
}

}  // namespace galactic::bake
