#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::pack_tool {

/// How the corners of a mesh are joined; the values are those of glTF.
enum class GlbShape { kLines = 1, kTriangles = 4 };

/// A mesh for a GLB file: views, copied when it is added.
struct GlbMesh {
  std::string_view name;
  /// At least one.
  std::span<const Vec3> positions;
  /// Unit vectors, one per position; or none for flat faces.
  std::span<const Vec3> normals = {};
  /// RGBA, sRGB, 8 bits each, R lowest: one per position, or none.
  std::span<const std::uint32_t> colors = {};
  /// Indices of positions, two per line or three per triangle; at least one of them.
  std::span<const std::uint32_t> corners;
  GlbShape shape = GlbShape::kTriangles;
  std::size_t material = 0;
};

struct GlbMaterial {
  std::string_view name;
  /// Linear; alpha below 1 makes it translucent.
  std::array<float, 4> color{1, 1, 1, 1};
};

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

/// Collects meshes and nodes, and writes them as glTF 2.0 in binary (GLB): metres, Y up. The same
/// content gives the same bytes. See the glTF 2.0 specification, sections 3 and 4.
class GlbFile {
 public:
  // Each returns an index for the ones added later.
  std::size_t addMaterial(const GlbMaterial& material);
  std::size_t addMesh(const GlbMesh& mesh);
  std::size_t addNode(const GlbNode& node);

  /// The file's bytes. Fails with kUnsupported, an empty `where`, beyond the 4 GiB of a GLB file.
  [[nodiscard]] Result<std::string> bytes() const;

 private:
  using Json = nlohmann::ordered_json;

  /// Appends data as a buffer view of its own; returns its index.
  std::size_t addView(std::span<const std::byte> data, int target);
  std::size_t addVectors(std::span<const Vec3> vectors);
  std::size_t addColors(std::span<const std::uint32_t> colors);
  std::size_t addIndices(std::span<const std::uint32_t> indices);
  std::size_t addAccessor(Json accessor);

  Json materials_ = Json::array();
  Json views_ = Json::array();
  Json accessors_ = Json::array();
  Json meshes_ = Json::array();
  Json cameras_ = Json::array();
  Json nodes_ = Json::array();
  std::vector<std::size_t> roots_;
  std::string binary_;
};

}  // namespace galactic::pack_tool
