#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/mesh_library.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// How the meshes of a dataset are to be read: points as they stand in the file, because it is the
/// dataset's `up` and `front` that say how to turn them. For the MeshLibrary of compose().
[[nodiscard]] MeshImportOptions datasetMeshOptions();

/// What a dataset may read.
struct DatasetReadOptions {
  /// Whether files that the dataset names may lie anywhere: without it, below the folder above the
  /// configuration's.
  bool allow_outside = false;
};

/// A movable object that a scene instance places.
struct DatasetObject {
  /// Name of its template.
  std::string name;
  /// Mesh that is drawn and fitted, an absolute path.
  std::filesystem::path mesh;
  /// The template's axes and scale and the instance's scale.
  Affine object_from_mesh{};
};

/// What a scene instance names, found out without reading a mesh.
struct SceneSurvey {
  bool has_stage = true;
  /// As in ComposedScene.
  std::vector<std::string> missing;
  /// What the instance calls dynamic, in its order.
  std::vector<DatasetObject> movable;
  /// Those that the scene is composed of, each once, as far as they are there: of its stage and of
  /// the objects that do not move; not those in URDFs.
  std::vector<std::filesystem::path> meshes;
  /// Size of all meshes that the scene is composed of, with those in URDFs and with buffers and
  /// images of glTF, each once.
  std::uint64_t bytes = 0;
};

/// A scene instance put together. Of its movable objects it holds nothing: they are packs of their
/// own.
struct ComposedScene {
  /// Everything that does not move, in the world frame. Its instances are named as Habitat names
  /// them: the stage after its template, the others "TEMPLATE_:0000", "TEMPLATE_:0001" and so on.
  /// Paths of textures are relative to the dataset's folder. `read` lists all that was read for it
  /// (configurations, meshes, textures), by path relative to the dataset's folder; as
  /// SourceRobot::read, it is unsettled where some furniture is.
  SourceAsset scene;
  /// Where the dataset says that things may be put, world frame: the boxes of the scene, of its
  /// stage and of everything that does not move and is upright. Named "INSTANCE|RECEPTACLE", those
  /// of scene and stage "RECEPTACLE".
  std::vector<SupportRegion> receptacles;
  /// One sentence for each thing that the instance names and the dataset lacks, movable or not; it
  /// is left out.
  std::vector<std::string> missing;
  /// Whether the stage is there. Without it there is no floor.
  bool has_stage = true;
};

/// A Habitat scene dataset (*.scene_dataset_config.json): which scenes it has and what they place.
/// Immutable once read; safe to share between threads.
class SceneDataset {
 public:
  /// Reads the dataset's configuration and finds stages, objects, articulated objects and scene
  /// instances by its globs. The many configurations are read when they are needed. Fails with kIo
  /// or kInvalidInput, naming file and field.
  [[nodiscard]] static Result<SceneDataset> read(const std::filesystem::path& config,
                                                 const DatasetReadOptions& options = {});
  ~SceneDataset();
  SceneDataset(SceneDataset&&) noexcept;
  SceneDataset& operator=(SceneDataset&&) noexcept;
  SceneDataset(const SceneDataset&) = delete;
  SceneDataset& operator=(const SceneDataset&) = delete;

  /// Names of the scene instances, ascending; of a dataset that has none, of its stages, each of
  /// which is then a scene. Folders tell namesakes apart, as in uniqueNames().
  [[nodiscard]] const std::vector<std::string>& scenes() const;
  /// The folder of the configuration: names of files are relative to it.
  [[nodiscard]] const std::filesystem::path& folder() const;
  /// What the user should look at, one sentence each: globs that match nothing and so on.
  [[nodiscard]] const std::vector<std::string>& warnings() const;

  /// Changes when a template or scene is added, removed or moved: names may mean others then.
  [[nodiscard]] std::uint64_t fingerprint() const;

  /// What the scene names, as far as no mesh and no URDF has to be read for it: a URDF's missing
  /// meshes are seen only by compose(). Fails as compose() does.
  [[nodiscard]] Result<SceneSurvey> survey(std::string_view scene) const;

  /// Puts a scene together: stage, objects and articulated objects (in their default joint state)
  /// that do not move. Fails with kInvalidInput on a broken configuration or an unknown name, and
  /// with the errors of the importers on files that are there and cannot be read; what lacks is no
  /// failure. `meshes` has to read with datasetMeshOptions(). Deterministic.
  [[nodiscard]] Result<ComposedScene> compose(std::string_view scene, MeshLibrary& meshes) const;

 private:
  struct State;
  explicit SceneDataset(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace galactic::bake
