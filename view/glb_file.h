#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/pose.h"
#include "view/json_writer.h"

namespace galactic {

/// How the corners of a mesh are joined; the values are those of glTF.
enum class GlbShape { kLines = 1, kTriangles = 4 };

/// Triangles or lines of one material for a GLB file: views, copied when they are added.
struct GlbPrimitive {
  /// At least one.
  std::span<const Vec3> positions;
  /// Unit vectors, one per position; or none for flat faces.
  std::span<const Vec3> normals = {};
  /// Texture coordinates, u to the right and v down from the image's top: one per position, or
  /// none.
  std::span<const std::array<float, 2>> uvs = {};
  /// RGBA, sRGB, 8 bits each, R lowest: one per position, or none.
  std::span<const std::uint32_t> colors = {};
  /// Indices of positions, two per line or three per triangle; at least one of them.
  std::span<const std::uint32_t> corners;
  GlbShape shape = GlbShape::kTriangles;
  std::size_t material = 0;
};

struct GlbMaterial {
  std::string_view name;
  /// Linear; alpha below 1 makes it translucent, unless there is a cut-off.
  std::array<float, 4> color{1, 1, 1, 1};
  /// From addTexture().
  std::optional<std::size_t> texture = std::nullopt;
  /// Over 0: what has less alpha than this is not there.
  float alpha_cutoff = 0;
  /// Scans have holes: what is seen through them is not nothing.
  bool two_sided = true;
  /// Shown as it is, whatever the light (KHR_materials_unlit).
  bool unlit = false;
};

/// An sRGB color of 8 bits each, R lowest, as glTF has it: linear but for alpha.
[[nodiscard]] std::array<float, 4> linearColor(std::uint32_t color);

/// A named place in the scene.
struct GlbNode {
  std::string name;
  Pose parent_from_node = {};
  Vec3 scale{1, 1, 1};
  std::optional<std::size_t> mesh = std::nullopt;
  /// Vertical field of view of a camera that looks along -Z with +Y up, radians.
  std::optional<float> camera_fov = std::nullopt;
  /// An earlier node.
  std::optional<std::size_t> parent = std::nullopt;
};

/// Where a node is in time: one key for each of the times.
struct GlbMotion {
  std::size_t node = 0;
  std::vector<Pose> parent_from_node;
};

/// Collects meshes and nodes, and writes them as glTF 2.0 in binary (GLB): meters, Y up. The same
/// content gives the same bytes. See the glTF 2.0 specification, sections 3 and 4.
class GlbFile {
 public:
  // Each returns an index for the ones added later.
  /// An image as the bytes of a PNG file; repeats, and is read from its nearest mip level.
  std::size_t addTexture(std::string_view name, const std::string& png);
  std::size_t addMaterial(const GlbMaterial& material);
  std::size_t addMesh(std::string_view name, std::span<const GlbPrimitive> primitives);
  std::size_t addNode(const GlbNode& node);
  /// Moves nodes evenly between the keys. `times`: ascending seconds, at least one; each motion has
  /// as many keys.
  void addAnimation(std::string_view name, std::span<const float> times,
                    std::span<const GlbMotion> motions);

  /// The file's bytes. Fails with kUnsupported, an empty `where`, beyond the 4 GiB of a GLB file.
  [[nodiscard]] Result<std::string> bytes() const;

 private:
  struct Node {
    GlbNode node;
    std::optional<std::size_t> camera;
    std::vector<std::size_t> children;
  };

  /// Appends data as a buffer view of its own; returns its index. `target`: what vertices and
  /// indices are bound to.
  std::size_t addView(std::span<const std::byte> data, std::optional<int> target);
  std::size_t addUvs(std::span<const std::array<float, 2>> uvs);
  void writePrimitive(JsonWriter& json, const GlbPrimitive& primitive);
  static void writeNode(JsonWriter& json, const Node& node);
  std::size_t addVectors(std::span<const Vec3> vectors);
  std::size_t addColors(std::span<const std::uint32_t> colors);
  std::size_t addKeys(std::span<const std::byte> keys, std::size_t count, std::string_view type);
  std::size_t addIndices(std::span<const std::uint32_t> indices);
  /// `accessor`: a JSON object that was begun.
  std::size_t addAccessor(JsonWriter accessor);

  // The lists of the file: each element as JSON.
  std::vector<std::string> images_;
  std::vector<std::string> textures_;
  std::vector<std::string> materials_;
  bool has_unlit_ = false;
  std::vector<std::string> views_;
  std::vector<std::string> accessors_;
  std::vector<std::string> meshes_;
  std::vector<std::string> cameras_;
  std::vector<std::string> animations_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> roots_;
  std::string binary_;
};

}  // namespace galactic
