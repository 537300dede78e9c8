#pragma once
#include <cstddef>
#include <cstdint>

namespace galactic::policy {

// The kernels that compute layers, on bare pointers: code built for AVX2 must not instantiate
// library templates, which the linker could then share with code for any processor. Every sum is
// added up in one fixed order, with fused multiplications, so that both versions agree bit for bit,
// and the result of an env does not depend on the envs that are computed together with it.

/// Most rows that are multiplied together.
inline constexpr std::size_t kRows = 96;
/// Results that are adjacent in packed weights.
inline constexpr std::size_t kPack = 16;
/// The buffers of elementwise kernels are readable and writable up to a multiple of this many
/// floats.
inline constexpr std::size_t kLane = 8;

/// results[r][0 .. outputs) = bias + sum over i, k of rows[r][i * run_stride + k] *
/// weights[(i * run_length + k) * kPack + .].
struct Product {
  /// Each row is `runs` runs of `run_length` numbers, `run_stride` apart.
  const float* const* rows = nullptr;
  float* const* results = nullptr;
  std::size_t row_count = 0;
  std::size_t runs = 0;
  std::size_t run_length = 0;
  std::size_t run_stride = 0;
  const float* weights = nullptr;
  /// kPack elements.
  const float* bias = nullptr;
  /// From 1 to kPack.
  std::size_t outputs = 0;
};

/// Normalizes one image by groups of neighboring channels.
struct GroupNormalization {
  const float* from = nullptr;
  float* to = nullptr;
  std::size_t pixels = 0;
  std::size_t channels = 0;
  std::size_t groups = 0;
  float epsilon = 0;
  const float* weight = nullptr;
  const float* bias = nullptr;
  /// Two numbers per channel.
  float* scratch = nullptr;
};

/// One step of a gated recurrent unit for one env, from the sums of its gates (reset, update, new;
/// `size` each).
struct GatedUpdate {
  const float* input = nullptr;
  const float* recurrent = nullptr;
  const float* state = nullptr;
  float* to = nullptr;
  std::size_t size = 0;
};

struct Kernels {
  void (*multiply)(const Product&) noexcept = nullptr;
  void (*relu)(const float* from, float* to, std::size_t count) noexcept = nullptr;
  void (*tanh)(const float* from, float* to, std::size_t count) noexcept = nullptr;
  void (*exp)(const float* from, float* to, std::size_t count) noexcept = nullptr;
  void (*add)(const float* a, const float* b, float* to, std::size_t count) noexcept = nullptr;
  /// Makes sixteen normally distributed numbers from sixteen random words (Box and Muller 1958).
  void (*gaussians)(const std::uint32_t* words, float* to) noexcept = nullptr;
  void (*normalizeGroups)(const GroupNormalization&) noexcept = nullptr;
  void (*gate)(const GatedUpdate&) noexcept = nullptr;
};

/// For any processor; slow if it has no fused multiplication.
[[nodiscard]] Kernels portableKernels() noexcept;
/// For processors with AVX2 and FMA: see detail::hasFusedAvx2().
[[nodiscard]] Kernels avx2Kernels() noexcept;
/// The faster of those that this processor can run.
[[nodiscard]] Kernels kernels() noexcept;

}  // namespace galactic::policy
