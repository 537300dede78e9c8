// A block of threads, the way kernels are written here: work between two barriers is a function of
// the thread's number. On a device each thread calls it for itself and waits for the others; on the
// processor it is a loop.
namespace galactic::render::cuda {
namespace {

#if defined(__CUDA__)

struct Block {
  std::uint32_t index, count;
  static constexpr std::uint32_t threads = kBlockThreads;

  template <class Body>
  void each(const Body& body) const {
    body(static_cast<std::uint32_t>(__nvvm_read_ptx_sreg_tid_x()));
    __syncthreads();
  }
};

#else

struct Block {
  std::uint32_t index, count;
  std::uint32_t threads;
  /// Threads run in the order of (n * stride + first) % threads: no image depends on it.
  std::uint32_t stride, first;

  template <class Body>
  void each(const Body& body) const {
    for (std::uint32_t n = 0; n < threads; ++n) body((n * stride + first) % threads);
  }
};

#endif

/// Returns what was there before.
template <class Number>
inline Number addAtomically(Number* to, Number more) {
  return __atomic_fetch_add(to, more, __ATOMIC_RELAXED);
}

inline void raiseAtomically(std::uint64_t* to, std::uint64_t value) {
  // What is read here may be old, but never too high.
  std::uint64_t old = __atomic_load_n(to, __ATOMIC_RELAXED);
#if defined(__CUDA__)
  if (old < value) __atomic_fetch_max(to, value, __ATOMIC_RELAXED);
#else
  while (old < value &&
         !__atomic_compare_exchange_n(to, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
#endif
}

}  // namespace
}  // namespace galactic::render::cuda
