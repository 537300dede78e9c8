#include "render/gl/shader_sources.h"

#include <fmt/format.h>

#include "render/gl/shader_texts.h"

namespace galactic::render::gl {
namespace {

constexpr const char* kVersion = "#version 450 core\n";

/// The values that each stage passes to the next. If vertices have no colors, a triangle has the
/// same color everywhere.
std::string corner(const ShaderVariant& variant) {
  return fmt::format(
      "{{ vec2 texture_place; {} color; flat uint slot; flat float cutoff; flat uint semantic; }}",
      variant.vertex_colors ? "vec4" : "flat uint");
}

std::string definitions(const ShaderVariant& variant) {
  std::string text;
  if (variant.vertex_colors) text += "#define VERTEX_COLORS\n";
  if (variant.color) text += "#define COLOR\n";
  if (variant.depth) text += "#define DEPTH\n";
  if (variant.semantics) text += "#define SEMANTICS\n";
  text += fmt::format("#define SEMANTIC_TARGET {}\n#define TEXTURE_ARRAYS {}\n",
                      variant.color ? 1 : 0, variant.texture_arrays);
  return text + fmt::format("#define COLOR_BYTES {}\n", variant.color ? variant.color_bytes : 0);
}

/// A function that reads one of the arrays. It uses a switch, because an index into the arrays must
/// not vary between neighboring threads.
std::string texelFunction(std::size_t arrays) {
  if (arrays == 0) return {};
  std::string text =
      fmt::format("layout(binding = 0) uniform sampler2DArray t_arrays[{}];\n", arrays);
  text += "vec4 texel(uint array, vec3 place, float level) {\n  switch (array) {\n";
  for (std::size_t i = 0; i < arrays; ++i) {
    text += fmt::format("    case {}u: return textureLod(t_arrays[{}], place, level);\n", i, i);
  }
  return text + "  }\n  return vec4(0.0);\n}\n";
}

}  // namespace

std::string vertexSource(const ShaderVariant& variant) {
  std::string text = kVersion;
  if (variant.layer_in_vertex) {
    text += "#extension GL_ARB_shader_viewport_layer_array : require\n#define LAYER_IN_VERTEX\n";
  } else {
    text += "out int to_layer;\n";
  }
  text += fmt::format("#define COLOR_TYPE {}\n", variant.vertex_colors ? "vec4" : "uint");
  return text + "out Corner " + corner(variant) + " to;\n" + kShaderVertex;
}

std::string geometrySource(const ShaderVariant& variant) {
  return kVersion + ("in Corner " + corner(variant) + " from[];\n") + "out Corner " +
         corner(variant) + " to;\nin int to_layer[];\n" + kShaderGeometry;
}

std::string fragmentSource(const ShaderVariant& variant, bool masked) {
  std::string text = kVersion + definitions(variant);
  if (masked) text += "#define MASKED\n";
  return text + "in Corner " + corner(variant) + " from;\n" +
         texelFunction(variant.texture_arrays) + kShaderFragment;
}

std::string testSource() {
  return std::string(kVersion) + kShaderStructures + kShaderThreads + kShaderCullTest;
}
std::string scanSource() { return std::string(kVersion) + kShaderStructures + kShaderCullScan; }
std::string emitSource() {
  return std::string(kVersion) + kShaderStructures + kShaderThreads + kShaderCullEmit;
}
std::string resolveSource(const ShaderVariant& variant) {
  return kVersion + definitions(variant) + kShaderThreads + kShaderResolve;
}

}  // namespace galactic::render::gl
