#pragma once
#include <cstddef>
#include <functional>

namespace galactic::bake {

/// Calls `body` once for each index below `count`, on up to `threads` threads (including the
/// caller's), in no particular order. Returns when all calls have returned. If a call throws, the
/// rest are skipped and the exception is passed to the caller.
void parallelFor(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace galactic::bake
