// The motion kernels, with vectors of kWidth envs. Included by motion_portable.cpp and
// motion_avx2.cpp after lanes_eight.inl and operations.inl, and by motion_avx512.cpp after
// lanes_sixteen.inl and operations.inl. These files differ only in the instructions that they may
// use. No library templates here: see column_grid_avx2.cpp.
namespace galactic::simulation {
namespace {

inline Lanes clampTo(Lanes value, float lower, float upper) {
  value = pick(value < spread(lower), spread(lower), value);
  return pick(value > spread(upper), spread(upper), value);
}

/// An angle of at most a few turns, wrapped to [-pi, pi).
inline Lanes wrapped(Lanes angle) {
  constexpr float kPi = 3.14159265F;
  constexpr float kTurn = 6.28318531F;
  const Lanes turned = angle - spread(kTurn) * rounded(angle * spread(1 / kTurn));
  const Lanes low = pick(turned < spread(-kPi), turned + spread(kTurn), turned);
  return pick(low >= spread(kPi), low - spread(kTurn), low);
}

struct SineCosine {
  Lanes sine, cosine;
};

/// Sine and cosine for |angle| < 1000, error under 1.2e-7: reduction by quarter turns in three
/// parts (Cody and Waite), then the minimax polynomials of the Cephes library (Moshier).
inline SineCosine sineCosine(Lanes angle) {
  const Lanes quarter = rounded(angle * spread(0.636619772F));
  const Lanes r =
      ((angle - quarter * spread(1.5703125F)) - quarter * spread(4.837512969970703e-4F)) -
      quarter * spread(7.549789948768648e-8F);
  const Lanes r2 = r * r;
  const Lanes sine = r + r * r2 *
                             ((spread(-1.9515295891e-4F) * r2 + spread(8.3321608736e-3F)) * r2 +
                              spread(-1.6666654611e-1F));
  const Lanes cosine =
      spread(1) - spread(0.5F) * r2 +
      r2 * r2 *
          ((spread(2.443315711809948e-5F) * r2 + spread(-1.388731625493765e-3F)) * r2 +
           spread(4.166664568298827e-2F));
  const IntLanes turns = __builtin_convertvector(quarter, IntLanes);
  const IntLanes swap = (turns & 1) != 0;
  const Lanes s = pick(swap, cosine, sine);
  const Lanes c = pick(swap, sine, cosine);
  return {pick((turns & 2) != 0, -s, s), pick(((turns + 1) & 2) != 0, -c, c)};
}

struct LaneVector {
  Lanes x, y, z;
};

/// Axes and origin of the frames of kWidth envs, in the world frame.
struct LaneFrame {
  LaneVector x_axis, y_axis, z_axis, origin;
};

inline LaneVector turned(const LaneFrame& frame, const Vec3& v) {
  const Lanes x = spread(v.x);
  const Lanes y = spread(v.y);
  const Lanes z = spread(v.z);
  return {frame.x_axis.x * x + frame.y_axis.x * y + frame.z_axis.x * z,
          frame.x_axis.y * x + frame.y_axis.y * y + frame.z_axis.y * z,
          frame.x_axis.z * x + frame.y_axis.z * y + frame.z_axis.z * z};
}

inline LaneVector moved(const LaneFrame& frame, const Vec3& point) {
  const LaneVector v = turned(frame, point);
  return {v.x + frame.origin.x, v.y + frame.origin.y, v.z + frame.origin.z};
}

inline LaneVector scaledSum(const LaneVector& a, Lanes s, const LaneVector& b, Lanes t) {
  return {a.x * s + b.x * t, a.y * s + b.y * t, a.z * s + b.z * t};
}

inline LaneFrame rootFrame(const PoseArrays& pose, float root_height) {
  const SineCosine heading = sineCosine(load(pose.yaw));
  const Lanes zero = spread(0);
  return {{heading.cosine, zero, -heading.sine},
          {zero, spread(1), zero},
          {heading.sine, zero, heading.cosine},
          {load(pose.x), load(pose.y) + spread(root_height), load(pose.z)}};
}

inline LaneFrame nodeFrame(const LaneFrame& parent, const MotionNode& node, Lanes variable) {
  const Lanes value = spread(node.multiplier) * variable + spread(node.offset);
  LaneFrame frame{turned(parent, node.x_axis), turned(parent, node.y_axis),
                  turned(parent, node.z_axis), moved(parent, node.origin)};
  if (node.motion == NodeMotion::kSlides) {
    frame.origin = {frame.origin.x + frame.x_axis.x * value,
                    frame.origin.y + frame.x_axis.y * value,
                    frame.origin.z + frame.x_axis.z * value};
    return frame;
  }
  const SineCosine angle = sineCosine(value);
  const LaneVector y = frame.y_axis;
  frame.y_axis = scaledSum(y, angle.cosine, frame.z_axis, angle.sine);
  frame.z_axis = scaledSum(frame.z_axis, angle.cosine, y, -angle.sine);
  return frame;
}

inline LaneVector loadPoint(const float* rows) {
  return {load(rows), load(rows + kMostWidth), load(rows + 2 * kMostWidth)};
}

inline void storePoint(float* rows, const LaneVector& point) {
  store(rows, point.x);
  store(rows + kMostWidth, point.y);
  store(rows + 2 * kMostWidth, point.z);
}

/// The frame of a node, or of the root for -1.
inline LaneFrame frameOf(const float* frames, std::int32_t node) {
  const float* rows = frames + frameRows(0) * kMostWidth * static_cast<std::size_t>(node + 1);
  return {loadPoint(rows), loadPoint(rows + 3 * kMostWidth), loadPoint(rows + 6 * kMostWidth),
          loadPoint(rows + 9 * kMostWidth)};
}

inline void storeFrame(float* rows, const LaneFrame& frame) {
  storePoint(rows, frame.x_axis);
  storePoint(rows + 3 * kMostWidth, frame.y_axis);
  storePoint(rows + 6 * kMostWidth, frame.z_axis);
  storePoint(rows + 9 * kMostWidth, frame.origin);
}

/// The least and the greatest value of a coordinate of eight spheres.
struct LaneBounds {
  Lanes least, most;
};

inline LaneBounds boundsOf(const Lanes values[kLanes]) {
  LaneBounds bounds{values[0], values[0]};
  for (std::size_t n = 1; n < kLanes; ++n) {
    bounds.least = lesser(bounds.least, values[n]);
    bounds.most = greater(bounds.most, values[n]);
  }
  return bounds;
}

/// The centers of eight spheres: a vector of envs for each coordinate of each sphere.
struct EightCenters {
  Lanes x[kLanes], y[kLanes], z[kLanes];
};

/// Places spheres that are fixed to the root, which stands upright: moved() without the terms that
/// are multiplied by 0.
inline void placeOnRoot(const BodySphere* spheres, const float* frames, EightCenters& centers) {
  const LaneFrame root = frameOf(frames, -1);
  for (std::size_t n = 0; n < kLanes; ++n) {
    const Lanes x = spread(spheres[n].center.x);
    const Lanes z = spread(spheres[n].center.z);
    centers.x[n] = root.x_axis.x * x + root.z_axis.x * z + root.origin.x;
    centers.y[n] = spread(spheres[n].center.y) + root.origin.y;
    centers.z[n] = root.x_axis.z * x + root.z_axis.z * z + root.origin.z;
  }
}

inline void placeOnNodes(const BodySphere* spheres, const float* frames, EightCenters& centers) {
  for (std::size_t n = 0; n < kLanes; ++n) {
    const LaneVector center = moved(frameOf(frames, spheres[n].node), spheres[n].center);
    centers.x[n] = center.x;
    centers.y[n] = center.y;
    centers.z[n] = center.z;
  }
}

inline bool areOnRoot(const BodySphere* spheres) {
  std::int32_t nodes = -1;
  for (std::size_t n = 0; n < kLanes; ++n) nodes &= spheres[n].node;
  return nodes == -1;
}

/// Places eight spheres and writes their centers. `bounds`: kBounds vectors for the bounds of these
/// spheres; null if not wanted.
inline void placeEightSpheres(const BodySphere* spheres, const float* frames, float* centers,
                              std::size_t count, Lanes* bounds) {
  EightCenters found;
  areOnRoot(spheres) ? placeOnRoot(spheres, frames, found) : placeOnNodes(spheres, frames, found);
  const Lanes* const rows[3] = {found.x, found.y, found.z};
  for (std::size_t c = 0; c < 3; ++c) {
    if (bounds != nullptr) {
      const LaneBounds both = boundsOf(rows[c]);
      bounds[2 * c] = both.least;
      bounds[2 * c + 1] = both.most;
    }
    storeColumns(rows[c], centers + c * count, 3 * count);
  }
}

inline LaneFrame fixedFrame(const float* frames, const FixedFrame& fixed) {
  const LaneFrame node = frameOf(frames, fixed.node);
  return {turned(node, fixed.x_axis), turned(node, fixed.y_axis), turned(node, fixed.z_axis),
          moved(node, fixed.origin)};
}

inline void placeGrip(const MotionTables& tables, const float* frames, float* grips) {
  storeFrame(grips, fixedFrame(frames, tables.grip));
  const LaneFrame root = frameOf(frames, -1);
  store(grips + kFrameNumbers * kMostWidth, root.x_axis.x);
  store(grips + (kFrameNumbers + 1) * kMostWidth, root.z_axis.x);
}

/// Places root and nodes.
inline void placeFrames(const MotionTables& tables, const PoseArrays& pose, float* frames) {
  storeFrame(frames, rootFrame(pose, tables.root_height));
  for (std::uint32_t n = 0; n < tables.node_count; ++n) {
    const MotionNode& node = tables.nodes[n];
    storeFrame(frames + frameRows(n) * kMostWidth,
               nodeFrame(frameOf(frames, node.parent), node,
                         load(pose.variables + node.variable * pose.stride)));
  }
}

inline void moveLanes(const MotionTables& tables, const MoveBatch& batch) noexcept {
  const Lanes forward = load(batch.actions + batch.joints * kMostWidth);
  const Lanes clockwise = load(batch.actions + (batch.joints + 1) * kMostWidth);
  const Lanes yaw = wrapped(load(batch.from.yaw) - spread(tables.turn_step) * clockwise);
  const SineCosine heading = sineCosine(yaw);
  const Lanes drive = spread(tables.forward_step) * forward;
  Lanes x = load(batch.from.x) + heading.cosine * drive;
  Lanes z = load(batch.from.z) - heading.sine * drive;
  if (tables.sideways_step > 0) {
    const Lanes left =
        spread(tables.sideways_step) * load(batch.actions + (batch.joints + 2) * kMostWidth);
    x = x - heading.sine * left;
    z = z - heading.cosine * left;
  }
  store(batch.to.yaw, yaw);
  store(batch.to.x, x);
  store(batch.to.y, load(batch.from.y));
  store(batch.to.z, z);
  for (std::uint32_t v = 0; v < tables.variable_count; ++v) {
    const MotionVariable& variable = tables.variables[v];
    Lanes value = load(batch.from.variables + v * batch.from.stride);
    if (variable.action >= 0) {
      const Lanes action =
          load(batch.actions + static_cast<std::size_t>(variable.action) * kMostWidth);
      value = value + spread(variable.step) * action;
      value = variable.wraps ? wrapped(value) : clampTo(value, variable.lower, variable.upper);
    }
    store(batch.to.variables + v * batch.to.stride, value);
  }
}

/// Writes the bounds of `count` groups to the rows of the envs from `to` on; pads them to eight
/// groups with copies of the first.
inline void storeBounds(const Lanes groups[kLanes][kBounds], std::size_t count, float* to,
                        std::size_t stride) {
  for (std::size_t b = 0; b < kBounds; ++b) {
    Lanes rows[kLanes];
    for (std::size_t n = 0; n < kLanes; ++n) rows[n] = groups[n < count ? n : 0][b];
    storeColumns(rows, to + b * stride, kBounds * stride);
  }
}

/// Extends bounds to contain others.
inline void extend(Lanes all[kBounds], const Lanes more[kBounds]) {
  for (std::size_t b = 0; b < kBounds; b += 2) {
    all[b] = lesser(all[b], more[b]);
    all[b + 1] = greater(all[b + 1], more[b + 1]);
  }
}

/// Writes the bounds of all spheres to the rows of the envs.
inline void storeExtents(const Lanes all[kBounds], float* to) {
  const Lanes rows[kLanes] = {all[0], all[1], all[2], all[3], all[4], all[5], all[4], all[5]};
  storeColumns(rows, to, kExtentStride);
}

/// Places all spheres, with the bounds of each group of eight.
inline void placeSpheres(const MotionTables& tables, const BodyArrays& body) {
  const std::uint32_t groups = tables.sphere_count / kLanes;
  const std::size_t stride = paddedToLanes(groups);
  Lanes bounds[kLanes][kBounds];
  Lanes all[kBounds]{};
  for (std::uint32_t first = 0; first < groups; first += kLanes) {
    const std::uint32_t here = groups - first < kLanes ? groups - first : kLanes;
    for (std::uint32_t n = 0; n < here; ++n) {
      const std::uint32_t sphere = (first + n) * kLanes;
      placeEightSpheres(tables.spheres + sphere, body.frames, body.centers + sphere,
                        tables.sphere_count, body.bounds == nullptr ? nullptr : bounds[n]);
    }
    if (body.bounds == nullptr) continue;
    storeBounds(bounds, here, body.bounds + first, stride);
    if (first == 0) __builtin_memcpy(all, bounds[0], sizeof(all));
    for (std::uint32_t n = 0; n < here; ++n) extend(all, bounds[n]);
  }
  if (body.bounds != nullptr) storeExtents(all, body.extents);
}

inline void placeLanes(const MotionTables& tables, const BodyBatch& batch) noexcept {
  placeFrames(tables, batch.pose, batch.body.frames);
  placeSpheres(tables, batch.body);
  placeGrip(tables, batch.body.frames, batch.body.grips);
}

inline PoseArrays envsFrom(const PoseArrays& pose, std::size_t first) {
  return {pose.x + first,   pose.y + first,         pose.z + first,
          pose.yaw + first, pose.variables + first, pose.stride};
}

template <class Value>
Value* rowsFrom(Value* values, std::size_t rows) {
  return values == nullptr ? nullptr : values + rows;
}

inline BodyArrays envsFrom(const MotionTables& tables, const BodyArrays& body, std::size_t first) {
  const std::size_t groups = paddedToLanes(tables.sphere_count / kLanes);
  return {rowsFrom(body.frames, first),
          rowsFrom(body.centers, std::size_t{3} * tables.sphere_count * first),
          rowsFrom(body.grips, first), rowsFrom(body.bounds, kBounds * groups * first),
          rowsFrom(body.extents, kExtentStride * first)};
}

void moveKernel(const MotionTables& tables, const MoveBatch& batch) noexcept {
  for (std::size_t first = 0; first < batch.envs; first += kWidth) {
    moveLanes(tables, {batch.actions + first, batch.joints, envsFrom(batch.from, first),
                       envsFrom(batch.to, first), kWidth});
  }
}

void placeKernel(const MotionTables& tables, const BodyBatch& batch) noexcept {
  for (std::size_t first = 0; first < batch.envs; first += kWidth) {
    placeLanes(tables, {envsFrom(batch.pose, first), envsFrom(tables, batch.body, first), kWidth});
  }
}

}  // namespace
}  // namespace galactic::simulation
