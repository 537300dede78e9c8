// Copies the targets to images in the layout of the caller.
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

// Each thread writes four pixels: with three bytes each, they make three words.
void main() {
  uint begin = 4u * threadNumber();
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
