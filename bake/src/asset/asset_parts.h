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

// What the bakes of whole assets have in common.

/// The place of an error in `file`, from the place that a baker named, which knows no files: an
/// option in backquotes, an element, or nothing.
[[nodiscard]] std::string inFile(const std::filesystem::path& file, const std::string& where);

/// What is said of the exception that is being handled, which ended the work on `input`: that
/// memory ran out, that a reader was killed, or a bug. Called in a catch block.
[[nodiscard]] Error errorOfExceptionAt(const std::filesystem::path& input);

/// What `bake` makes, whose Outcome says how long that took.
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

/// What a long bake has done, in OUTPUT.partial until the pack is written; null where nothing is
/// written, or where no file can have so long a name. All that decides what comes out: the options
/// of `job`, the content of `files`, and this program, of which another build may bake other bytes.
[[nodiscard]] Result<std::unique_ptr<Journal>> openJournal(const Job& job,
                                                           std::span<const SourceFile> files,
                                                           const BakeContext& context);

/// Render meshes of one asset, or none where none are wanted.
using OptionalMeshes = std::optional<BakedRenderMeshes>;

/// Bake what is drawn of an asset that was read from `input`, and add the warnings. Errors name the
/// input. Of a scene the grids of `baked` tell where its room is, and the warnings are added there.
[[nodiscard]] Result<OptionalMeshes> drawScene(const ReadScene& scene, const DrawOptions& options,
                                               BakedScene& baked, const BakeContext& context);
[[nodiscard]] Result<OptionalMeshes> drawObject(const SourceAsset& object,
                                                const DrawOptions& options,
                                                const std::filesystem::path& input,
                                                std::vector<std::string>& warnings,
                                                const BakeContext& context);
/// Links are lit in the start pose of `baked`, to which the warnings are added.
[[nodiscard]] Result<OptionalMeshes> drawRobot(const SourceRobot& robot, const DrawOptions& options,
                                               const std::filesystem::path& input,
                                               BakedRobot& baked, const BakeContext& context);

/// Where `options` share textures between packs, writes those of `materials` that are not there
/// yet, each into a pack named by its content, and leaves their texels out of the asset's own pack.
[[nodiscard]] Result<void> shareTextures(BakedMaterials& materials, const DrawOptions& options,
                                         const BakeContext& context);

}  // namespace galactic::bake
