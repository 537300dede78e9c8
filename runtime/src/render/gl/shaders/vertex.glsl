// Takes one corner of a triangle from the frame of its model to the target.
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec2 a_texture_place;
layout(location = 2) in COLOR_TYPE a_color;
layout(location = 3) in uvec2 a_texture;
layout(location = 4) in float a_cutoff;
// Attributes of the instance.
layout(location = 5) in vec4 a_row_x;
layout(location = 6) in vec4 a_row_y;
layout(location = 7) in vec4 a_row_z;
layout(location = 8) in vec2 a_scale;
layout(location = 9) in uint a_layer;
layout(location = 10) in uint a_semantic;
layout(location = 0) uniform float u_near;

// A corner that two triangles share must be the same in both.
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
  to.semantic = a_semantic == 0xFFFFFFFFu ? a_texture.y : a_semantic;
  to.cutoff = a_cutoff;
}
