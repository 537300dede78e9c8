// The second pass of culling: decides where the commands of each chunk go.
layout(local_size_x = 256) in;
layout(std430, binding = 4) restrict buffer Results { ChunkResult results[]; };
layout(std430, binding = 5) restrict writeonly buffer Totals { Total totals[4]; };
layout(location = 0) uniform uint u_first_chunk[5];
layout(location = 5) uniform uint u_first_draw[4];

shared uint shared_draws[256];
shared uint shared_clusters[256];
shared uint shared_triangles[256];

// Neighboring clusters that are seen are drawn with one command.
uint drawsOf(uint seen) { return uint(bitCount(seen & ~(seen << 1))); }

// One work group for each class; each thread handles a run of the class's chunks.
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
