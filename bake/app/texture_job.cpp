#include "texture_job.h"

#include <system_error>

#include "galactic/bake/texture_pack.h"
#include "galactic/pack.h"

namespace galactic::bake {
namespace {

/// Whether the pack is there and whole: its name tells what is in it.
bool isThere(const std::filesystem::path& pack) {
  const auto opened = PackFile::open(pack);
  return opened && opened->kind() == PackKind::kTexture;
}

}  // namespace

Result<void> shareTextures(BakedMaterials& materials, const BakeCommand& command) {
  const std::filesystem::path& folder = command.render.shared_textures;
  if (folder.empty()) return {};
  materials.shared = true;
  if (command.dry_run) return {};
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem) {
    return fail(ErrorCode::kIo, folder.string(), "cannot be made a folder: " + problem.message());
  }
  // What a texture looks like says nothing of the asset that it was met in.
  const BakeCommand nothing;
  const Provenance provenance = provenanceOf(nothing, {}, {});
  for (const BakedTexture& texture : materials.textures) {
    const std::filesystem::path pack = folder / (textureHash(texture) + ".pack");
    if (isThere(pack)) continue;
    // Its source is the first asset that shows it, which may differ: a name of its own.
    BakedTexture named = texture;
    named.name = textureHash(texture);
    const auto written = writeTexturePack(pack, materials, named, provenance);
    if (!written) return tl::unexpected(written.error());
  }
  return {};
}

}  // namespace galactic::bake
