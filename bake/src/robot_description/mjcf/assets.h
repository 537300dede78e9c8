#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>

#include "robot_description/description.h"
#include "robot_description/mjcf/attributes.h"

namespace galactic::bake {

/// A <mesh>: a file or points, and how they lie in the mesh's own frame.
struct MjcfMesh {
  /// Of kMesh; the frame is that of the mesh.
  DescribedShape shape;
};

/// What a <material> says of looks.
struct MjcfMaterial {
  /// sRGB and alpha.
  std::array<double, 4> color{1, 1, 1, 1};
  /// The reference to its image; empty: none.
  std::string texture;
};

/// What shapes may name.
class MjcfAssets {
 public:
  /// Reads every <asset> of `root`. Meshes that stand in the text are added to `robot`.
  MjcfAssets(const XmlElement& root, const MjcfDefaults& defaults, const MjcfSettings& settings,
             MjcfFindings& findings, RobotDescription& robot);

  /// Of a shape that names a mesh; an error, and none, where there is no such mesh.
  [[nodiscard]] const MjcfMesh* meshOf(const MjcfAttributes& geom) const;
  /// The color of a shape that states one or names a material that does, and its texture.
  void paint(const MjcfAttributes& geom, DescribedShape& shape) const;

 private:
  void readMesh(const MjcfAttributes& mesh, RobotDescription& robot);
  void readTexture(const MjcfAttributes& texture);
  void readMaterial(const MjcfAttributes& material);
  /// `scale`: that of the mesh, by which its points may be far away.
  void addPoints(const MjcfAttributes& mesh, const std::array<double, 3>& scale,
                 DescribedShape& shape, RobotDescription& robot) const;
  [[nodiscard]] std::string inFolder(const std::string& folder, const std::string& file) const;

  const MjcfSettings& settings_;
  MjcfFindings& findings_;
  std::map<std::string, MjcfMesh, std::less<>> meshes_;
  /// Files by the names of textures; empty: MuJoCo makes it.
  std::map<std::string, std::string, std::less<>> textures_;
  std::map<std::string, MjcfMaterial, std::less<>> materials_;
};

}  // namespace galactic::bake
