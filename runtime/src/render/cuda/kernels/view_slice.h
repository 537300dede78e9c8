#pragma once
#include <cstdint>

#include "render/raster/placed_model.h"

// What the kernels of the `cuda` renderer share with the code that launches them: addresses on the
// device and plain numbers.
namespace galactic::render::cuda {

/// Threads of a block on a device. The images are the same for any multiple of 8.
inline constexpr std::uint32_t kBlockThreads = 128;
/// The kernels use so few registers that a multiprocessor can run at least this many blocks at
/// once.
inline constexpr std::uint32_t kBlocksAtOnce = 4;

/// A block of the last kernel writes a square of pixels with this edge.
inline constexpr std::uint32_t kResolveEdge = 16;

/// Same layout as RenderInstance.
struct DeviceInstance {
  std::uint32_t model;
  RigidTransform world_from_model;
};

/// Same layout as PosedModel.
struct DevicePosed {
  std::uint32_t model;
  Pose world_from_model;
};

/// Same layout as AttachedModel.
struct DeviceAttached {
  std::uint32_t model;
  std::uint32_t body;
  RigidTransform body_from_model;
};

/// A part of a list.
struct ListPart {
  std::uint32_t first, count;
};

/// A camera, and what it sees.
struct DeviceView {
  RigidTransform camera_from_world;
  /// See focalLength().
  float focal;
  /// The placed models: those of the three lists below, one list after the other.
  ListPart placed;
  ListPart instances, posed, attached;
  /// Semantic ids of the posed models; empty: those of their packs.
  ListPart posed_semantics;
  std::uint32_t first_body;
};

/// A cluster to draw on a pane.
struct WorkItem {
  std::uint32_t pane;
  /// Place in the order of the pane's clusters, nearest first.
  std::uint32_t rank;
};

/// Clusters of a pane are drawn in two passes; what the first pass drew hides clusters of the
/// second.
inline constexpr std::uint32_t kPasses = 2;

/// Counts that the device writes.
struct SliceCounts {
  std::uint32_t items[kPasses];
  std::uint32_t unused[2];
  std::uint64_t clusters_drawn;
  std::uint64_t triangles_drawn;
};

/// Views that are drawn together. Arrays "by pane" have the panes of the first view first.
struct ViewSlice {
  const ModelTables* models;
  const DeviceView* views;
  const DeviceInstance* instances;
  const DevicePosed* posed;
  const std::uint32_t* posed_semantics;
  const DeviceAttached* attached;
  /// world_from_body.
  const RigidTransform* bodies;
  /// Models that are not drawn have a null `model`.
  PlacedModel* placed;
  /// By pane: made on the device from the next two members. `task` is for a pane of the batch's
  /// first view: its models are the first placed ones, and its images begin at their first pixel.
  PaneTask* tasks;
  PaneTask task;
  const PaneRectangle* panes;
  /// By pane, plus one at the end: where its clusters begin in `seen`, `order` and `by_bucket`.
  const std::uint32_t* first_cluster;
  SeenCluster* seen;
  /// Indices into `seen`, relative to the pane's first, in the order of drawing.
  std::uint32_t* order;
  std::uint32_t* by_bucket;
  /// The items of all panes, by pass, in no particular order.
  WorkItem* items[kPasses];
  /// By pane: what is visible at each pixel, see seenAt(). The pixels are in blocks, as in the
  /// `soft` renderer.
  std::uint64_t* pixels;
  /// By pane: the least 1/w of each tile after the first pass.
  float* tile_depth;
  SliceCounts* counts;
  /// Number of the slice's first view within the batch.
  std::uint32_t first_view;
  std::uint32_t view_count;
  std::uint32_t panes_of_view;
  /// Room for each pane in `pixels` and `tile_depth`.
  std::uint32_t pixels_of_pane;
  std::uint32_t tiles_of_pane;
};

/// The parameters of a launch, passed by value.
struct PassParameters {
  ViewSlice slice;
  std::uint32_t pass;
};

/// The kernels, and their names in the module.
enum class Kernel : std::uint8_t { kPlace, kCull, kDraw, kTiles, kResolve };
inline constexpr std::uint32_t kKernels = 5;
inline constexpr const char* kKernelNames[kKernels] = {
    "galactic_place", "galactic_cull", "galactic_draw", "galactic_tiles", "galactic_resolve"};

/// Bits of a pixel for the rank of a cluster in its pane and for a piece of the cluster: a cluster
/// has up to 128 small triangles, 128 large ones, and 6 pieces of each of 128 triangles that are
/// cut.
inline constexpr std::uint32_t kRankBits = 22;
inline constexpr std::uint32_t kPieceBits = 10;

}  // namespace galactic::render::cuda
