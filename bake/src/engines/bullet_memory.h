#pragma once
// Only for the files that name Bullet.
#include <LinearMath/btAlignedAllocator.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace galactic::bake {

/// Makes Bullet throw std::bad_alloc when memory runs out, as all other code does: by default it
/// does not check what its allocator returns, and writes to null. Set before main(), because any
/// thread may call Bullet. Memory allocated earlier can still be freed, as all of it comes from
/// malloc.
inline const bool bullet_throws = [] {
  const auto allocate = [](std::size_t bytes) -> void* {
    if (void* memory = std::malloc(bytes)) return memory;
    throw std::bad_alloc();
  };
  btAlignedAllocSetCustom(allocate, std::free);
  return true;
}();

}  // namespace galactic::bake
