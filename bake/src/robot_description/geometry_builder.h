#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/robot_import.h"
#include "robot_description/description.h"
#include "robot_description/mesh_resolver.h"

namespace galactic::bake {

/// Turns the shapes of a URDF's links into those of a SourceRobot, loading each mesh file once.
class GeometryBuilder {
 public:
  /// Fills in the meshes, files, warnings and resolutions of `robot`.
  GeometryBuilder(const std::filesystem::path& urdf, const RobotImportOptions& options,
                  SourceRobot& robot);

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
  /// Where the reference leads; says so the first time.
  const MeshResolution& resolve(const std::string& reference, const std::string& place);
  Result<LoadedMesh> loadFile(const std::filesystem::path& file);
  /// The place without the URDF's name, which every warning would repeat.
  [[nodiscard]] std::string withoutUrdf(const std::string& place) const;
  void warn(const std::string& place, const std::string& message);

  const std::filesystem::path& urdf_;
  const RobotImportOptions& options_;
  SourceRobot& robot_;
  MeshResolver resolver_;
  Affine up_from_urdf_;
  std::map<std::string, MeshResolution> resolutions_;
  std::map<std::filesystem::path, LoadedMesh> loaded_;
};

}  // namespace galactic::bake
