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

/// The file that a reference in a robot's file means.
struct MeshResolution {
  /// Empty if the file was not found.
  std::filesystem::path file;
  /// For users: the rule by which it was found, or where it was looked for.
  std::string how;
  /// Whether it was found by a guess that deserves a warning.
  bool guessed = false;
};

/// Finds the files that one robot's file refers to; see importRobot for the order.
class MeshResolver {
 public:
  MeshResolver(const std::filesystem::path& path, const RobotImportOptions& options);

  [[nodiscard]] MeshResolution resolve(const std::string& reference);

  /// The places where the references so far were looked for; of those below the search roots, only
  /// the folders that have the package's name.
  [[nodiscard]] const FileSearch& search() const { return search_; }
  /// The package.xml files above the robot's file that were looked into: if they had other
  /// contents, or were missing, references might lead elsewhere.
  [[nodiscard]] const std::set<std::filesystem::path>& packageFiles() const {
    return package_files_;
  }
  /// Whether the search went beyond these places, to all folders below the search roots.
  [[nodiscard]] bool hasSearched() const { return has_searched_; }

 private:
  /// A file of a package that is being looked for.
  struct Wanted {
    std::string package;
    /// Its path within the package.
    std::string rest;
    /// Where it was looked for in vain.
    std::vector<std::filesystem::path> tried;
  };

  [[nodiscard]] MeshResolution resolvePackage(const std::string& package, const std::string& rest);
  /// The file, if it is in a folder that may be its package's.
  [[nodiscard]] std::optional<MeshResolution> resolveIn(const std::filesystem::path& folder,
                                                        Wanted& wanted, std::string how);
  /// The file, if it is in a package above the robot's file, or beside one of the folders above it.
  [[nodiscard]] std::optional<MeshResolution> resolveAbove(Wanted& wanted);
  [[nodiscard]] MeshResolution resolveRelative(const std::string& reference);
  /// Of the files with this name in the folders above the robot's file, the nearest that is in
  /// reach. If all are out of reach, a resolution that says so; none if there are no such files.
  /// `how` is the rule.
  [[nodiscard]] std::optional<MeshResolution> guessAbove(const std::string& name, std::string how);
  /// A resolution without a file that lists where it was looked for.
  [[nodiscard]] MeshResolution notFound(const std::vector<std::filesystem::path>& tried) const;
  /// A resolution without a file that says how to allow this one.
  [[nodiscard]] MeshResolution outOfReach(const std::filesystem::path& file) const;
  /// Folders in the search roots that have the name `package`, or a package.xml with it.
  [[nodiscard]] const std::vector<std::filesystem::path>& foldersOf(const std::string& package);

  /// Whether a file at a path that may lead anywhere may be read.
  [[nodiscard]] bool isInReach(const std::filesystem::path& path);

  /// `folder / name`, also with %20 decoded or backslashes replaced, if there is such a file.
  [[nodiscard]] std::optional<std::filesystem::path> fileIn(const std::filesystem::path& folder,
                                                            const std::string& name);
  /// Whether `folder`, which is above the robot's file, has a package.xml that can be read.
  [[nodiscard]] bool findsPackageFile(const std::filesystem::path& folder);
  /// Whether `folder`, which is above the robot's file, is the package according to its name or its
  /// package.xml.
  [[nodiscard]] bool isPackageAbove(const std::filesystem::path& folder,
                                    const std::string& package);

  const RobotImportOptions& options_;
  FileSearch search_;
  std::set<std::filesystem::path> package_files_;
  bool has_searched_ = false;
  /// The folder of the robot's file and its parents, nearest first.
  std::vector<std::filesystem::path> ancestors_;
  std::map<std::string, std::vector<std::filesystem::path>> folders_of_package_;
};

}  // namespace galactic::bake
