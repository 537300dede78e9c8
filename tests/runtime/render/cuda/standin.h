#pragma once
#include <cstdint>

namespace galactic::test {

/// How the stand-in for CUDA's driver behaves, and what it saw: one for the process, which the
/// library gives out as galactic_standin(). Read and written between calls.
struct Standin {
  /// Of a block: a multiple of 8. Threads run in the order (n * stride + first) % threads.
  std::uint32_t threads = 128;
  std::uint32_t stride = 1;
  std::uint32_t first = 0;
  /// Blocks run from the last to the first.
  bool backwards = false;
  /// Before CUDA_VISIBLE_DEVICES hides any.
  int devices = 2;
  int major = 9;
  int minor = 0;
  /// What each function that can fail returns, by its name; null: none fails.
  const char* failing = nullptr;
  int error = 2;
  /// Whether one bit of the last image is turned around when images are read.
  bool spoils = false;

  /// Launches by kernel, since the last reset.
  std::uint64_t launches[5] = {};
  /// Copies, launches and waits, since the last reset: those on `stream`, and others.
  std::uintptr_t stream = 0;
  std::uint64_t on_stream = 0;
  std::uint64_t on_others = 0;
  /// Copies and launches that nothing has waited for.
  std::uint64_t under_way = 0;
  std::uint64_t allocations = 0;
  std::uint64_t allocated_bytes = 0;
  int contexts = 0;
  /// Of all threads, and not popped yet.
  int pushed_contexts = 0;
  int modules = 0;
  /// Buffers of OpenGL that CUDA knows, and those that are mapped.
  int shared_buffers = 0;
  int mapped_buffers = 0;
};

}  // namespace galactic::test
