// Compiled for AVX-512: instantiates no library templates, see column_grid_avx2.cpp.
#include "simulation/motion/motion_kernels.h"

#if defined(__AVX512F__)
// Each of these needs those before it.
#include "simulation/lanes/lanes_sixteen.inl"
#include "simulation/lanes/operations.inl"
#include "simulation/motion/motion_kernel.inl"
#include "simulation/motion/step_kernel.inl"

namespace galactic::simulation {
namespace {

// Batches of eight envs go to AVX2.

bool readSixteens(const ActionBatch& batch) noexcept {
  return batch.envs % kWidth == 0 ? readKernel(batch) : avx2Motion().read(batch);
}

void moveSixteens(const MotionTables& tables, const MoveBatch& batch) noexcept {
  batch.envs % kWidth == 0 ? moveKernel(tables, batch) : avx2Motion().move(tables, batch);
}

void placeSixteens(const MotionTables& tables, const BodyBatch& batch) noexcept {
  batch.envs % kWidth == 0 ? placeKernel(tables, batch) : avx2Motion().place(tables, batch);
}

void shiftFramesOfSixteens(const FrameShift& shift) noexcept {
  shift.envs % kWidth == 0 ? shiftFramesKernel(shift) : avx2Motion().shift_frames(shift);
}

void putFramesOfSixteens(const FrameBatch& batch) noexcept {
  batch.envs % kWidth == 0 ? putFramesKernel(batch) : avx2Motion().put_frames(batch);
}

void judgeSixteens(const JudgeBatch& batch) noexcept {
  batch.envs % kWidth == 0 ? judgeKernel(batch) : avx2Motion().judge(batch);
}

void observeSixteens(const ObserveBatch& batch) noexcept {
  batch.envs % kWidth == 0 ? observeKernel(batch) : avx2Motion().observe(batch);
}

}  // namespace

MotionKernels avx512Motion() noexcept {
  return {readSixteens,        moveSixteens,  placeSixteens,      shiftFramesOfSixteens,
          putFramesOfSixteens, judgeSixteens, avx2Motion().shift, observeSixteens};
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx512() is false on this architecture; the symbol exists so that callers need no condition.
MotionKernels avx512Motion() noexcept { return avx2Motion(); }

}  // namespace galactic::simulation

#endif
