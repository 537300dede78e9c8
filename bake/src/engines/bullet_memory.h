#pragma once
// For the files that name Bullet alone.
#include <LinearMath/btAlignedAllocator.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace galactic::bake {

/// Where memory runs out, Bullet throws std::bad_alloc, as all else does: by itself it does not
/// look at what it gets, and writes to null. Set before main(), as any thread may call Bullet. What
/// was allocated before can be freed: all of it comes from malloc.
inline const bool bullet_throws = [] {
  const auto allocate = [](std::size_t bytes) -> void* {
    if (void* memory = std::malloc(bytes)) return memory;
    throw std::bad_alloc();
  };
  btAlignedAllocSetCustom(allocate, std::free);
  return true;
}();

}  // namespace galactic::bake
