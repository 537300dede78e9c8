// A block of threads. Kernels write the work between two barriers as a function of the thread's
// number. On a device each thread calls the function for itself and waits for the others; on the
// processor a loop calls it for all threads.
namespace galactic::render::cuda {
namespace {

#if defined(__CUDA__) || defined(__CUDACC__)

// Without a CUDA toolkit clang does not have the usual names of these, and nvcc has no other names.
#if defined(__CUDACC__)
__attribute__((device)) inline std::uint32_t threadNumber() { return threadIdx.x; }
__attribute__((device)) inline std::uint32_t blockNumber() { return blockIdx.x; }
__attribute__((device)) inline std::uint32_t blockCount() { return gridDim.x; }
#else
__attribute__((device)) inline std::uint32_t threadNumber() {
  return static_cast<std::uint32_t>(__nvvm_read_ptx_sreg_tid_x());
}
__attribute__((device)) inline std::uint32_t blockNumber() {
  return static_cast<std::uint32_t>(__nvvm_read_ptx_sreg_ctaid_x());
}
__attribute__((device)) inline std::uint32_t blockCount() {
  return static_cast<std::uint32_t>(__nvvm_read_ptx_sreg_nctaid_x());
}
#endif

struct Block {
  std::uint32_t index, count;
  static constexpr std::uint32_t threads = kBlockThreads;

  template <class Body>
  GALACTIC_EVERYWHERE void each(const Body& body) const {
    body(threadNumber());
    __syncthreads();
  }
};

#else

struct Block {
  std::uint32_t index, count;
  std::uint32_t threads;
  /// Threads run in the order (n * stride + first) % threads, which no image may depend on.
  std::uint32_t stride, first;

  template <class Body>
  GALACTIC_EVERYWHERE void each(const Body& body) const {
    for (std::uint32_t n = 0; n < threads; ++n) body((n * stride + first) % threads);
  }
};

#endif

// Atomic, but not ordered with accesses to other memory.
#if defined(__CUDACC__)

template <class Number>
GALACTIC_EVERYWHERE inline Number loadAtomically(const Number* from) {
  return *static_cast<const volatile Number*>(from);
}
template <class Number>
GALACTIC_EVERYWHERE inline void storeAtomically(Number* to, Number value) {
  *static_cast<volatile Number*>(to) = value;
}
/// Returns what was there before.
__attribute__((device)) inline std::uint32_t addAtomically(std::uint32_t* to, std::uint32_t more) {
  return atomicAdd(to, more);
}
__attribute__((device)) inline std::uint64_t addAtomically(std::uint64_t* to, std::uint64_t more) {
  return atomicAdd(reinterpret_cast<unsigned long long*>(to), more);
}
/// Replaces `empty` by `value`; returns what was there before.
__attribute__((device)) inline std::uint32_t claimAtomically(std::uint32_t* at, std::uint32_t empty,
                                                             std::uint32_t value) {
  return atomicCAS(at, empty, value);
}
__attribute__((device)) inline void greaterAtomically(std::uint64_t* to, std::uint64_t value) {
  atomicMax(reinterpret_cast<unsigned long long*>(to), value);
}

#else

template <class Number>
GALACTIC_EVERYWHERE inline Number loadAtomically(const Number* from) {
  return __atomic_load_n(from, __ATOMIC_RELAXED);
}
template <class Number>
GALACTIC_EVERYWHERE inline void storeAtomically(Number* to, Number value) {
  __atomic_store_n(to, value, __ATOMIC_RELAXED);
}
/// Returns what was there before.
template <class Number>
GALACTIC_EVERYWHERE inline Number addAtomically(Number* to, Number more) {
  return __atomic_fetch_add(to, more, __ATOMIC_RELAXED);
}
/// Replaces `empty` by `value`; returns what was there before.
GALACTIC_EVERYWHERE inline std::uint32_t claimAtomically(std::uint32_t* at, std::uint32_t empty,
                                                         std::uint32_t value) {
  __atomic_compare_exchange_n(at, &empty, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
  return empty;
}
GALACTIC_EVERYWHERE inline void greaterAtomically(std::uint64_t* to, std::uint64_t value) {
#if defined(__CUDA__)
  __atomic_fetch_max(to, value, __ATOMIC_RELAXED);
#else
  std::uint64_t old = loadAtomically(to);
  while (old < value &&
         !__atomic_compare_exchange_n(to, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
#endif
}

#endif

GALACTIC_EVERYWHERE inline void raiseAtomically(std::uint64_t* to, std::uint64_t value) {
  // The number read here may be out of date, but it is never too high.
  if (loadAtomically(to) < value) greaterAtomically(to, value);
}

}  // namespace
}  // namespace galactic::render::cuda
