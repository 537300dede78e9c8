#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/resting_box.h"
#include "simulation/window_frame.h"

namespace galactic::simulation {

/// The resting objects of one env as bare pointers: the code built for AVX2 must not instantiate
/// library templates, which the linker could then share with code for any processor.
struct RestingView {
  WindowFrame frame;
  /// Of plane 0; plane p begins p * plane_stride words later and holds objects [32 p, 32 p + 32).
  const std::uint32_t* words = nullptr;
  std::size_t plane_stride = 0;
  std::size_t planes = 0;
  const RestingBox* boxes = nullptr;
};

/// Spheres of one radius: whole groups of eight, of which copies of the last sphere fill the last.
struct SphereGroups {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t groups = 0;
  float radius = 0;
};

/// The first group from `first` on with a sphere that overlaps an object, `spheres.groups` if none
/// has; `lanes` gets a bit for each of its eight spheres that does.
std::size_t firstTouchingGroupPortable(const RestingView& objects, const SphereGroups& spheres,
                                       std::size_t first, unsigned& lanes) noexcept;

/// The same, eight spheres at a time. Call it only where detail::hasAvx2(). Bit for bit the answers
/// of the portable one: both do the same operations in the same order, and none is contracted.
std::size_t firstTouchingGroupAvx2(const RestingView& objects, const SphereGroups& spheres,
                                   std::size_t first, unsigned& lanes) noexcept;

}  // namespace galactic::simulation
