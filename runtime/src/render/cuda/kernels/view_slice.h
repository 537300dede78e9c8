#pragma once
#include <cstdint>

#include "render/raster/placed_model.h"

// What the kernels of the `cuda` renderer share with the processor that launches them: addresses on
// the device and plain numbers.
namespace galactic::render::cuda {

/// Of a block as it is launched on a device. The kernels give the same images for any multiple
/// of 8.
inline constexpr std::uint32_t kBlockThreads = 128;
/// Blocks that a multiprocessor has registers for, at least.
inline constexpr std::uint32_t kBlocksAtOnce = 4;

/// Edge of the squares of pixels that a block of the last kernel writes.
inline constexpr std::uint32_t kResolveEdge = 16;

/// As RenderInstance.
struct DeviceInstance {
  std::uint32_t model;
  RigidTransform world_from_model;
};

/// As PosedModel.
struct DevicePosed {
  std::uint32_t model;
  Pose world_from_model;
};

/// As AttachedModel.
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
  /// 1/256 pixels at a distance of 1 m for each meter beside the camera's axis.
  float focal;
  /// All of the three lists below.
  ListPart placed;
  ListPart instances, posed, attached;
  /// Of the posed models; none: they have those of their packs.
  ListPart posed_semantics;
  std::uint32_t first_body;
};

/// A cluster that is to be drawn on a pane.
struct WorkItem {
  std::uint32_t pane;
  /// Place in the order of the pane's clusters, nearest first.
  std::uint32_t rank;
};

/// Clusters of a pane are drawn in two passes; what the first drew hides clusters of the second.
inline constexpr std::uint32_t kPasses = 2;

/// Counted on the device.
struct SliceCounts {
  std::uint32_t items[kPasses];
  std::uint32_t unused[2];
  std::uint64_t clusters_drawn;
  std::uint64_t triangles_drawn;
};

/// Views that are drawn together. Arrays "by pane": first the panes of the first view.
struct ViewSlice {
  const ModelTables* models;
  const DeviceView* views;
  const DeviceInstance* instances;
  const DevicePosed* posed;
  const std::uint32_t* posed_semantics;
  const DeviceAttached* attached;
  /// world_from_body.
  const RigidTransform* bodies;
  /// No model where it is not drawn.
  PlacedModel* placed;
  /// By pane: made on the device of the next two. `task` is for a pane of the batch's first view:
  /// its models are the first ones that are placed, its images begin at their first pixel.
  PaneTask* tasks;
  PaneTask task;
  const PaneRectangle* panes;
  /// By pane, and one more: where its clusters begin in the four arrays below.
  const std::uint32_t* first_cluster;
  SeenCluster* seen;
  /// Numbers in `seen`, from the pane's first, in the order of drawing.
  std::uint32_t* order;
  std::uint32_t* by_bucket;
  /// Those of all panes, by pass, in no order.
  WorkItem* items[kPasses];
  /// By pane: what is seen at each pixel, see seenAt(). In blocks as the `soft` renderer has them.
  std::uint64_t* pixels;
  /// By pane: the least 1/w of each tile after the first pass.
  float* tile_depth;
  SliceCounts* counts;
  /// Of the slice's first view in the batch.
  std::uint32_t first_view;
  std::uint32_t view_count;
  std::uint32_t panes_of_view;
  /// Room for each pane in `pixels` and in `tile_depth`.
  std::uint32_t pixels_of_pane;
  std::uint32_t tiles_of_pane;
};

/// What launches pass by value.
struct PassParameters {
  ViewSlice slice;
  std::uint32_t pass;
};

/// The kernels, by the names they have in the module.
enum class Kernel : std::uint8_t { kPlace, kCull, kDraw, kTiles, kResolve };
inline constexpr std::uint32_t kKernels = 5;
inline constexpr const char* kKernelNames[kKernels] = {
    "galactic_place", "galactic_cull", "galactic_draw", "galactic_tiles", "galactic_resolve"};

/// Clusters that a pane can tell apart, and pieces of one cluster: 128 small triangles, 128 large
/// ones, and 6 of each of 128 that are cut.
inline constexpr std::uint32_t kRankBits = 22;
inline constexpr std::uint32_t kPieceBits = 10;

}  // namespace galactic::render::cuda
