// The same as GpuInstance, GpuBounds, GpuChunk, ChunkResult, DrawCommand and DrawTotals in C++.
struct Instance {
  vec4 row_x; vec4 row_y; vec4 row_z;
  float scale_x; float scale_y; uint layer; uint semantic;
};
struct Bounds {
  float center_x; float center_y; float center_z; float half_x; float half_y; float half_z;
  float radius; float axis_x; float axis_y; float axis_z; float cutoff;
  uint first_index; uint index_count;
};
struct Chunk { uint instance; uint first_cluster; uint count; };
struct ChunkResult { uint seen; uint triangles; uint first_draw; };
struct Draw {
  uint count; uint instance_count; uint first_index; int base_vertex; uint base_instance;
};
struct Total { uint draws; uint clusters; uint triangles; uint unused; };
