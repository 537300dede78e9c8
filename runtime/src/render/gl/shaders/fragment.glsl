// Colors one pixel of a triangle.
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
    // The nearest level for the longer side of the pixel's footprint.
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
