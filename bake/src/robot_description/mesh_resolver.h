#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "galactic/bake/robot_import.h"
#include "import/source_files.h"

namespace galactic::bake {

/// What a reference of a robot's file means.
struct MeshResolution {
  /// Empty when the file was not found.
  std::filesystem::path file;
  /// For people: by which rule it was found, or where it was looked for.
  std::string how;
  /// Found by a guess that deserves a warning.
  bool guessed = false;
};

/// Turns references of one robot's file into files: see importRobot for the order.
class MeshResolver {
 public:
  MeshResolver(const std::filesystem::path& path, const RobotImportOptions& options);

  [[nodiscard]] MeshResolution resolve(const std::string& reference);

  /// Where the references so far were looked for; below the search roots, only in the folder that
  /// has the package's name.
  [[nodiscard]] const FileSearch& search() const { return search_; }
  /// The package.xml files above the robot's file that were looked into: another content of them,
  /// or none, may lead elsewhere.
  [[nodiscard]] const std::set<std::filesystem::path>& packageFiles() const {
    return package_files_;
  }
  /// Whether more was looked at than that: all folders below the search roots.
  [[nodiscard]] bool hasSearched() const { return has_searched_; }

 private:
  /// A file of a package.
  struct Wanted {
    std::string package;
    /// Its path in the package.
    std::string rest;
    /// Where it is not.
    std::vector<std::filesystem::path> tried;
  };

  [[nodiscard]] MeshResolution resolvePackage(const std::string& package, const std::string& rest);
  /// The file in a folder that may be its package's.
  [[nodiscard]] std::optional<MeshResolution> resolveIn(const std::filesystem::path& folder,
                                                        Wanted& wanted, std::string how);
  /// The file in the folders above the robot's file, and beside these.
  [[nodiscard]] std::optional<MeshResolution> resolveAbove(Wanted& wanted);
  [[nodiscard]] MeshResolution resolveRelative(const std::string& reference);
  /// The nearest file of that name in the folders above the robot's file that is in reach, or else
  /// that there is one out of reach; nothing where there is none. `how`: by which rule.
  [[nodiscard]] std::optional<MeshResolution> guessAbove(const std::string& name, std::string how);
  /// A resolution without file that lists where it was looked for.
  [[nodiscard]] MeshResolution notFound(const std::vector<std::filesystem::path>& tried) const;
  /// A resolution without file that says how to allow this one.
  [[nodiscard]] MeshResolution outOfReach(const std::filesystem::path& file) const;
  /// Folders named or described as `package` in the search roots.
  [[nodiscard]] const std::vector<std::filesystem::path>& foldersOf(const std::string& package);

  /// Whether a path that leads anywhere may be followed.
  [[nodiscard]] bool isInReach(const std::filesystem::path& path);

  /// `folder / name`, also with %20 and backslashes undone, if it is a file.
  [[nodiscard]] std::optional<std::filesystem::path> fileIn(const std::filesystem::path& folder,
                                                            const std::string& name);
  /// Whether there is a package.xml in `folder`, one above the robot's file, that can be read.
  [[nodiscard]] bool findsPackageFile(const std::filesystem::path& folder);
  /// Whether `folder`, one above the robot's file, is the package by its name or its package.xml.
  [[nodiscard]] bool isPackageAbove(const std::filesystem::path& folder,
                                    const std::string& package);

  const RobotImportOptions& options_;
  FileSearch search_;
  std::set<std::filesystem::path> package_files_;
  bool has_searched_ = false;
  /// The robot's folder and its parents, nearest first.
  std::vector<std::filesystem::path> ancestors_;
  std::map<std::string, std::vector<std::filesystem::path>> folders_of_package_;
};

}  // namespace galactic::bake
