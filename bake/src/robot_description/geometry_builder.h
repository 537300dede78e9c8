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

/// Turns the shapes of a description's links into those of a SourceRobot, loading each mesh file
/// once.
class GeometryBuilder {
 public:
  /// Fills in the meshes, files, warnings and resolutions of `robot`. `own_meshes` are those that
  /// stand in the robot's file, at `path`.
  GeometryBuilder(const std::filesystem::path& path, std::span<const DescribedMesh> own_meshes,
                  const RobotImportOptions& options, SourceRobot& robot);

  /// Fills in the shapes of `to`. Fails with kInvalidInput on broken numbers, and when the link
  /// lost all the geometry that it had, unless the options allow it.
  Result<void> addShapes(const DescribedLink& from, SourceLink& to);

  /// Fills in where the meshes of the links so far are not, and what else decided where they are.
  void noteSearch();

 private:
  /// A mesh that was loaded, or why there is none.
  struct LoadedMesh {
    std::optional<std::uint32_t> index;
    /// Of the box around its points, in the frame of the file; meters.
    std::array<double, 3> size{};
    std::string failure;
  };
  struct ShapeList {
    const std::vector<DescribedShape>& from;
    std::vector<LinkShape>& to;
    const char* kind;
  };

  /// A shape that was lost, and why.
  struct LostShape {
    std::string place;
    std::string reason;
  };

  /// The shapes of the list that were lost; nothing warned of them.
  Result<std::vector<LostShape>> addList(const DescribedLink& link, const ShapeList& list);
  /// The shape, or nothing when it is lost or has no size.
  Result<std::optional<LinkShape>> convert(const DescribedShape& shape, const std::string& place,
                                           std::vector<LostShape>& lost);
  /// The mesh of the shape, or nothing when it is lost.
  Result<std::optional<std::uint32_t>> loadMesh(const DescribedShape& shape,
                                                const std::string& place,
                                                std::vector<LostShape>& lost);
  /// The index of a mesh that is there; warns where its size is odd.
  std::optional<std::uint32_t> checkedMesh(const DescribedShape& shape, const std::string& place,
                                           const LoadedMesh& mesh);
  /// Where the reference leads; says so the first time.
  const MeshResolution& resolve(const std::string& reference, const std::string& place);
  /// `hides_looks`: nothing warns of looks that are missing.
  Result<LoadedMesh> loadFile(const std::filesystem::path& file, bool hides_looks);
  /// A mesh that stands in the robot's file; `own_mesh`: its index among these.
  LoadedMesh& loadOwn(std::uint32_t own_mesh);
  /// The image that the shape is to be drawn with; empty, with a warning, where there is none.
  std::string findTexture(const DescribedShape& shape, const std::string& place);
  /// The place without the name of the robot's file, which every warning would repeat.
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
