#include "asset/asset_parts.h"

#include <fmt/format.h>

#include <climits>
#include <utility>

#include "asset/texture_packs.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/source_asset.h"
#include "support/exception_error.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

Result<OptionalMeshes> drawFrom(Result<RenderSource> source, const DrawOptions& options,
                                const fs::path& input, std::vector<std::string>& warnings,
                                unsigned threads) {
  const auto located = [&](Error error) {
    error.where = inFile(input, error.where);
    return tl::unexpected(std::move(error));
  };
  if (!source) return located(source.error());
  auto meshes = bakeRenderMeshes(*source, options.meshes, threads);
  if (!meshes) return located(meshes.error());
  for (const auto& more : {meshes->materials.warnings, meshes->warnings}) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  return OptionalMeshes(std::move(*meshes));
}

/// The rooms for the smallest radius, which leaves the most free space.
std::vector<Bounds> roomsOf(const BakedScene& baked) {
  std::vector<Bounds> rooms;
  for (const Component& part : baked.grids.front().components) {
    if (part.region == Region::kRoom) rooms.push_back(part.bounds);
  }
  return rooms;
}

}  // namespace

std::string inFile(const fs::path& file, const std::string& where) {
  return where.empty() ? file.string() : file.string() + ": " + where;
}

Error errorOfExceptionAt(const fs::path& input) {
  Error error = errorOfException();
  // An error about a file that cannot be read or written already names that file.
  if (error.code != ErrorCode::kIo) error.where = inFile(input, error.where);
  return error;
}

Result<void> addSources(const std::vector<fs::path>& files, std::vector<SourceFile>& sources) {
  for (const fs::path& path : files) {
    if (path.empty()) continue;
    ASSIGN_OR_RETURN(auto file, describeFile(path));
    sources.push_back(std::move(file));
  }
  return {};
}

Result<std::unique_ptr<Journal>> openJournal(const Job& job, std::span<const SourceFile> files,
                                             const BakeContext& context) {
  const fs::path path = context.output.string() + ".partial";
  const bool is_possible = path.filename().string().size() <= NAME_MAX;
  if (context.dry_run || !is_possible) return std::unique_ptr<Journal>();
  RETURN_IF_ERROR(context.log.checkNotRead(path));
  ASSIGN_OR_RETURN(const SourceFile program, describeFile("/proc/self/exe"));
  std::string parts = hexOf(program) + "\n";
  for (const auto& [name, value] : contentOptions(job)) {
    parts += fmt::format("{}={}\n", name, value);
  }
  for (const SourceFile& file : files) parts += hexOf(file) + "\n";
  const SourceFile all = describeBytes({}, std::as_bytes(std::span(parts)));
  return Journal::open(path, fmt::format("{} {}", kindOf(job), hexOf(all)));
}

Result<OptionalMeshes> drawScene(const ReadScene& scene, const DrawOptions& options,
                                 BakedScene& baked, const BakeContext& context) {
  if (!options.wanted) return std::nullopt;
  // The library would only fill up with the images of scenes that share no textures.
  TextureLibrary* const images =
      options.shared_textures.empty() ? nullptr : &context.libraries.images();
  auto source =
      sceneRenderSource(scene.asset, scene.folder, options.textures, context.threads, images);
  if (source) source->rooms = roomsOf(baked);
  return drawFrom(std::move(source), options, scene.input, baked.warnings, context.threads);
}

Result<OptionalMeshes> drawObject(const SourceAsset& object, const DrawOptions& options,
                                  const fs::path& input, std::vector<std::string>& warnings,
                                  const BakeContext& context) {
  if (!options.wanted) return std::nullopt;
  return drawFrom(
      objectRenderSource(object, input.parent_path(), options.textures, context.threads), options,
      input, warnings, context.threads);
}

Result<OptionalMeshes> drawRobot(const SourceRobot& robot, const DrawOptions& options,
                                 const fs::path& input, BakedRobot& baked,
                                 const BakeContext& context) {
  if (!options.wanted) return std::nullopt;
  auto source = robotRenderSource(robot, input.parent_path(), options.textures, context.threads);
  if (source) standInStartPose(*source, baked.kinematics);
  return drawFrom(std::move(source), options, input, baked.warnings, context.threads);
}

Result<void> shareTextures(BakedMaterials& materials, const DrawOptions& options,
                           const BakeContext& context) {
  const fs::path& folder = options.shared_textures;
  if (folder.empty()) return {};
  materials.shared = true;
  if (context.dry_run) return {};
  RETURN_IF_ERROR(makeFolders(folder));
  // A shared texture must not depend on the asset in which it was found.
  Provenance provenance = provenanceOf(SceneJob{}, {}, {});
  provenance.options.clear();
  for (const BakedTexture& texture : materials.textures) {
    // The texture's name comes from the first asset that shows it, which may differ from run to
    // run, so it is replaced by the hash of its content.
    BakedTexture named = texture;
    named.name = textureHash(texture);
    const fs::path pack = folder / (named.name + ".pack");
    const auto write = [&] {
      return writeTexturePack(pack, materials, named, provenance).map([](std::uint64_t) {});
    };
    RETURN_IF_ERROR(context.libraries.texturePacks().provide(pack, write));
  }
  return {};
}

}  // namespace galactic::bake
