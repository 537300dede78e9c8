// Finds which clusters of a pane's models may be visible, and in which order they are drawn.
// Clusters that are left out here cover no pixel, so images do not depend on culling: all bounds
// are widened by the largest error that rounding and moving vertices to 1/256 pixel can cause.
// Cones of normals are not used, because a triangle that is seen almost edge-on can turn to the
// viewer when its vertices are moved.
namespace galactic::render {
namespace {

/// A generous bound of the error of a sum of a few products, relative to the sum of their
/// magnitudes.
constexpr float kRounding = 2e-6F;
/// A generous bound of how far vertices are moved, in 1/256 pixel.
constexpr float kMoved = 4;
constexpr float kUnknownNearness = __builtin_inff();
/// Rows of cluster_bounds, as schema/render.fbs defines them.
constexpr std::uint32_t kCenterX = 0;
constexpr std::uint32_t kHalfX = 3;

/// A pane's edges, in 1/256 pixel from the image's center.
struct PaneEdges {
  float left, right, top, bottom;
};

GALACTIC_EVERYWHERE inline PaneEdges paneEdges(const PaneTask& task) {
  const auto units = [](std::uint32_t pixels, std::uint32_t image) {
    return static_cast<float>(pixels) * kSubpixels - static_cast<float>(image) * kHalfPixel;
  };
  return {units(task.left, task.image_width), units(task.left + task.width, task.image_width),
          units(task.top, task.image_height), units(task.top + task.height, task.image_height)};
}

/// A linear function of the points of a model, and a bound of its error.
struct Row {
  float axis[3];
  float start, error;
};

GALACTIC_EVERYWHERE inline Row makeRow(const float* row, const ModelTables& model) {
  float size = magnitude(row[3]);
  for (int n = 0; n < 3; ++n) {
    size += magnitude(row[n]) * (magnitude(model.center[n]) + model.half_extents[n]);
  }
  return {{row[0], row[1], row[2]}, row[3], size * kRounding};
}

/// a * factor + b.
GALACTIC_EVERYWHERE inline Row combine(const Row& a, float factor, const Row& b) {
  return {{a.axis[0] * factor + b.axis[0], a.axis[1] * factor + b.axis[1],
           a.axis[2] * factor + b.axis[2]},
          a.start * factor + b.start,
          a.error * magnitude(factor) + b.error};
}

GALACTIC_EVERYWHERE inline Row negative(const Row& a) {
  return {{-a.axis[0], -a.axis[1], -a.axis[2]}, -a.start, a.error};
}

constexpr int kPlanes = 5;

/// A model in front of a pane: a point may be visible if no plane is negative there.
struct CullFrame {
  Row w, x, y;
  Row planes[kPlanes];
  PaneEdges edges;
  /// A bound of the error of X / w and Y / w, times w.
  float projected_error;
};

GALACTIC_EVERYWHERE inline CullFrame makeFrame(const PaneTask& task, const PlacedModel& placed) {
  const ModelTables& model = *placed.model;
  CullFrame frame;
  frame.w = makeRow(placed.w, model);
  frame.x = makeRow(placed.x, model);
  frame.y = makeRow(placed.y, model);
  frame.edges = paneEdges(task);
  const PaneEdges& edges = frame.edges;
  frame.planes[0] = frame.w;
  frame.planes[0].start -= task.near;
  frame.planes[1] = combine(frame.w, -(edges.left - kSubpixels), frame.x);
  frame.planes[2] = combine(frame.w, edges.right + kSubpixels, negative(frame.x));
  frame.planes[3] = combine(frame.w, -(edges.top - kSubpixels), frame.y);
  frame.planes[4] = combine(frame.w, edges.bottom + kSubpixels, negative(frame.y));
  for (Row& plane : frame.planes) plane.start += plane.error;
  const float widest = 128.0F * static_cast<float>(task.image_width + task.image_height);
  frame.projected_error = 2 * (frame.x.error + frame.y.error + widest * frame.w.error);
  return frame;
}

GALACTIC_EVERYWHERE inline bool mayShow(const CullFrame& frame, const ModelTables& model) {
  const float* c = model.center;
  const float* h = model.half_extents;
  for (const Row& plane : frame.planes) {
    const float center =
        plane.axis[0] * c[0] + plane.axis[1] * c[1] + plane.axis[2] * c[2] + plane.start;
    const float reach = magnitude(plane.axis[0]) * h[0] + magnitude(plane.axis[1]) * h[1] +
                        magnitude(plane.axis[2]) * h[2];
    if (center + reach < 0) return false;
  }
  return true;
}

/// The boxes of a vector of clusters.
struct BoxLanes {
  Lanes center[3];
  Lanes half[3];
};

GALACTIC_EVERYWHERE inline Lanes atCenter(const Row& row, const BoxLanes& box) {
  return spread(row.axis[0]) * box.center[0] + spread(row.axis[1]) * box.center[1] +
         spread(row.axis[2]) * box.center[2] + spread(row.start);
}

GALACTIC_EVERYWHERE inline Lanes reachOf(const Row& row, const BoxLanes& box) {
  return spread(magnitude(row.axis[0])) * box.half[0] +
         spread(magnitude(row.axis[1])) * box.half[1] +
         spread(magnitude(row.axis[2])) * box.half[2];
}

/// Bit n: box n is not entirely outside any of the planes.
GALACTIC_EVERYWHERE inline unsigned withinPlanes(const CullFrame& frame, const BoxLanes& box) {
  IntLanes outside = spread(0);
  for (const Row& plane : frame.planes) {
    outside |= (atCenter(plane, box) + reachOf(plane, box)) < spread(0.0F);
  }
  return ~signBits(outside) & kAllLanes;
}

struct Interval {
  Lanes low, high;
};

/// The part of the image that some boxes cover, in 1/256 pixels from its center; it may lie outside
/// the pane.
struct Footprint {
  Interval x, y;
};

/// The intervals of X / w and Y / w over the corners of the boxes, for boxes in front of the eye.
GALACTIC_EVERYWHERE inline Footprint footprint(const CullFrame& frame, const BoxLanes& box) {
  Lanes w_steps[3];
  Lanes x_steps[3];
  Lanes y_steps[3];
  for (int n = 0; n < 3; ++n) {
    w_steps[n] = spread(frame.w.axis[n]) * box.half[n];
    x_steps[n] = spread(frame.x.axis[n]) * box.half[n];
    y_steps[n] = spread(frame.y.axis[n]) * box.half[n];
  }
  const Lanes w = atCenter(frame.w, box);
  const Lanes x = atCenter(frame.x, box);
  const Lanes y = atCenter(frame.y, box);
  const Lanes far = spread(1e30F);
  Footprint result{{far, -far}, {far, -far}};
  const auto corner_value = [](Lanes center, const Lanes* steps, unsigned corner) {
    const Lanes a = (corner & 1U) != 0 ? center + steps[0] : center - steps[0];
    const Lanes b = (corner & 2U) != 0 ? a + steps[1] : a - steps[1];
    return (corner & 4U) != 0 ? b + steps[2] : b - steps[2];
  };
#pragma GCC unroll 8
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Lanes inverse = spread(1.0F) / corner_value(w, w_steps, corner);
    const Lanes px = corner_value(x, x_steps, corner) * inverse;
    const Lanes py = corner_value(y, y_steps, corner) * inverse;
    result.x = {lesser(result.x.low, px), greater(result.x.high, px)};
    result.y = {lesser(result.y.low, py), greater(result.y.high, py)};
  }
  return result;
}

/// First and last pixel whose center lies in the interval; there is none if first > last.
struct PixelRange {
  IntLanes first, last;
};

/// `edge`: where the pane begins, in the units of the interval; `count`: how many pixels it has.
GALACTIC_EVERYWHERE inline PixelRange pixelsWithin(const Interval& interval, Lanes error,
                                                   float edge, std::uint32_t count) {
  const Lanes low = (interval.low - error - spread(edge + kHalfPixel)) * spread(1.0F / kSubpixels);
  const Lanes high =
      (interval.high + error - spread(edge + kHalfPixel)) * spread(1.0F / kSubpixels);
  const auto most = static_cast<float>(count);
  const Lanes low_clamped = clampTo(low, 0, most);
  const IntLanes low_int = toInt(low_clamped);
  const IntLanes first = low_int - (toFloat(low_int) < low_clamped);
  // One is added before clamping, so that an interval that ends before the first pixel has no
  // pixel.
  const IntLanes last = toInt(clampTo(high + spread(1.0F), 0, most)) - spread(1);
  return {first, last};
}

/// Nearness and pixels of a vector of clusters. Bit n of `seen`: cluster n may be visible.
struct BoxesSeen {
  unsigned seen;
  Lanes nearest;
  Lanes distance;
  PixelRange x, y;
};

/// The boxes of a block of eight and, if a vector takes two blocks, of the block `next` numbers
/// further.
GALACTIC_EVERYWHERE inline BoxLanes loadBoxes(const float* bounds, std::size_t next = 0) {
  BoxLanes box;
  for (std::size_t n = 0; n < 3; ++n) {
    box.center[n] = loadRows(bounds + kWidth * (kCenterX + n), next);
    box.half[n] = loadRows(bounds + kWidth * (kHalfX + n), next);
  }
  return box;
}

GALACTIC_EVERYWHERE inline BoxesSeen lookAt(const PaneTask& task, const CullFrame& frame,
                                            const BoxLanes& box) {
  BoxesSeen boxes;
  boxes.seen = task.culling ? withinPlanes(frame, box) : kAllLanes;
  if (boxes.seen == 0) return boxes;
  boxes.distance = atCenter(frame.w, box) - reachOf(frame.w, box) - spread(frame.w.error);
  boxes.nearest = spread(kUnknownNearness);
  const auto last_x = static_cast<std::int32_t>(task.width) - 1;
  const auto last_y = static_cast<std::int32_t>(task.height) - 1;
  boxes.x = {spread(0), spread(last_x)};
  boxes.y = {spread(0), spread(last_y)};
  if (!task.culling) return boxes;
  const IntLanes in_front = boxes.distance > spread(task.near);
  if ((signBits(in_front) & boxes.seen) == 0) return boxes;
  const Lanes inverse = spread(1.0F) / boxes.distance;
  // Enlarged by a millionth, because the division is rounded.
  boxes.nearest = pick(in_front, inverse * spread(1.000001F), boxes.nearest);
  const Lanes error = spread(frame.projected_error) * inverse + spread(kMoved);
  const Footprint covered = footprint(frame, box);
  const PixelRange x = pixelsWithin(covered.x, error, frame.edges.left, task.width);
  const PixelRange y = pixelsWithin(covered.y, error, frame.edges.top, task.height);
  const IntLanes none = in_front & ((x.first > x.last) | (y.first > y.last));
  boxes.seen &= ~signBits(none);
  boxes.x = {pick(in_front, x.first, boxes.x.first), pick(in_front, x.last, boxes.x.last)};
  boxes.y = {pick(in_front, y.first, boxes.y.first), pick(in_front, y.last, boxes.y.last)};
  return boxes;
}

/// Buckets of distance, sixteen for each doubling of the near plane's distance.
GALACTIC_EVERYWHERE inline IntLanes bucketsOf(Lanes distance, float near) {
  const IntLanes bits = as<IntLanes>(greater(distance, spread(near)));
  const IntLanes bucket = (bits - spread(as<std::int32_t>(near))) >> 19;
  return lesser(greater(bucket, spread(0)), spread(static_cast<std::int32_t>(kBuckets) - 1));
}

}  // namespace
}  // namespace galactic::render
