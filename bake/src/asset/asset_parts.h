#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "asset/scene_source.h"
#include "galactic/bake/assets.h"
#include "render/render_source.h"
#include "support/files/journal.h"
#include "support/threads/stopwatch.h"

namespace galactic::bake {

// What the bakes of whole assets share.

/// The place of an error in `file`. `where` comes from a baker, which does not know the file: an
/// option in backquotes, an element, or nothing.
[[nodiscard]] std::string inFile(const std::filesystem::path& file, const std::string& where);

/// The error for the exception being handled, which ended the work on `input`: memory ran out, a
/// reader was killed, or a bug. Call it in a catch block.
[[nodiscard]] Error errorOfExceptionAt(const std::filesystem::path& input);

/// Calls `bake` and stores in its Outcome how long that took.
template <class Outcome, class Bake>
[[nodiscard]] Result<BakedPack> timed(const Bake& bake) {
  double seconds = 0;
  Result<BakedPack> made = [&] {
    const detail::Stopwatch timer(seconds);
    return bake();
  }();
  if (made) std::get<Outcome>(made->outcome).seconds = seconds;
  return made;
}

/// Adds the description of each of `files` that is not empty.
[[nodiscard]] Result<void> addSources(const std::vector<std::filesystem::path>& files,
                                      std::vector<SourceFile>& sources);

/// Opens the journal of a long bake, which is kept in OUTPUT.partial until the pack is written.
/// Null for a dry run, or if that file name would be too long. The journal is only valid for the
/// same options of `job`, content of `files` and build of this program, because these decide the
/// result.
[[nodiscard]] Result<std::unique_ptr<Journal>> openJournal(const Job& job,
                                                           std::span<const SourceFile> files,
                                                           const BakeContext& context);

/// Render meshes of one asset; none if they are not wanted.
using OptionalMeshes = std::optional<BakedRenderMeshes>;

/// Bake the render meshes of an asset that was read from `input`, and add the warnings. Errors name
/// the input. For a scene, the grids of `baked` show where its rooms are, and `baked` receives the
/// warnings.
[[nodiscard]] Result<OptionalMeshes> drawScene(const ReadScene& scene, const DrawOptions& options,
                                               BakedScene& baked, const BakeContext& context);
[[nodiscard]] Result<OptionalMeshes> drawObject(const SourceAsset& object,
                                                const DrawOptions& options,
                                                const std::filesystem::path& input,
                                                std::vector<std::string>& warnings,
                                                const BakeContext& context);
/// Links are lit in the start pose of `baked`, which receives the warnings.
[[nodiscard]] Result<OptionalMeshes> drawRobot(const SourceRobot& robot, const DrawOptions& options,
                                               const std::filesystem::path& input,
                                               BakedRobot& baked, const BakeContext& context);

/// If `options` share textures between packs, writes each texture of `materials` that does not
/// exist yet to a pack named after its content, and leaves the texels out of the asset's own pack.
[[nodiscard]] Result<void> shareTextures(BakedMaterials& materials, const DrawOptions& options,
                                         const BakeContext& context);

}  // namespace galactic::bake
