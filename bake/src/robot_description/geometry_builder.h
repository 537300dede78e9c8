#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/bake/robot_import.h"
#include "robot_description/description.h"
#include "robot_description/mesh_resolver.h"

namespace galactic::bake {

/// Converts the shapes of a description's links to those of a SourceRobot, and loads each mesh file
/// only once.
class GeometryBuilder {
 public:
  /// Fills in the meshes, files, warnings and resolutions of `robot`. `own_meshes` are the meshes
  /// inside the robot's file, which is at `path`.
  GeometryBuilder(const std::filesystem::path& path, std::span<const DescribedMesh> own_meshes,
                  const RobotImportOptions& options, SourceRobot& robot);

  /// Fills in the shapes of `to`. Fails with kInvalidInput on invalid numbers, and if the link lost
  /// all its geometry, unless the options allow this.
  Result<void> addShapes(const DescribedLink& from, SourceLink& to);

  /// Records where the meshes of the links so far were looked for in vain, and which other files
  /// the search depended on.
  void noteSearch();

 private:
  /// A mesh that was loaded, or the reason why it was not.
  struct LoadedMesh {
    std::optional<std::uint32_t> index;
    /// Extents of the box around its points, in the frame of the file; meters.
    std::array<double, 3> size{};
    std::string failure;
  };
  struct ShapeList {
    const std::vector<DescribedShape>& from;
    std::vector<LinkShape>& to;
    const char* kind;
  };

  /// A shape that was lost, and the reason.
  struct LostShape {
    std::string place;
    std::string reason;
  };

  /// Adds the shapes of the list; returns those that were lost, of which it does not warn.
  Result<std::vector<LostShape>> addList(const DescribedLink& link, const ShapeList& list);
  /// The shape; none if it is lost or has no size.
  Result<std::optional<LinkShape>> convert(const DescribedShape& shape, const std::string& place,
                                           std::vector<LostShape>& lost);
  /// The mesh of the shape; none if it is lost.
  Result<std::optional<std::uint32_t>> loadMesh(const DescribedShape& shape,
                                                const std::string& place,
                                                std::vector<LostShape>& lost);
  /// The index of a mesh; warns if its size is suspicious.
  std::optional<std::uint32_t> checkedMesh(const DescribedShape& shape, const std::string& place,
                                           const LoadedMesh& mesh);
  /// The file that the reference leads to; recorded the first time.
  const MeshResolution& resolve(const std::string& reference, const std::string& place);
  /// `hides_looks` suppresses warnings of missing looks.
  Result<LoadedMesh> loadFile(const std::filesystem::path& file, bool hides_looks);
  /// Loads a mesh that is inside the robot's file; `own_mesh` is its index among these.
  LoadedMesh& loadOwn(std::uint32_t own_mesh);
  /// The image that the shape is to be drawn with; empty, with a warning, if it is missing.
  std::string findTexture(const DescribedShape& shape, const std::string& place);
  /// `place` without the name of the robot's file, which every warning would repeat.
  [[nodiscard]] std::string withoutFile(const std::string& place) const;
  void warn(const std::string& place, const std::string& message);

  const std::filesystem::path& path_;
  std::span<const DescribedMesh> own_meshes_;
  const RobotImportOptions& options_;
  SourceRobot& robot_;
  MeshResolver resolver_;
  Affine up_from_file_;
  std::map<std::string, MeshResolution> resolutions_;
  std::map<std::filesystem::path, LoadedMesh> loaded_;
  std::map<std::uint32_t, LoadedMesh> loaded_own_;
};

}  // namespace galactic::bake
