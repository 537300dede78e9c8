// The third pass of culling: writes the commands of a chunk.
layout(std430, binding = 2) restrict readonly buffer BoundsOfClusters { Bounds bounds[]; };
layout(std430, binding = 3) restrict readonly buffer Chunks { Chunk chunks[]; };
layout(std430, binding = 4) restrict readonly buffer Results { ChunkResult results[]; };
layout(std430, binding = 5) restrict writeonly buffer Draws { Draw draws[]; };
layout(location = 0) uniform uint u_chunks;

void main() {
  uint chunk = threadNumber();
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
