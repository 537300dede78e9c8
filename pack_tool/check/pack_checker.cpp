#include "pack_tool/check/pack_checker.h"

#include <fmt/format.h>

#include "galactic/pack_reference.h"
#include "galactic/world.h"
#include "pack_tool/check/finding.h"
#include "pack_tool/support/console.h"
#include "support/text/counted.h"

namespace galactic::pack_tool {

namespace {

CheckedPack goodPack(const PackFile& pack) {
  CheckedPack checked;
  checked.file = pack.where();
  checked.kind = pack.kind();
  checked.bytes = pack.bytes().size();
  return checked;
}

/// What the world says once its packs are known.
CheckedPack verdict(const PackFile& world, std::vector<PackFile> good_packs, std::size_t listed) {
  if (good_packs.size() < listed) {
    return badPack(world.where(), {ErrorCode::kInvalidInput, world.where(),
                                   fmt::format("lists {}, {} of them bad; see above",
                                               counted(listed, "pack"), listed - good_packs.size()),
                                   "world/bad-pack"});
  }
  const auto fits = checkTogether(std::move(good_packs));
  return fits ? goodPack(world) : badPack(world.where(), fits.error());
}

/// Each of the listed packs, then, where all are good, whether they fit together.
CheckedPack checkWorld(const PackFile& world) {
  const auto references = packReferences(world);
  if (!references) return badPack(world.where(), references.error());
  std::vector<CheckedPack> listed;
  std::vector<PackFile> packs;
  listed.reserve(references->size());
  packs.reserve(references->size());
  for (const PackReference& reference : *references) {
    Result<PackFile> pack = openReference(world, reference);
    const std::string file = pathOf(reference, world).string();
    if (!pack) {
      listed.push_back(badPack(file, pack.error()));
      continue;
    }
    listed.push_back(goodPack(*pack));
    packs.push_back(std::move(*pack));
  }
  CheckedPack checked = verdict(world, std::move(packs), references->size());
  checked.is_world = true;
  checked.listed = std::move(listed);
  return checked;
}

}  // namespace

int CheckedPack::exitCode() const {
  int worst = finding ? static_cast<int>(finding->error.code) : kExitOk;
  for (const CheckedPack& pack : listed) worst = worseExit(worst, pack.exitCode());
  return worst;
}

CheckedPack badPack(const std::string& file, const Error& error) {
  CheckedPack checked;
  checked.file = file;
  checked.finding = Finding{findingCode(error, file), error};
  return checked;
}

CheckedPack checkPack(const std::filesystem::path& path) {
  const auto pack = PackFile::open(path, Trust::kVerify);
  if (!pack) return badPack(path.string(), pack.error());
  return pack->kind() == PackKind::kWorld ? checkWorld(*pack) : goodPack(*pack);
}

}  // namespace galactic::pack_tool
