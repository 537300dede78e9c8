// All kernels. Included once for the device and once for the processor; each file builds on those
// before it.
// clang-format off
#include "render/cuda/kernels/view_slice.h"
#include "render/raster/lanes_one.inl"
#include "render/raster/cull.inl"
#include "render/raster/vertices.inl"
#include "render/raster/triangles.inl"
#include "render/raster/sample.inl"
#include "render/raster/records.inl"
#include "render/raster/large.inl"
#include "render/raster/clip.inl"
#include "render/cuda/kernels/block.inl"
#include "render/cuda/kernels/cull.inl"
#include "render/cuda/kernels/cover.inl"
#include "render/cuda/kernels/draw.inl"
#include "render/cuda/kernels/resolve.inl"
// clang-format on
