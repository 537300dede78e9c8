#include "render/gl/shader_sources.h"

#include <fmt/format.h>

namespace galactic::render::gl {
namespace {

constexpr const char* kVersion = "#version 450 core\n";

/// As GpuInstance, GpuBounds, GpuChunk, ChunkResult, DrawCommand and DrawTotals in C++.
constexpr const char* kStructures = R"(
struct Instance {
  vec4 row_x; vec4 row_y; vec4 row_z;
  float scale_x; float scale_y; uint layer; uint unused;
};
struct Bounds {
  float centre_x; float centre_y; float centre_z; float half_x; float half_y; float half_z;
  float radius; float axis_x; float axis_y; float axis_z; float cutoff;
  uint first_index; uint index_count;
};
struct Chunk { uint instance; uint first_cluster; uint count; };
struct ChunkResult { uint seen; uint triangles; uint first_draw; };
struct Draw {
  uint count; uint instance_count; uint first_index; int base_vertex; uint base_instance;
};
struct Total { uint draws; uint clusters; uint triangles; uint unused; };
)";

constexpr const char* kVertexMain = R"(
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec2 a_texture_place;
layout(location = 2) in COLOR_TYPE a_color;
layout(location = 3) in uvec2 a_texture;
layout(location = 4) in float a_cutoff;
// Of the instance.
layout(location = 5) in vec4 a_row_x;
layout(location = 6) in vec4 a_row_y;
layout(location = 7) in vec4 a_row_z;
layout(location = 8) in vec2 a_scale;
layout(location = 9) in uint a_layer;
layout(location = 0) uniform float u_near;

// The same corner of two triangles must come out the same.
invariant gl_Position;

void main() {
  vec4 place = vec4(a_place, 1.0);
  vec3 seen = vec3(dot(a_row_x, place), dot(a_row_y, place), dot(a_row_z, place));
  // The camera looks along x, with y up and z to the right; depth is near / x.
  gl_Position = vec4(seen.z * a_scale.x, seen.y * a_scale.y, u_near, seen.x);
#ifdef LAYER_IN_VERTEX
  gl_Layer = int(a_layer);
#else
  to_layer = int(a_layer);
#endif
  to.texture_place = a_texture_place;
  to.color = a_color;
  to.slot = a_texture.x;
  to.semantic = a_texture.y;
  to.cutoff = a_cutoff;
}
)";

constexpr const char* kGeometryMain = R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    gl_Layer = to_layer[i];
    to.texture_place = from[i].texture_place;
    to.color = from[i].color;
    to.slot = from[i].slot;
    to.cutoff = from[i].cutoff;
    to.semantic = from[i].semantic;
    EmitVertex();
  }
  EndPrimitive();
}
)";

constexpr const char* kFragmentMain = R"(
#ifdef COLOR
layout(location = 0) out vec4 o_color;
#endif
#ifdef SEMANTICS
layout(location = SEMANTIC_TARGET) out uint o_semantic;
#endif

#if defined(COLOR) || defined(MASKED)
vec4 shade() {
#ifdef VERTEX_COLORS
  vec4 color = from.color;
#else
  vec4 color = unpackUnorm4x8(from.color);
#endif
#if TEXTURE_ARRAYS > 0
  vec2 along_x = dFdx(from.texture_place);
  vec2 along_y = dFdy(from.texture_place);
  if (from.slot != 0xFFFFFFFFu) {
    // The nearest of the levels, by the longer side of the pixel's footprint.
    float edge = float(1u << (from.slot >> 24));
    float footprint = max(dot(along_x, along_x), dot(along_y, along_y)) * edge * edge;
    float level = footprint > 0.0 ? max(floor(0.5 * log2(footprint) + 0.5), 0.0) : 0.0;
    color *= texel((from.slot >> 16) & 0xFFu,
                   vec3(from.texture_place, float(from.slot & 0xFFFFu)), level);
  }
#endif
  return color;
}
#endif

void main() {
#if defined(COLOR) || defined(MASKED)
  vec4 color = shade();
#ifdef MASKED
  if (color.a < from.cutoff) discard;
#endif
#ifdef COLOR
  o_color = vec4(color.rgb, 1.0);
#endif
#endif
#ifdef SEMANTICS
  o_semantic = from.semantic;
#endif
}
)";

constexpr const char* kTestMain = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) restrict readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 2) restrict readonly buffer BoundsOfClusters { Bounds bounds[]; };
layout(std430, binding = 3) restrict readonly buffer Chunks { Chunk chunks[]; };
layout(std430, binding = 4) restrict writeonly buffer Results { ChunkResult results[]; };
layout(location = 0) uniform float u_near;
layout(location = 1) uniform uint u_chunks;
layout(location = 2) uniform uint u_culling;

// The eye and the planes of what a camera sees, in the frame of a model: inside is where
// dot(plane.xyz, p) + plane.w >= 0.
struct Sight { vec3 eye; vec4 planes[5]; };

Sight sightOf(Instance instance) {
  Sight sight;
  vec4 x = instance.row_x;
  vec4 y = instance.row_y * instance.scale_y;
  vec4 z = instance.row_z * instance.scale_x;
  sight.planes[0] = vec4(x.xyz, x.w - u_near);
  sight.planes[1] = x - y;
  sight.planes[2] = x + y;
  sight.planes[3] = x - z;
  sight.planes[4] = x + z;
  vec3 origin = vec3(x.w, instance.row_y.w, instance.row_z.w);
  sight.eye = -(origin.x * x.xyz + origin.y * instance.row_y.xyz + origin.z * instance.row_z.xyz);
  return sight;
}

bool isSeen(Sight sight, Bounds box) {
  vec3 centre = vec3(box.centre_x, box.centre_y, box.centre_z);
  vec3 halves = vec3(box.half_x, box.half_y, box.half_z);
  for (int i = 0; i < 5; ++i) {
    vec4 plane = sight.planes[i];
    float reach = dot(abs(plane.xyz), halves);
    float from_plane = dot(plane.xyz, centre) + plane.w;
    // Room for rounding, here and where the corners are transformed.
    float slack = 1e-5 * (dot(abs(plane.xyz), abs(centre)) + abs(plane.w) + reach);
    if (from_plane + reach < -slack) return false;
  }
  vec3 way = centre - sight.eye;
  float far = length(way);
  vec3 axis = vec3(box.axis_x, box.axis_y, box.axis_z);
  return dot(way, axis) < box.cutoff * far + box.radius + 1e-5 * (far + length(sight.eye));
}

void main() {
  uint chunk = gl_GlobalInvocationID.x;
  if (chunk >= u_chunks) return;
  Chunk part = chunks[chunk];
  Sight sight = sightOf(instances[part.instance]);
  uint seen = 0u;
  uint indices = 0u;
  for (uint i = 0u; i < part.count; ++i) {
    Bounds box = bounds[part.first_cluster + i];
    if (u_culling == 0u || isSeen(sight, box)) {
      seen |= 1u << i;
      indices += box.index_count;
    }
  }
  results[chunk].seen = seen;
  results[chunk].triangles = indices / 3u;
}
)";

constexpr const char* kScanMain = R"(
layout(local_size_x = 256) in;
layout(std430, binding = 4) restrict buffer Results { ChunkResult results[]; };
layout(std430, binding = 5) restrict writeonly buffer Totals { Total totals[4]; };
layout(location = 0) uniform uint u_first_chunk[5];
layout(location = 5) uniform uint u_first_draw[4];

shared uint shared_draws[256];
shared uint shared_clusters[256];
shared uint shared_triangles[256];

// Neighbouring clusters that are seen make one draw.
uint drawsOf(uint seen) { return uint(bitCount(seen & ~(seen << 1))); }

// One work group for each class; each thread has a run of its chunks.
void main() {
  uint kind = gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationID.x;
  uint chunks = u_first_chunk[kind + 1u] - u_first_chunk[kind];
  uint run = (chunks + 255u) / 256u;
  uint begin = u_first_chunk[kind] + min(lane * run, chunks);
  uint end = u_first_chunk[kind] + min(lane * run + run, chunks);
  uint draws = 0u;
  uint clusters = 0u;
  uint triangles = 0u;
  for (uint i = begin; i < end; ++i) {
    draws += drawsOf(results[i].seen);
    clusters += uint(bitCount(results[i].seen));
    triangles += results[i].triangles;
  }
  shared_draws[lane] = draws;
  shared_clusters[lane] = clusters;
  shared_triangles[lane] = triangles;
  barrier();
  uint before = 0u;
  if (lane == 0u) {
    uint all_draws = 0u;
    uint all_clusters = 0u;
    uint all_triangles = 0u;
    for (uint i = 0u; i < 256u; ++i) {
      uint own = shared_draws[i];
      shared_draws[i] = all_draws;
      all_draws += own;
      all_clusters += shared_clusters[i];
      all_triangles += shared_triangles[i];
    }
    totals[kind] = Total(all_draws, all_clusters, all_triangles, 0u);
  }
  barrier();
  uint next = u_first_draw[kind] + shared_draws[lane];
  for (uint i = begin; i < end; ++i) {
    results[i].first_draw = next;
    next += drawsOf(results[i].seen);
  }
}
)";

constexpr const char* kEmitMain = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 2) restrict readonly buffer BoundsOfClusters { Bounds bounds[]; };
layout(std430, binding = 3) restrict readonly buffer Chunks { Chunk chunks[]; };
layout(std430, binding = 4) restrict readonly buffer Results { ChunkResult results[]; };
layout(std430, binding = 5) restrict writeonly buffer Draws { Draw draws[]; };
layout(location = 0) uniform uint u_chunks;

void main() {
  uint chunk = gl_GlobalInvocationID.x;
  if (chunk >= u_chunks) return;
  Chunk part = chunks[chunk];
  uint left = results[chunk].seen;
  uint draw = results[chunk].first_draw;
  while (left != 0u) {
    uint begin = uint(findLSB(left));
    uint gap = ~(left >> begin);
    uint length = gap == 0u ? 32u : uint(findLSB(gap));
    uint first = part.first_cluster + begin;
    uint last = first + length - 1u;
    uint first_index = bounds[first].first_index;
    uint count = bounds[last].first_index + bounds[last].index_count - first_index;
    draws[draw++] = Draw(count, 1u, first_index, 0, part.instance);
    left = begin + length >= 32u ? 0u : left & (0xFFFFFFFFu << (begin + length));
  }
}
)";

constexpr const char* kResolveMain = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) restrict writeonly buffer ColorOut { uint color_out[]; };
layout(std430, binding = 1) restrict writeonly buffer DepthOut { float depth_out[]; };
layout(std430, binding = 2) restrict writeonly buffer SemanticOut { uint semantic_out[]; };
layout(binding = 16) uniform sampler2DArray t_color;
layout(binding = 17) uniform sampler2DArray t_depth;
layout(binding = 18) uniform usampler2DArray t_semantic;
layout(location = 0) uniform float u_near;
layout(location = 1) uniform uint u_width;
layout(location = 2) uniform uint u_height;
layout(location = 3) uniform uint u_pixels;
layout(location = 4) uniform uint u_first_pixel;

ivec3 placeOf(uint pixel) {
  uint row = pixel / u_width;
  uint layer = row / u_height;
  return ivec3(pixel - row * u_width, row - layer * u_height, layer);
}

// Four pixels a thread: in three bytes each, they make three words.
void main() {
  uint begin = 4u * gl_GlobalInvocationID.x;
  if (begin >= u_pixels) return;
  uint words[4] = uint[4](0u, 0u, 0u, 0u);
  for (uint i = 0u; i < 4u && begin + i < u_pixels; ++i) {
    uint pixel = begin + i;
    ivec3 place = placeOf(pixel);
#ifdef COLOR
    words[i] = packUnorm4x8(texelFetch(t_color, place, 0));
#if COLOR_BYTES == 4
    color_out[u_first_pixel + pixel] = words[i];
#endif
#endif
#ifdef DEPTH
    float stored = texelFetch(t_depth, place, 0).r;
    depth_out[u_first_pixel + pixel] = stored > 0.0 ? u_near / stored : 0.0;
#endif
#ifdef SEMANTICS
    semantic_out[u_first_pixel + pixel] = texelFetch(t_semantic, place, 0).r;
#endif
  }
#if COLOR_BYTES == 3
  uint word = (u_first_pixel + begin) / 4u * 3u;
  color_out[word] = (words[0] & 0xFFFFFFu) | words[1] << 24;
  color_out[word + 1u] = ((words[1] >> 8) & 0xFFFFu) | words[2] << 16;
  color_out[word + 2u] = ((words[2] >> 16) & 0xFFu) | words[3] << 8;
#endif
}
)";

/// What the stages hand on. Without colours of vertices, a colour is the same all over a triangle.
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

/// A function that reads one of the arrays: which one must not vary between neighbouring threads,
/// so it is a switch and not an index.
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
  return text + "out Corner " + corner(variant) + " to;\n" + kVertexMain;
}

std::string geometrySource(const ShaderVariant& variant) {
  return kVersion + ("in Corner " + corner(variant) + " from[];\n") + "out Corner " +
         corner(variant) + " to;\nin int to_layer[];\n" + kGeometryMain;
}

std::string fragmentSource(const ShaderVariant& variant, bool masked) {
  std::string text = kVersion + definitions(variant);
  if (masked) text += "#define MASKED\n";
  return text + "in Corner " + corner(variant) + " from;\n" +
         texelFunction(variant.texture_arrays) + kFragmentMain;
}

std::string testSource() { return std::string(kVersion) + kStructures + kTestMain; }
std::string scanSource() { return std::string(kVersion) + kStructures + kScanMain; }
std::string emitSource() { return std::string(kVersion) + kStructures + kEmitMain; }
std::string resolveSource(const ShaderVariant& variant) {
  return kVersion + definitions(variant) + kResolveMain;
}

}  // namespace galactic::render::gl
