#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>

#include "robot_description/description.h"
#include "robot_description/mjcf/attributes.h"

namespace galactic::bake {

/// A <mesh>: a file or points, and their pose in the mesh's own frame.
struct MjcfMesh {
  /// A kMesh shape, in the frame of the mesh.
  DescribedShape shape;
};

/// The looks that a <material> states.
struct MjcfMaterial {
  /// sRGB and alpha.
  std::array<double, 4> color{1, 1, 1, 1};
  /// The reference to its image; empty if it has none.
  std::string texture;
};

/// The assets that shapes may name.
class MjcfAssets {
 public:
  /// Reads every <asset> of `root`. Adds meshes that are in the text itself to `robot`.
  MjcfAssets(const XmlElement& root, const MjcfDefaults& defaults, const MjcfSettings& settings,
             MjcfFindings& findings, RobotDescription& robot);

  /// The mesh that a shape names. If there is no such mesh, reports an error and returns null.
  [[nodiscard]] const MjcfMesh* meshOf(const MjcfAttributes& geom) const;
  /// Sets the color that a shape or its material states, and the material's texture.
  void paint(const MjcfAttributes& geom, DescribedShape& shape) const;

 private:
  void readMesh(const MjcfAttributes& mesh, RobotDescription& robot);
  void readTexture(const MjcfAttributes& texture);
  void readMaterial(const MjcfAttributes& material);
  /// `scale` is that of the mesh; points may be far away because of it.
  void addPoints(const MjcfAttributes& mesh, const std::array<double, 3>& scale,
                 DescribedShape& shape, RobotDescription& robot) const;
  [[nodiscard]] std::string inFolder(const std::string& folder, const std::string& file) const;

  const MjcfSettings& settings_;
  MjcfFindings& findings_;
  std::map<std::string, MjcfMesh, std::less<>> meshes_;
  /// Image files by the names of textures; empty if MuJoCo generates the texture.
  std::map<std::string, std::string, std::less<>> textures_;
  std::map<std::string, MjcfMaterial, std::less<>> materials_;
};

}  // namespace galactic::bake
