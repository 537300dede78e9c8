// Lists the clusters of a pane that may be visible, front to back.
namespace galactic::render {
namespace {

inline void noteClusters(const BoxesSeen& boxes, IntLanes buckets, SeenCluster first,
                         SeenCluster*& end) {
  for (unsigned left = boxes.seen; left != 0; left &= left - 1) {
    const int n = __builtin_ctz(left);
    SeenCluster& seen = *end++;
    seen = first;
    seen.cluster += static_cast<std::uint32_t>(n);
    seen.nearest = boxes.nearest[n];
    seen.bucket = static_cast<std::uint32_t>(buckets[n]);
    constexpr auto kEdge = static_cast<std::int32_t>(kTileEdge);
    seen.tiles[0] = static_cast<std::uint8_t>(boxes.x.first[n] / kEdge);
    seen.tiles[1] = static_cast<std::uint8_t>(boxes.x.last[n] / kEdge);
    seen.tiles[2] = static_cast<std::uint8_t>(boxes.y.first[n] / kEdge);
    seen.tiles[3] = static_cast<std::uint8_t>(boxes.y.last[n] / kEdge);
  }
}

/// Fills scratch.seen; returns how many there are.
std::uint32_t findClusters(const PaneTask& task, const PaneScratch& scratch, PaneCounts& counts) {
  SeenCluster* end = scratch.seen;
  for (std::uint32_t m = 0; m < task.model_count; ++m) {
    const PlacedModel& placed = task.models[m];
    const ModelTables& model = *placed.model;
    counts.clusters += model.cluster_count;
    const CullFrame frame = makeFrame(task, placed);
    if (task.culling && !mayShow(frame, model)) continue;
    const float* bounds = model.pack->cluster_bounds +
                          static_cast<std::size_t>(model.first_block) * kBoundsRows * kWidth;
    for (std::uint32_t c = 0; c < model.cluster_count; c += kLanes) {
      const std::size_t next = c + kWidth < model.cluster_count ? kBoundsRows * kWidth : 0;
      BoxesSeen boxes = lookAt(task, frame, loadBoxes(bounds, next));
      bounds += kBoundsRows * kLanes;
      boxes.seen &= firstLanes(model.cluster_count - c);
      if (boxes.seen == 0) continue;
      noteClusters(boxes, bucketsOf(boxes.distance, task.near), {.model = m, .cluster = c}, end);
    }
  }
  return static_cast<std::uint32_t>(end - scratch.seen);
}

/// Fills scratch.order: by bucket, and within a bucket as found, which is by model, then cluster.
void sortClusters(const PaneScratch& scratch, std::uint32_t count) {
  std::uint32_t* starts = scratch.bucket_starts;
  __builtin_memset(starts, 0, (kBuckets + 1) * sizeof(*starts));
  for (std::uint32_t n = 0; n < count; ++n) ++starts[scratch.seen[n].bucket + 1];
  for (std::uint32_t b = 0; b < kBuckets; ++b) starts[b + 1] += starts[b];
  for (std::uint32_t n = 0; n < count; ++n) scratch.order[starts[scratch.seen[n].bucket]++] = n;
}

}  // namespace
}  // namespace galactic::render
