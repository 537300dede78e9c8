#pragma once
#include <filesystem>
#include <string>
#include <utility>

#include "galactic/error.h"
#include "options.h"
#include "plan/plan.h"

namespace galactic::bake {

/// Collects the packs of a plan.
class PackList {
 public:
  explicit PackList(std::filesystem::path world);

  /// A pack NAME.pack below the plan's folder; `input` is the main one of the command.
  PlannedPack& add(const std::string& name, BakeCommand command,
                   const std::filesystem::path& input);
  /// Without inputs the episodes are made in the packs of scenes, objects and robot.
  void setEpisodes(BakeCommand command);
  void setTask(std::vector<OptionText> task) { plan_.task = std::move(task); }
  void leaveOut(LeftOut scene) { plan_.left_out.push_back(std::move(scene)); }
  void warn(const std::string& warning) { plan_.warnings.push_back(warning); }
  /// Where the packs go.
  [[nodiscard]] const std::filesystem::path& folder() const { return plan_.folder; }
  /// Whether a pack of this name is there.
  [[nodiscard]] bool has(const std::string& name) const;

  /// The plan, sorted. Fails with kInvalidInput where two packs have one name or no scene is left.
  [[nodiscard]] Result<WorldPlan> finish();

 private:
  [[nodiscard]] Result<void> checkScenes() const;

  WorldPlan plan_;
};

}  // namespace galactic::bake
