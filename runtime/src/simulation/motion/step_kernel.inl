// Other work that is the same for all envs, with vectors of kWidth envs: reading actions, judging
// and observing steps. Included after motion_kernel.inl.
namespace galactic::simulation {
namespace {

/// Clamps actions to [-1, 1] and replaces NaN by 0, which it marks in `none`.
inline Lanes cut(Lanes action, IntLanes& none) {
  const IntLanes is_none = action != action;
  none |= is_none;
  return pick(is_none, spread(0), clampTo(action, -1, 1));
}

inline bool areAll(IntLanes mask) {
  std::int32_t all = -1;
  for (std::size_t n = 0; n < kWidth; ++n) all &= mask[n];
  return all != 0;
}

bool readKernel(const ActionBatch& batch) noexcept {
  IntLanes none{};
  for (std::size_t first = 0; first < batch.envs; first += kWidth) {
    const float* from = batch.from + first * batch.count;
    float* to = batch.to + first;
    for (std::size_t n = 0; batch.count < kLanes && n < batch.count; ++n) {
      store(to + n * kMostWidth, cut(loadStrided(from + n, batch.count), none));
    }
    for (std::size_t n = 0; batch.count >= kLanes && n < batch.count; n += kLanes) {
      // The last eight overlap those before.
      const std::size_t at = n + kLanes <= batch.count ? n : batch.count - kLanes;
      Lanes eight[kLanes];
      loadColumns(from + at, batch.count, eight);
      for (std::size_t m = 0; m < kLanes; ++m) {
        store(to + (at + m) * kMostWidth, cut(eight[m], none));
      }
    }
  }
  std::int32_t any = 0;
  for (std::size_t n = 0; n < kWidth; ++n) any |= none[n];
  return any != 0;
}

/// Writes eight rows as eight consecutive numbers of each wanted env, `stride` apart.
inline void putEight(const float* rows, IntLanes wanted, float* to, std::size_t stride) {
  Lanes eight[kLanes];
  for (std::size_t n = 0; n < kLanes; ++n) eight[n] = load(rows + n * kMostWidth);
  if (areAll(wanted)) {
    storeColumns(eight, to, stride);
    return;
  }
  float columns[kWidth * kLanes];
  storeColumns(eight, columns, kLanes);
  for (std::size_t e = 0; e < kWidth; ++e) {
    if (wanted[e] == 0) continue;
    __builtin_memcpy(to + e * stride, columns + e * kLanes, kLanes * sizeof(float));
  }
}

void shiftFramesKernel(const FrameShift& shift) noexcept {
  constexpr std::size_t kOrigin = 9;
  for (std::size_t first = 0; first < shift.envs; first += kWidth) {
    const float* by = shift.by + first;
    const Lanes along[3] = {load(by), load(by + kMostWidth), load(by + 2 * kMostWidth)};
    for (std::size_t n = kOrigin; n < shift.rows; n += kFrameNumbers) {
      float* row = shift.frames + n * kMostWidth + first;
      for (std::size_t axis = 0; axis < 3; ++axis, row += kMostWidth) {
        store(row, load(row) + along[axis]);
      }
    }
  }
}

void putFramesKernel(const FrameBatch& batch) noexcept {
  static_assert(kFrameNumbers >= kLanes);
  for (std::size_t first = 0; first < batch.envs; first += kWidth) {
    IntLanes wanted;
    __builtin_memcpy(&wanted, batch.wanted + first, sizeof(wanted));
    for (std::size_t n = 0; n < batch.rows; n += kLanes) {
      // The last eight overlap those before.
      const std::size_t at = n + kLanes <= batch.rows ? n : batch.rows - kLanes;
      putEight(batch.frames + at * kMostWidth + first, wanted, batch.to + first * batch.rows + at,
               batch.rows);
    }
  }
}

inline LaneVector difference(const LaneVector& a, const LaneVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Lanes dotOf(const LaneVector& a, const LaneVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Lanes squareRoot(Lanes value) {
  float roots[kWidth];
  store(roots, value);
  for (float& root : roots) root = __builtin_sqrtf(root);
  return load(roots);
}

inline Lanes distance(const LaneVector& a, const LaneVector& b) {
  const LaneVector away = difference(a, b);
  return squareRoot(dotOf(away, away));
}

void judgeKernel(const JudgeBatch& batch) noexcept {
  for (std::size_t first = 0; first < batch.envs; first += kWidth) {
    IntLanes active;
    __builtin_memcpy(&active, batch.active + first, sizeof(active));
    Lanes sum{};
    for (std::size_t n = 0; n < batch.joints; ++n) {
      const Lanes action = load(batch.actions + n * kMostWidth + first);
      float* last = batch.last_actions + n * kMostWidth + first;
      const Lanes before = load(last);
      const Lanes change = action - before;
      sum = sum + change * change;
      store(last, pick(active != 0, action, before));
    }
    store(batch.change + first, sum);
    const LaneVector target = loadPoint(batch.targets + first);
    constexpr std::size_t kOrigin = 9 * kMostWidth;
    store(batch.reach + first, distance(loadPoint(batch.grips + kOrigin + first), target));
    store(batch.transport + first, distance(target, loadPoint(batch.goals + first)));
  }
}

/// Appends numbers to the observations of the envs.
class RowsOut {
 public:
  RowsOut(float* out, std::size_t stride) : out_(out), stride_(stride) {}

  void add(Lanes value) {
    eight_[count_++] = value;
    if (count_ == kLanes) putDown();
  }
  void add(const LaneVector& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  /// Writes the numbers left over in the last, incomplete eight.
  void finish() {
    if (count_ == 0) return;
    for (std::size_t n = count_; n < kLanes; ++n) eight_[n] = eight_[0];
    float columns[kWidth * kLanes];
    storeColumns(eight_, columns, kLanes);
    for (std::size_t e = 0; e < kWidth; ++e) {
      __builtin_memcpy(out_ + e * stride_, columns + e * kLanes, count_ * sizeof(float));
    }
  }

 private:
  [[gnu::noinline]] void putDown() {
    storeColumns(eight_, out_, stride_);
    out_ += kLanes;
    count_ = 0;
  }

  float* out_;
  std::size_t stride_;
  std::size_t count_ = 0;
  Lanes eight_[kLanes];
};

/// The frames in which points are observed.
struct LaneEyes {
  LaneVector base;
  LaneFrame grip;
  Lanes cosine, sine;

  explicit LaneEyes(const ObserveBatch& batch, std::size_t first)
      : base{load(batch.pose.x + first), load(batch.pose.y + first), load(batch.pose.z + first)},
        grip{loadPoint(batch.grips + first), loadPoint(batch.grips + 3 * kMostWidth + first),
             loadPoint(batch.grips + 6 * kMostWidth + first),
             loadPoint(batch.grips + 9 * kMostWidth + first)},
        cosine(load(batch.grips + 12 * kMostWidth + first)),
        sine(load(batch.grips + 13 * kMostWidth + first)) {}

  /// Turns a vector into the frame of the base, which is turned by the yaw only.
  [[nodiscard]] LaneVector turned(const LaneVector& away) const {
    return {cosine * away.x - sine * away.z, away.y, sine * away.x + cosine * away.z};
  }
  [[nodiscard]] LaneVector fromBase(const LaneVector& point) const {
    return turned(difference(point, base));
  }
  [[nodiscard]] LaneVector fromGrip(const LaneVector& point) const {
    const LaneVector away = difference(point, grip.origin);
    return {dotOf(away, grip.x_axis), dotOf(away, grip.y_axis), dotOf(away, grip.z_axis)};
  }
};

inline void observeLanes(const ObserveBatch& batch, std::size_t first) {
  const LaneEyes eyes(batch, first);
  const LaneVector target = loadPoint(batch.targets + first);
  const LaneVector goal = loadPoint(batch.goals + first);
  const LaneVector robot_target = eyes.fromBase(target);
  const LaneVector grip_target = eyes.fromGrip(target);
  const LaneVector robot_grip = eyes.fromBase(eyes.grip.origin);
  const LaneVector robot_goal = eyes.fromBase(goal);
  const LaneVector grip_goal = eyes.fromGrip(goal);
  const Lanes points[2 * kLanes] = {
      robot_target.x, robot_target.y, robot_target.z, grip_target.x,
      grip_target.y,  grip_target.z,  robot_grip.x,   robot_grip.y,
      robot_grip.z,   robot_goal.x,   robot_goal.y,   robot_goal.z,
      grip_goal.x,    grip_goal.y,    grip_goal.z,    load(batch.holds + first)};
  float* row = batch.out + first * batch.out_stride;
  storeColumns(points, row, batch.out_stride);
  storeColumns(points + kLanes, row + kLanes, batch.out_stride);
  RowsOut out(row + 2 * kLanes, batch.out_stride);
  for (std::size_t n = 0; n < batch.controlled_count; ++n) {
    out.add(load(batch.pose.variables + batch.controlled[n] * batch.pose.stride + first));
  }
  const Lanes left = load(batch.left + first);
  out.add(lesser(spread(1), left));
  out.add(lesser(spread(1), spread(5) * left));
  out.add(lesser(spread(1), spread(50) * left));
  if (batch.observes_bump) out.add(load(batch.bumps + first));
  if (batch.observes_target_goal) {
    out.add(eyes.turned(difference(goal, loadPoint(batch.current_targets + first))));
  }
  out.finish();
}

void observeKernel(const ObserveBatch& batch) noexcept {
  for (std::size_t first = 0; first < batch.envs; first += kWidth) observeLanes(batch, first);
}

}  // namespace
}  // namespace galactic::simulation
