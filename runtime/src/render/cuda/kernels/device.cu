// The kernels for a device. clang compiles this file to PTX without a CUDA toolkit, nvcc with one.
#include "render/cuda/kernels/kernels.inl"

#define GALACTIC_KERNEL                                            \
  extern "C" __attribute__((global)) __attribute__((launch_bounds( \
      galactic::render::cuda::kBlockThreads, galactic::render::cuda::kBlocksAtOnce)))
// Bytes instead of a variable of the type, since constructors do not run in shared memory.
#define GALACTIC_SHARED(Type, name)                                        \
  __attribute__((shared)) static unsigned char name##_memory[sizeof(Type)] \
      __attribute__((aligned(64)));                                        \
  auto& name = *reinterpret_cast<Type*>(name##_memory)

namespace galactic::render::cuda {

__attribute__((device)) inline Block thisBlock() { return {blockNumber(), blockCount()}; }

GALACTIC_KERNEL void galactic_place(PassParameters parameters) {
  placeInstances(thisBlock(), parameters.slice);
}

GALACTIC_KERNEL void galactic_cull(PassParameters parameters) {
  GALACTIC_SHARED(CullShared, shared);
  cullPane(thisBlock(), shared, parameters.slice);
}

GALACTIC_KERNEL void galactic_draw(PassParameters parameters) {
  GALACTIC_SHARED(DrawShared, shared);
  drawClusters(thisBlock(), shared, parameters.slice, parameters.pass);
}

GALACTIC_KERNEL void galactic_tiles(PassParameters parameters) {
  measureTiles(thisBlock(), parameters.slice);
}

GALACTIC_KERNEL void galactic_resolve(PassParameters parameters) {
  GALACTIC_SHARED(ResolveShared, shared);
  const Block block = thisBlock();
  resolvePane(block, shared, parameters.slice,
              block.count / (parameters.slice.view_count * parameters.slice.panes_of_view));
}

}  // namespace galactic::render::cuda
