// The kernels, written with eight-lane vectors. Included by kernels_portable.cpp and
// kernels_avx2.cpp, which define fused(a, b, c) = a * b + c, rounded once, and squareRoot(), and
// differ in the instructions that they may use. No library templates here: see
// column_grid_avx2.cpp.
namespace galactic::policy {
namespace {

using IntLanes = std::int32_t __attribute__((vector_size(32)));

inline Lanes load(const float* from) {
  Lanes lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

inline void store(float* to, Lanes lanes) { __builtin_memcpy(to, &lanes, sizeof(lanes)); }

inline Lanes spread(float value) {
  return Lanes{value, value, value, value, value, value, value, value};
}

inline Lanes floatsOf(IntLanes bits) {
  Lanes lanes;
  __builtin_memcpy(&lanes, &bits, sizeof(lanes));
  return lanes;
}

inline IntLanes bitsOf(Lanes lanes) {
  IntLanes bits;
  __builtin_memcpy(&bits, &lanes, sizeof(bits));
  return bits;
}

inline Lanes pick(IntLanes mask, Lanes yes, Lanes no) {
  return floatsOf((bitsOf(yes) & mask) | (bitsOf(no) & ~mask));
}

inline Lanes atMost(Lanes value, float limit) {
  return pick(value > spread(limit), spread(limit), value);
}
inline Lanes atLeast(Lanes value, float limit) {
  return pick(value < spread(limit), spread(limit), value);
}

/// The nearest whole number, if |value| < 2^22.
inline Lanes rounded(Lanes value) {
  const Lanes shift = spread(12582912.0F);  // 1.5 * 2^23: leaves no bits for a fraction
  return (value + shift) - shift;
}

/// e to the power of x, with x limited to [-87, 88]; relative error under 2e-7 (Cephes library,
/// Moshier).
inline Lanes exponential(Lanes x) {
  x = atLeast(atMost(x, 88.0F), -87.0F);
  const Lanes n = rounded(x * spread(1.44269504F));
  const Lanes r = fused(n, spread(2.12194440e-4F), fused(n, spread(-0.693359375F), x));
  Lanes p = spread(1.9875691500e-4F);
  p = fused(p, r, spread(1.3981999507e-3F));
  p = fused(p, r, spread(8.3334519073e-3F));
  p = fused(p, r, spread(4.1665795894e-2F));
  p = fused(p, r, spread(1.6666665459e-1F));
  p = fused(p, r, spread(5.0000001201e-1F));
  p = fused(p, r * r, r + spread(1));
  const IntLanes exponent = (__builtin_convertvector(n, IntLanes) + 127) << 23;
  return p * floatsOf(exponent);
}

inline Lanes sigmoid(Lanes x) { return spread(1) / (spread(1) + exponential(-x)); }

/// Error under 3e-7; NaN stays NaN.
inline Lanes hyperbolicTangent(Lanes x) {
  const Lanes size = floatsOf(bitsOf(x) & 0x7FFFFFFF);
  // Near 0, where the quotient below would suffer from cancellation, use the polynomial of the
  // Cephes library.
  const Lanes x2 = x * x;
  Lanes p = spread(-5.70498872745e-3F);
  p = fused(p, x2, spread(2.06390887954e-2F));
  p = fused(p, x2, spread(-5.37397155531e-2F));
  p = fused(p, x2, spread(1.33314422036e-1F));
  p = fused(p, x2, spread(-3.33332819422e-1F));
  const Lanes near = fused(p * x2, x, x);
  const Lanes far_size = spread(1) - spread(2) / (exponential(size + size) + spread(1));
  const Lanes far = floatsOf(bitsOf(far_size) | (bitsOf(x) & INT32_MIN));
  return pick(size < spread(0.625F), near, pick(x == x, far, x));
}

/// For 0 < x <= 1, error under 1e-7 (Cephes library).
inline Lanes naturalLogarithm(Lanes x) {
  IntLanes bits = bitsOf(x);
  Lanes e = __builtin_convertvector((bits >> 23) - 126, Lanes);
  Lanes m = floatsOf((bits & 0x007FFFFF) | 0x3F000000);  // in [0.5, 1)
  const IntLanes small = m < spread(0.707106781F);
  e = pick(small, e - spread(1), e);
  m = pick(small, m + m, m) - spread(1);
  const Lanes m2 = m * m;
  Lanes p = spread(7.0376836292e-2F);
  p = fused(p, m, spread(-1.1514610310e-1F));
  p = fused(p, m, spread(1.1676998740e-1F));
  p = fused(p, m, spread(-1.2420140846e-1F));
  p = fused(p, m, spread(1.4249322787e-1F));
  p = fused(p, m, spread(-1.6668057665e-1F));
  p = fused(p, m, spread(2.0000714765e-1F));
  p = fused(p, m, spread(-2.4999993993e-1F));
  p = fused(p, m, spread(3.3333331174e-1F));
  Lanes y = p * m * m2;
  y = fused(e, spread(-2.12194440e-4F), y);
  y = fused(m2, spread(-0.5F), y);
  return fused(e, spread(0.693359375F), m + y);
}

/// Sine and cosine of 2 pi t, for t in [0, 1).
inline void turn(Lanes t, Lanes& sine, Lanes& cosine) {
  // The nearest quarter, and the angle from it in [-pi / 4, pi / 4].
  const Lanes quarter = rounded(t * spread(4));
  const Lanes r = fused(quarter, spread(-0.25F), t) * spread(6.28318531F);
  const Lanes r2 = r * r;
  Lanes s = spread(-1.9515295891e-4F);
  s = fused(s, r2, spread(8.3321608736e-3F));
  s = fused(s, r2, spread(-1.6666654611e-1F));
  s = fused(s * r2, r, r);
  Lanes c = spread(2.443315711809948e-5F);
  c = fused(c, r2, spread(-1.388731625493765e-3F));
  c = fused(c, r2, spread(4.166664568298827e-2F));
  c = fused(c * r2, r2, fused(r2, spread(-0.5F), spread(1)));
  const IntLanes turns = __builtin_convertvector(quarter, IntLanes);
  const IntLanes swap = (turns & 1) != 0;
  const IntLanes sine_sign = (turns & 2) << 30;
  const IntLanes cosine_sign = ((turns + 1) & 2) << 30;
  sine = floatsOf(bitsOf(pick(swap, c, s)) ^ sine_sign);
  cosine = floatsOf(bitsOf(pick(swap, s, c)) ^ cosine_sign);
}

/// The highest 24 bits of each word as a multiple of 2^-24 in [0, 1).
inline Lanes unit(const std::uint32_t* words) {
  IntLanes bits;
  __builtin_memcpy(&bits, words, sizeof(bits));
  return __builtin_convertvector((bits >> 8) & 0xFFFFFF, Lanes) * spread(0x1p-24F);
}

void gaussiansKernel(const std::uint32_t* words, float* to) noexcept {
  const Lanes radius = squareRoot(spread(-2) * naturalLogarithm(unit(words) + spread(0x1p-24F)));
  Lanes sine;
  Lanes cosine;
  turn(unit(words + kLane), sine, cosine);
  store(to, radius * cosine);
  store(to + kLane, radius * sine);
}

/// Multiplies kRowsTogether rows by one pack of weights, keeping the sums in registers.
template <int kRowsTogether>
inline void multiplyRows(const Product& product, std::size_t first) {
  constexpr auto kCount = static_cast<std::size_t>(kRowsTogether);
  Lanes low[kCount];
  Lanes high[kCount];
  const float* rows[kCount];
#pragma GCC unroll 6
  for (std::size_t r = 0; r < kCount; ++r) {
    low[r] = load(product.bias);
    high[r] = load(product.bias + kLane);
    rows[r] = product.rows[first + r];
  }
  const float* weights = product.weights;
  for (std::size_t i = 0; i < product.runs; ++i) {
    const std::size_t begin = i * product.run_stride;
    for (std::size_t k = begin; k < begin + product.run_length; ++k) {
      const Lanes weights_low = load(weights);
      const Lanes weights_high = load(weights + kLane);
      weights += kPack;
#pragma GCC unroll 6
      for (std::size_t r = 0; r < kCount; ++r) {
        const Lanes value = spread(rows[r][k]);
        low[r] = fused(value, weights_low, low[r]);
        high[r] = fused(value, weights_high, high[r]);
      }
    }
  }
#pragma GCC unroll 6
  for (std::size_t r = 0; r < kCount; ++r) {
    float* result = product.results[first + r];
    if (product.outputs == kPack) {
      store(result, low[r]);
      store(result + kLane, high[r]);
    } else {
      float all[kPack];
      store(all, low[r]);
      store(all + kLane, high[r]);
      for (std::size_t n = 0; n < product.outputs; ++n) result[n] = all[n];
    }
  }
}

void multiplyKernel(const Product& product) noexcept {
  constexpr std::size_t kTogether = 6;
  std::size_t row = 0;
  for (; row + kTogether <= product.row_count; row += kTogether) multiplyRows<6>(product, row);
  switch (product.row_count - row) {
    case 5:
      return multiplyRows<5>(product, row);
    case 4:
      return multiplyRows<4>(product, row);
    case 3:
      return multiplyRows<3>(product, row);
    case 2:
      return multiplyRows<2>(product, row);
    case 1:
      return multiplyRows<1>(product, row);
    default:
      return;
  }
}

void reluKernel(const float* from, float* to, std::size_t count) noexcept {
  for (std::size_t n = 0; n < count; n += kLane) store(to + n, atLeast(load(from + n), 0));
}

void tanhKernel(const float* from, float* to, std::size_t count) noexcept {
  for (std::size_t n = 0; n < count; n += kLane) store(to + n, hyperbolicTangent(load(from + n)));
}

void expKernel(const float* from, float* to, std::size_t count) noexcept {
  for (std::size_t n = 0; n < count; n += kLane) store(to + n, exponential(load(from + n)));
}

void addKernel(const float* a, const float* b, float* to, std::size_t count) noexcept {
  for (std::size_t n = 0; n < count; n += kLane) store(to + n, load(a + n) + load(b + n));
}

/// Adds up each channel's values, or their squared distances from `means`, over the pixels. Eight
/// channels are added up together, each over the pixels in order; the remaining ones alone, in the
/// same order.
inline void sumChannels(const GroupNormalization& task, const float* means, float* sums) {
  std::size_t channel = 0;
  for (; channel + kLane <= task.channels; channel += kLane) {
    const Lanes mean = means == nullptr ? spread(0) : load(means + channel);
    Lanes sum = spread(0);
    for (std::size_t p = 0; p < task.pixels; ++p) {
      const Lanes away = load(task.from + p * task.channels + channel) - mean;
      sum = means == nullptr ? sum + away : fused(away, away, sum);
    }
    store(sums + channel, sum);
  }
  for (; channel < task.channels; ++channel) {
    const Lanes mean = spread(means == nullptr ? 0 : means[channel]);
    Lanes sum = spread(0);
    for (std::size_t p = 0; p < task.pixels; ++p) {
      const Lanes away = spread(task.from[p * task.channels + channel]) - mean;
      sum = means == nullptr ? sum + away : fused(away, away, sum);
    }
    sums[channel] = sum[0];
  }
}

void normalizeGroupsKernel(const GroupNormalization& task) noexcept {
  float* sums = task.scratch;
  float* means = task.scratch + task.channels;
  const std::size_t width = task.channels / task.groups;
  const float count = static_cast<float>(task.pixels * width);
  sumChannels(task, nullptr, sums);
  for (std::size_t g = 0; g < task.groups; ++g) {
    float sum = 0;
    for (std::size_t c = g * width; c < (g + 1) * width; ++c) sum += sums[c];
    for (std::size_t c = g * width; c < (g + 1) * width; ++c) means[c] = sum / count;
  }
  sumChannels(task, means, sums);
  // From here on, the result is value * sums + means.
  for (std::size_t g = 0; g < task.groups; ++g) {
    float sum = 0;
    for (std::size_t c = g * width; c < (g + 1) * width; ++c) sum += sums[c];
    const float deviation = squareRoot(spread(sum / count + task.epsilon))[0];
    for (std::size_t c = g * width; c < (g + 1) * width; ++c) {
      sums[c] = task.weight[c] / deviation;
      means[c] = task.bias[c] - means[c] * sums[c];
    }
  }
  for (std::size_t p = 0; p < task.pixels; ++p) {
    const float* from = task.from + p * task.channels;
    float* to = task.to + p * task.channels;
    std::size_t c = 0;
    for (; c + kLane <= task.channels; c += kLane) {
      store(to + c, fused(load(from + c), load(sums + c), load(means + c)));
    }
    for (; c < task.channels; ++c) {
      to[c] = fused(spread(from[c]), spread(sums[c]), spread(means[c]))[0];
    }
  }
}

void gateKernel(const GatedUpdate& update) noexcept {
  const std::size_t size = update.size;
  for (std::size_t n = 0; n < size; n += kLane) {
    const Lanes reset = sigmoid(load(update.input + n) + load(update.recurrent + n));
    const Lanes keep = sigmoid(load(update.input + size + n) + load(update.recurrent + size + n));
    const Lanes fresh = hyperbolicTangent(
        fused(reset, load(update.recurrent + 2 * size + n), load(update.input + 2 * size + n)));
    const Lanes state = load(update.state + n);
    store(update.to + n, fused(keep, state - fresh, fresh));
  }
}

constexpr Kernels listKernels() {
  return {.multiply = multiplyKernel,
          .relu = reluKernel,
          .tanh = tanhKernel,
          .exp = expKernel,
          .add = addKernel,
          .gaussians = gaussiansKernel,
          .normalizeGroups = normalizeGroupsKernel,
          .gate = gateKernel};
}

}  // namespace
}  // namespace galactic::policy
