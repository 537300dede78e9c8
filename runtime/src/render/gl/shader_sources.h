#pragma once
#include <cstddef>
#include <string>

namespace galactic::render::gl {

/// Threads of a work group of the culling and resolving shaders.
inline constexpr unsigned kGroupSize = 64;
/// Most clusters of a chunk, which is what one thread culls.
inline constexpr unsigned kChunkClusters = 32;

/// What the shaders of a renderer depend on.
struct ShaderVariant {
  /// Whether the vertex shader chooses the layer; otherwise a geometry shader does.
  bool layer_in_vertex = true;
  /// Whether vertices have colors of their own.
  bool vertex_colors = false;
  bool color = true;
  /// Bytes per pixel of color: 3 or 4.
  unsigned color_bytes = 4;
  bool depth = true;
  bool semantics = false;
  /// Arrays of textures.
  std::size_t texture_arrays = 0;
};

/// GLSL sources of the stages that draw. `masked`: for materials with holes.
[[nodiscard]] std::string vertexSource(const ShaderVariant& variant);
[[nodiscard]] std::string geometrySource(const ShaderVariant& variant);
[[nodiscard]] std::string fragmentSource(const ShaderVariant& variant, bool masked);

/// GLSL sources of the compute shaders. Culling has three passes: the first finds the clusters of
/// each chunk that are seen, the second decides where the commands of each chunk go, and the third
/// writes the commands.
[[nodiscard]] std::string testSource();
[[nodiscard]] std::string scanSource();
[[nodiscard]] std::string emitSource();
/// Copies the targets to images in the layout of the caller.
[[nodiscard]] std::string resolveSource(const ShaderVariant& variant);

}  // namespace galactic::render::gl
