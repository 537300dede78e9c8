#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/read_files.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// Corner indices of one triangle, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A row-major affine transform: three rows of (linear part | translation); meters.
using Affine = std::array<double, 12>;

/// What a material's alpha means (glTF's alphaMode).
enum class AlphaMode : std::uint8_t {
  kOpaque,  ///< Alpha is ignored.
  kMask,    ///< Texels with less alpha than a cutoff are not drawn; the rest are opaque.
  kBlend,   ///< Translucency.
};

/// A surface appearance as the source file states it, for the render bake.
struct SourceMaterial {
  std::string name;
  /// Linear RGBA, 0 to 1.
  std::array<float, 4> base_color{1, 1, 1, 1};
  /// Path relative to the source file, "*N" for embedded texture N, or empty.
  std::string base_color_texture;
  /// Whether both sides are visible: also true if the format cannot tell.
  bool two_sided = false;
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  /// The cutoff of kMask.
  float alpha_cutoff = 0.5F;
};

/// An image stored inside the source file, still encoded.
struct EmbeddedTexture {
  /// "png", "jpg" and so on.
  std::string format;
  std::vector<std::uint8_t> bytes;
};

/// One mesh in its own frame.
struct SourceMesh {
  std::string name;
  /// All of them are used by triangles: the readers leave others out.
  std::vector<Vec3> positions;
  /// Texture coordinates, one per position or none; (0, 0) is the image's lower left corner.
  std::vector<std::array<float, 2>> uvs;
  /// Linear RGBA, one per position or none.
  std::vector<std::array<float, 4>> colors;
  std::vector<Triangle> triangles;
  /// Index into SourceAsset::materials.
  std::uint32_t material = 0;
};

/// One placement of a mesh.
struct SourceInstance {
  /// Name of the node that places it.
  std::string name;
  std::uint32_t mesh = 0;
  Affine world_from_mesh{};
};

/// What an importer passes to the bakers: independent of the format, in the world frame (Y up,
/// meters).
struct SourceAsset {
  /// Main input's file name without its extension.
  std::string name;
  /// Format as recognized, for example "glTF 2.0". Packs need a name here.
  std::string format = "memory";
  /// How axes and unit were interpreted, for the closing table: for example "Z up (file), unit 0.01
  /// m".
  std::string convention;
  /// The unit in which the file was read.
  double meters_per_unit = 1;
  /// Whether the file or the user states that unit; otherwise it is the format's usual unit.
  bool unit_is_stated = false;
  std::vector<SourceMesh> meshes;
  std::vector<SourceInstance> instances;
  std::vector<SourceMaterial> materials;
  std::vector<EmbeddedTexture> textures;
  /// Names are relative to the folder of the main input.
  ReadFiles read;
  /// Material files that are named but missing, relative to the folder of the main input.
  std::vector<std::string> missing_materials;
  /// One sentence for each texture and material file that is named but missing, saying what is
  /// drawn instead. They are also among the warnings.
  std::vector<std::string> missing;
  /// One sentence each: missing textures, a doubtful unit and so on.
  std::vector<std::string> warnings;
};

/// Where a pack comes from. It is stored in the pack, so nothing in it may depend on the machine,
/// the time or the number of threads.
struct Provenance {
  std::string tool = "galactic-bake";
  std::string tool_version;
  /// Long option names and values that decide the content, in a fixed order.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<SourceFile> sources;
  std::vector<std::string> warnings;
};

}  // namespace galactic::bake
