// The first pass of culling: finds the clusters of a chunk that are seen. Each thread handles a
// chunk.
layout(std430, binding = 0) restrict readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 2) restrict readonly buffer BoundsOfClusters { Bounds bounds[]; };
layout(std430, binding = 3) restrict readonly buffer Chunks { Chunk chunks[]; };
layout(std430, binding = 4) restrict writeonly buffer Results { ChunkResult results[]; };
layout(location = 0) uniform float u_near;
layout(location = 1) uniform uint u_chunks;
layout(location = 2) uniform uint u_culling;

// The eye and the planes around what a camera sees, in the frame of a model. A point p is inside
// where dot(plane.xyz, p) + plane.w >= 0.
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
  vec3 center = vec3(box.center_x, box.center_y, box.center_z);
  vec3 halves = vec3(box.half_x, box.half_y, box.half_z);
  for (int i = 0; i < 5; ++i) {
    vec4 plane = sight.planes[i];
    float reach = dot(abs(plane.xyz), halves);
    float from_plane = dot(plane.xyz, center) + plane.w;
    // Room for rounding errors, here and in the transformation of the corners.
    float slack = 1e-5 * (dot(abs(plane.xyz), abs(center)) + abs(plane.w) + reach);
    if (from_plane + reach < -slack) return false;
  }
  vec3 way = center - sight.eye;
  float far = length(way);
  vec3 axis = vec3(box.axis_x, box.axis_y, box.axis_z);
  return dot(way, axis) < box.cutoff * far + box.radius + 1e-5 * (far + length(sight.eye));
}

void main() {
  uint chunk = threadNumber();
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
