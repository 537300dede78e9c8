#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/bake/build.h"
#include "galactic/bake/job_lists.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Collects the packs of a world.
class PackList {
 public:
  explicit PackList(const std::filesystem::path& world);

  /// Adds a pack NAME.pack below the world's folder. `input`: the main input of the job.
  PackJob& add(const std::string& name, Job job, const std::filesystem::path& input);
  void setEpisodes(EpisodeImportJob job);
  /// The episodes are generated in the packs of scenes, objects and robot that the list holds.
  void setEpisodes(EpisodeGenerationJob job);
  /// Adds the pack of an object that scenes of a dataset may move.
  void addMovable(const std::string& name, ObjectJob job);
  void setTask(std::vector<OptionText> task);
  void leaveOut(LeftOut scene) { plan_.left_out.push_back(std::move(scene)); }
  void addBroken(BrokenScene scene) { plan_.broken.push_back(std::move(scene)); }
  /// Forbids writing packs into `folder`, because all of it is an input.
  void keepOutOf(const std::filesystem::path& folder) { input_folders_.push_back(folder); }
  /// Adds a warning, unless the list already holds it.
  void warn(const std::string& warning);
  /// Where the packs go.
  [[nodiscard]] const std::filesystem::path& folder() const { return plan_.folder; }
  /// The pack with this name; null if there is none.
  [[nodiscard]] const PackJob* find(const std::string& name) const;
  /// Fails with kInvalidInput if the packs have different radii, which would not fit together.
  [[nodiscard]] Result<void> checkRadii() const;
  /// Fails with kInvalidInput if the packs so far lack what generated episodes need: an object, and
  /// a robot with a recipe.
  [[nodiscard]] Result<void> checkForEpisodes() const;

  /// The plan, with its assets sorted. Fails with kInvalidInput if two packs have the same name, if
  /// one would lie outside the world's folder, if no scene is left, or if that folder belongs to an
  /// input.
  [[nodiscard]] Result<WorldPlan> finish();

 private:
  [[nodiscard]] Result<void> checkScenes() const;
  [[nodiscard]] Result<void> checkFolder() const;
  /// Refuses to write packs into a folder of inputs, where the dataset's next reader would find
  /// them.
  [[nodiscard]] Result<void> checkInputFolders() const;
  [[nodiscard]] bool hasObjectsAndRobot() const;
  /// Gives the episodes the packs in which they are generated or their starts are drawn.
  void completeEpisodes();

  WorldPlan plan_;
  std::vector<std::filesystem::path> input_folders_;
};

/// Adds a pack for each wanted scene of the dataset and for each movable object in these scenes.
[[nodiscard]] Result<void> addDataset(const DatasetJobs& dataset, BakeLibraries& libraries,
                                      PackList& packs);

}  // namespace galactic::bake
