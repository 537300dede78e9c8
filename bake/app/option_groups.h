#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "options.h"

namespace galactic::bake {

// The options of galactic-bake in groups, each in a file of its own. A group adds its options to
// the parser, understands their texts after parsing, and remembers those that decide the content.

/// Up axis, unit and transform of meshes: for scenes and objects.
class ImportOptions {
 public:
  void addTo(CLI::App& app);
  [[nodiscard]] Result<void> understand(BakeCommand& command) const;
  void remember(BakeCommand& command) const;

 private:
  std::string up_;
  std::string scale_;
  std::string transform_;
};

/// Column grids.
class SceneOptions {
 public:
  void addTo(CLI::App& app, BakeCommand& command);
  /// `seeds` are the texts of --seed, which means something else for episodes.
  [[nodiscard]] Result<void> understand(BakeCommand& command,
                                        const std::vector<std::string>& seeds);
  void remember(BakeCommand& command) const;

 private:
  std::string spacing_ = "0.03";
  CLI::Option* components_ = nullptr;
  std::vector<std::string> seeds_;
};

/// Oriented boxes and sphere sets of objects, and the spheres of robots.
class ShapeOptions {
 public:
  void addTo(CLI::App& app, BakeCommand& command);
  [[nodiscard]] Result<void> understand(BakeCommand& command) const;
  void remember(BakeCommand& command) const;

 private:
  std::string profile_;
  std::string eps_;
  std::string tau_;
  bool any_side_ = false;
};

/// What is drawn of scenes, objects and robots.
class RenderMeshOptions {
 public:
  void addTo(CLI::App& app, BakeCommand& command);
  [[nodiscard]] Result<void> understand(BakeCommand& command) const;
  void remember(BakeCommand& command) const;

 private:
  std::string error_;
  bool none_ = false;
};

/// Where a robot's files are, and its recipe.
class RobotFileOptions {
 public:
  void addTo(CLI::App& app, BakeCommand& command);
  [[nodiscard]] Result<void> understand(BakeCommand& command) const;
  void remember(BakeCommand& command) const;

 private:
  std::vector<std::string> packages_;
};

/// Episodes: imported from published sets, or generated.
class EpisodeSetOptions {
 public:
  void addTo(CLI::App& app, BakeCommand& command);
  /// `seeds` are the texts of --seed.
  [[nodiscard]] Result<void> understand(BakeCommand& command,
                                        const std::vector<std::string>& seeds);
  void remember(BakeCommand& command) const;

 private:
  [[nodiscard]] Result<void> understandImport(BakeCommand& command) const;
  [[nodiscard]] Result<void> understandGeneration(BakeCommand& command,
                                                  const std::vector<std::string>& seeds) const;
  [[nodiscard]] Result<void> understandGeometry(BakeCommand& command) const;
  void addGeneration(CLI::App& app, BakeCommand& command);
  static void rememberGeneration(BakeCommand& command);

  std::vector<CLI::Option*> for_import_;
  std::vector<CLI::Option*> for_generation_;
  const CLI::Option* split_ = nullptr;
  std::string object_up_;
  std::string targets_ = "first";
  std::vector<std::string> start_joints_;
  std::vector<std::string> scene_names_;
  std::string objects_;
  std::string heights_;
  std::string goal_distance_;
  std::string start_distance_;
  std::string held_out_;
  std::vector<std::string> geometry_;
};

/// Scene datasets, and how many packs are baked at once.
class PlannedOptions {
 public:
  void addDatasetTo(CLI::App& app, BakeCommand& command);
  void addTo(CLI::App& app, BakeCommand& command);
  [[nodiscard]] Result<void> understand(BakeCommand& command) const;

 private:
  std::string shard_;
  std::string memory_;
};

}  // namespace galactic::bake
