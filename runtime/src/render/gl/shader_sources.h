#pragma once
#include <cstddef>
#include <string>

namespace galactic::render::gl {

/// Threads of a work group of the culling and resolving shaders.
inline constexpr unsigned kGroupSize = 64;
/// Most clusters of a chunk: what one thread culls.
inline constexpr unsigned kChunkClusters = 32;

/// What the shaders of a renderer are made for.
struct ShaderVariant {
  /// Whether the vertex shader chooses the layer; else a geometry shader does.
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

/// GLSL of the stages that draw. `masked`: for materials with holes.
[[nodiscard]] std::string vertexSource(const ShaderVariant& variant);
[[nodiscard]] std::string geometrySource(const ShaderVariant& variant);
[[nodiscard]] std::string fragmentSource(const ShaderVariant& variant, bool masked);

/// GLSL of the compute shaders. Culling has three passes: which clusters of each chunk are seen,
/// where the commands of each chunk go, and the commands.
[[nodiscard]] std::string testSource();
[[nodiscard]] std::string scanSource();
[[nodiscard]] std::string emitSource();
/// From the targets to images in the layout of the caller.
[[nodiscard]] std::string resolveSource(const ShaderVariant& variant);

}  // namespace galactic::render::gl
