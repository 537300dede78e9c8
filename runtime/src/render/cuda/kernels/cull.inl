// Places instances in front of their cameras, and lists the clusters of each pane that may be
// visible, nearest first.
namespace galactic::render::cuda {
namespace {

/// The task of pane `pane` of view `view` of a slice.
GALACTIC_EVERYWHERE inline PaneTask paneTask(const ViewSlice& slice, std::uint32_t view,
                                             std::uint32_t pane) {
  const DeviceView& from = slice.views[view];
  const PaneRectangle& place = slice.panes[pane];
  PaneTask task = slice.task;
  const std::size_t first_pixel =
      static_cast<std::size_t>(slice.first_view + view) * task.image_width * task.image_height;
  task.models += from.placed.first;
  task.model_count = from.placed.count;
  task.left = place.left;
  task.top = place.top;
  task.width = place.width;
  task.height = place.height;
  if (task.color != nullptr) task.color += first_pixel * task.channels;
  if (task.depth != nullptr) task.depth += first_pixel;
  if (task.semantics != nullptr) task.semantics += first_pixel;
  return task;
}

/// Model `number` of a view, in the order of forModels().
struct ShownModel {
  DeviceInstance instance;
  std::uint32_t semantic;
};

GALACTIC_EVERYWHERE inline ShownModel shownAs(const ViewSlice& slice, const DeviceView& view,
                                              std::uint32_t number) {
  if (number < view.instances.count) {
    return {slice.instances[view.instances.first + number], kSemanticsOfPack};
  }
  number -= view.instances.count;
  if (number < view.posed.count) {
    const DevicePosed& posed = slice.posed[view.posed.first + number];
    return {{posed.model, rigidTransform(posed.world_from_model)},
            view.posed_semantics.count == 0
                ? kSemanticsOfPack
                : slice.posed_semantics[view.posed_semantics.first + number]};
  }
  number -= view.posed.count;
  const DeviceAttached& attached = slice.attached[view.attached.first + number];
  return {
      {attached.model, slice.bodies[view.first_body + attached.body] * attached.body_from_model},
      kSemanticsOfPack};
}

/// Places the models of the block's view and makes the tasks of its panes. Each block has one view.
GALACTIC_EVERYWHERE inline void placeInstances(const Block& block, const ViewSlice& slice) {
  const DeviceView& view = slice.views[block.index];
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n < slice.panes_of_view; n += block.threads) {
      slice.tasks[block.index * slice.panes_of_view + n] = paneTask(slice, block.index, n);
    }
    for (std::uint32_t n = thread; n < view.placed.count; n += block.threads) {
      const ShownModel shown = shownAs(slice, view, n);
      PlacedModel& placed = slice.placed[view.placed.first + n];
      const ModelTables& model = slice.models[shown.instance.model];
      placed.model = nullptr;
      placed.semantic = shown.semantic;
      if (model.cluster_count != 0 &&
          placeModel(view.camera_from_world, view.focal, shown.instance.world_from_model, placed)) {
        placed.model = &model;
      }
    }
  });
}

/// Models that are culled together.
constexpr std::uint32_t kModelsAtOnce = 32;

struct CullShared {
  CullFrame frames[kModelsAtOnce];
  /// How many clusters the models have, 0 for models that cannot be visible, and the clusters of
  /// the models before them.
  std::uint32_t clusters[kModelsAtOnce];
  std::uint32_t starts[kModelsAtOnce + 1];
  std::uint32_t in_bucket[kBuckets];
  std::uint32_t bucket_starts[kBuckets + 1];
  std::uint32_t placed[kBuckets];
  std::uint32_t seen;
  std::uint32_t first_item[kPasses];
};

/// The lists of a pane.
struct PaneLists {
  const PaneTask* task;
  SeenCluster* seen;
  std::uint32_t* order;
  std::uint32_t* by_bucket;
};

GALACTIC_EVERYWHERE inline PaneLists paneLists(const ViewSlice& slice, std::uint32_t pane) {
  const std::size_t first = slice.first_cluster[pane];
  return {slice.tasks + pane, slice.seen + first, slice.order + first, slice.by_bucket + first};
}

/// Prepares the models from `first` on: computes what culling needs of them, and counts their
/// clusters.
GALACTIC_EVERYWHERE inline void frameModels(const Block& block, const PaneTask& task,
                                            std::uint32_t first, CullShared& shared) {
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n < kModelsAtOnce; n += block.threads) {
      shared.clusters[n] = 0;
      if (first + n >= task.model_count) continue;
      const PlacedModel& placed = task.models[first + n];
      if (placed.model == nullptr) continue;
      shared.frames[n] = makeFrame(task, placed);
      if (task.culling && !mayShow(shared.frames[n], *placed.model)) continue;
      shared.clusters[n] = placed.model->cluster_count;
    }
  });
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n <= kModelsAtOnce; n += block.threads) {
      std::uint32_t before = 0;
      for (std::uint32_t m = 0; m < n; ++m) before += shared.clusters[m];
      shared.starts[n] = before;
    }
  });
}

/// The model that has cluster `at`: the last one that starts at or before it.
GALACTIC_EVERYWHERE inline std::uint32_t modelAt(const std::uint32_t* starts, std::uint32_t at) {
  std::uint32_t low = 0;
  std::uint32_t high = kModelsAtOnce;
  while (high - low > 1) {
    const std::uint32_t middle = (low + high) / 2;
    (starts[middle] <= at ? low : high) = middle;
  }
  return low;
}

GALACTIC_EVERYWHERE inline void noteCluster(const BoxesSeen& one, const PaneTask& task,
                                            SeenCluster entry, const PaneLists& lists,
                                            CullShared& shared) {
  constexpr auto kEdge = static_cast<std::int32_t>(kTileEdge);
  entry.nearest = one.nearest[0];
  entry.bucket = static_cast<std::uint32_t>(bucketsOf(one.distance, task.near)[0]);
  entry.tiles[0] = static_cast<std::uint8_t>(one.x.first[0] / kEdge);
  entry.tiles[1] = static_cast<std::uint8_t>(one.x.last[0] / kEdge);
  entry.tiles[2] = static_cast<std::uint8_t>(one.y.first[0] / kEdge);
  entry.tiles[3] = static_cast<std::uint8_t>(one.y.last[0] / kEdge);
  addAtomically(shared.in_bucket + entry.bucket, 1U);
  lists.seen[addAtomically(&shared.seen, 1U)] = entry;
}

/// Lists the clusters of the prepared models that may be visible, in no particular order.
GALACTIC_EVERYWHERE inline void lookAtClusters(const Block& block, const PaneLists& lists,
                                               std::uint32_t first, CullShared& shared) {
  const PaneTask& task = *lists.task;
  block.each([&](std::uint32_t thread) {
    const std::uint32_t count = shared.starts[kModelsAtOnce];
    for (std::uint32_t at = thread; at < count; at += block.threads) {
      const std::uint32_t n = modelAt(shared.starts, at);
      const std::uint32_t cluster = at - shared.starts[n];
      const ModelTables& model = *task.models[first + n].model;
      const float* bounds =
          model.pack->cluster_bounds +
          (static_cast<std::size_t>(model.first_block) + cluster / kWidth) * kBoundsRows * kWidth +
          cluster % kWidth;
      const BoxesSeen one = lookAt(task, shared.frames[n], loadBoxes(bounds));
      if (one.seen == 0) continue;
      SeenCluster entry;
      entry.model = first + n;
      entry.cluster = cluster;
      noteCluster(one, task, entry, lists, shared);
    }
  });
}

GALACTIC_EVERYWHERE inline bool comesBefore(const SeenCluster& a, const SeenCluster& b) {
  return a.model != b.model ? a.model < b.model : a.cluster < b.cluster;
}

/// Sorts clusters in the order in which the `soft` renderer draws them: by bucket, then by model
/// and cluster.
GALACTIC_EVERYWHERE inline void sortSeen(const Block& block, const PaneLists& lists,
                                         CullShared& shared) {
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t b = thread; b <= kBuckets; b += block.threads) {
      std::uint32_t before = 0;
      for (std::uint32_t n = 0; n < b; ++n) before += shared.in_bucket[n];
      shared.bucket_starts[b] = before;
      if (b < kBuckets) shared.placed[b] = before;
    }
  });
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n < shared.seen; n += block.threads) {
      lists.by_bucket[addAtomically(shared.placed + lists.seen[n].bucket, 1U)] = n;
    }
  });
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n < shared.seen; n += block.threads) {
      const SeenCluster own = lists.seen[n];
      std::uint32_t rank = shared.bucket_starts[own.bucket];
      for (std::uint32_t m = rank; m < shared.bucket_starts[own.bucket + 1]; ++m) {
        if (comesBefore(lists.seen[lists.by_bucket[m]], own)) ++rank;
      }
      lists.order[rank] = n;
    }
  });
}

/// How many of a pane's clusters are drawn in the first pass: the nearest ones, which hide many of
/// the others.
GALACTIC_EVERYWHERE inline std::uint32_t inFirstPass(std::uint32_t seen) { return (seen + 3) / 4; }

/// Adds the pane's clusters to the work items of all panes.
GALACTIC_EVERYWHERE inline void addItems(const Block& block, const ViewSlice& slice,
                                         CullShared& shared) {
  block.each([&](std::uint32_t thread) {
    if (thread != 0) return;
    const std::uint32_t near = inFirstPass(shared.seen);
    shared.first_item[0] = addAtomically(slice.counts->items, near);
    shared.first_item[1] = addAtomically(slice.counts->items + 1, shared.seen - near);
  });
  block.each([&](std::uint32_t thread) {
    const std::uint32_t near = inFirstPass(shared.seen);
    for (std::uint32_t n = thread; n < shared.seen; n += block.threads) {
      const std::uint32_t pass = n < near ? 0 : 1;
      slice.items[pass][shared.first_item[pass] + n - pass * near] = {block.index, n};
    }
  });
}

/// Lists the clusters that may be visible on the block's pane. Each block has one pane.
GALACTIC_EVERYWHERE inline void cullPane(const Block& block, CullShared& shared,
                                         const ViewSlice& slice) {
  const PaneLists lists = paneLists(slice, block.index);
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t b = thread; b < kBuckets; b += block.threads) shared.in_bucket[b] = 0;
    if (thread == 0) shared.seen = 0;
  });
  for (std::uint32_t first = 0; first < lists.task->model_count; first += kModelsAtOnce) {
    frameModels(block, *lists.task, first, shared);
    lookAtClusters(block, lists, first, shared);
  }
  sortSeen(block, lists, shared);
  addItems(block, slice, shared);
}

}  // namespace
}  // namespace galactic::render::cuda
