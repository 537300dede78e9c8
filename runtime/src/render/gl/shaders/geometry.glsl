// Chooses the layer if the vertex shader cannot.
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
