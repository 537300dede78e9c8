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

  /// A pack NAME.pack below the world's folder; `input` is the job's main one.
  PackJob& add(const std::string& name, Job job, const std::filesystem::path& input);
  void setEpisodes(EpisodeImportJob job);
  /// In the packs of scenes, objects and robot.
  void setEpisodes(EpisodeGenerationJob job);
  /// The same of an object that scenes of a dataset move.
  void addMovable(const std::string& name, ObjectJob job);
  void setTask(std::vector<OptionText> task);
  void leaveOut(LeftOut scene) { plan_.left_out.push_back(std::move(scene)); }
  void addBroken(BrokenScene scene) { plan_.broken.push_back(std::move(scene)); }
  /// A folder that is an input as a whole: no pack may be written into it.
  void keepOutOf(const std::filesystem::path& folder) { input_folders_.push_back(folder); }
  /// Says each sentence once.
  void warn(const std::string& warning);
  /// Where the packs go.
  [[nodiscard]] const std::filesystem::path& folder() const { return plan_.folder; }
  /// The pack of this name; null where there is none.
  [[nodiscard]] const PackJob* find(const std::string& name) const;
  /// Fails with kInvalidInput where the packs would not have the same radii, and not fit together.
  [[nodiscard]] Result<void> checkRadii() const;
  /// Fails with kInvalidInput where the packs so far lack what generated episodes need: an object,
  /// and a robot with a recipe.
  [[nodiscard]] Result<void> checkForEpisodes() const;

  /// The plan, its assets sorted. Fails with kInvalidInput where two packs have one name, where one
  /// would lie outside of the world's folder, where no scene is left, and where that folder is an
  /// input's.
  [[nodiscard]] Result<WorldPlan> finish();

 private:
  [[nodiscard]] Result<void> checkScenes() const;
  [[nodiscard]] Result<void> checkFolder() const;
  /// Packs among a dataset's own files would be found by whoever reads it next.
  [[nodiscard]] Result<void> checkInputFolders() const;
  [[nodiscard]] bool hasObjectsAndRobot() const;
  /// Gives them the packs in which they are generated, or their starts are drawn.
  void completeEpisodes();

  WorldPlan plan_;
  std::vector<std::filesystem::path> input_folders_;
};

/// Adds a pack for each wanted scene of the dataset, and one for each movable object in them.
[[nodiscard]] Result<void> addDataset(const DatasetJobs& dataset, BakeLibraries& libraries,
                                      PackList& packs);

}  // namespace galactic::bake
