#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "galactic/batch_renderer.h"
#include "render/gl/handles.h"
#include "render/gl/library_geometry.h"
#include "render/gl/programs.h"
#include "render/gl/targets.h"
#include "render/gl/view_lists.h"

namespace galactic::render::gl {

/// Settings that only tests and benchmarks choose.
struct GlTuning {
  /// Most views of a slice; 0: as many as suit the device.
  std::size_t most_views = 0;
  /// Whether to do without extensions that are not part of OpenGL 4.5.
  bool core_only = false;
  /// Whether to measure with timer queries.
  bool measure = false;
};

/// Where time went since the start, seconds; the last two are times of the graphics processor.
struct GlTimings {
  double setup = 0;
  double copy = 0;
  double draw = 0;
  double readback = 0;
};

/// The totals of the draw commands of one class, as the scan shader writes them.
struct DrawTotals {
  std::uint32_t draws = 0;
  std::uint32_t clusters = 0;
  std::uint32_t triangles = 0;
  std::uint32_t unused = 0;
};

/// A slice: views that share one set of draw commands. Each slice has buffers of its own, so that
/// the next slice can be prepared and drawn while this one is read.
struct ViewSlice {
  Buffer upload{Access::kWrite};
  Buffer readback{Access::kRead};
  std::array<Query, 3> times;
  GLsync fence = nullptr;
  std::size_t first_view = 0;
  std::size_t views = 0;
  /// Layout of the slice's images or, if they stay on the device, of the whole batch's.
  ImageLayout layout;
  bool stays = false;
  SliceCounts counts;
};

/// Draws slices of views on the current context, which must be the same for all calls, including
/// the destructor's.
class GlRenderer {
 public:
  /// Loads the library. Fails with kUnsupported if the driver's limits are too low for it.
  [[nodiscard]] static Result<std::unique_ptr<GlRenderer>> make(const RenderLibrary& library,
                                                                const RenderOptions& options,
                                                                const GlTuning& tuning);

  [[nodiscard]] std::size_t mostViews() const { return most_views_; }
  /// Starts to draw `views` and to read the images back. `slice` must be idle.
  void submit(std::span<const RenderView> views, ViewSlice& slice);
  /// Waits for a slice and copies its images to their place in `targets`. Throws an ErrorException
  /// if they were not drawn.
  void collect(ViewSlice& slice, const RenderTargets& targets);

  /// Makes room in deviceImages() for the images of `views` views that stay on the device. Fails
  /// with kUnsupported if they are too many for the driver.
  [[nodiscard]] Result<ImageLayout> reserveDeviceImages(std::size_t views);
  /// Whether reserveDeviceImages() would keep the buffer as it is.
  [[nodiscard]] bool hasRoomOnDevice(std::size_t views) const {
    return imageLayout(options_, views).bytes <= device_images_.size();
  }
  /// Starts to draw `views` into deviceImages(). `slice.first_view` must be a multiple of 4.
  void submitToDevice(std::span<const RenderView> views, const ImageLayout& layout,
                      ViewSlice& slice);
  /// Waits for a slice. Throws an ErrorException if it was not drawn.
  void finish(ViewSlice& slice);
  [[nodiscard]] const Buffer& deviceImages() const { return device_images_; }

  [[nodiscard]] const RenderStatistics& statistics() const { return statistics_; }
  void resetStatistics() { statistics_ = {}; }
  [[nodiscard]] const GlTimings& timings() const { return timings_; }

 private:
  explicit GlRenderer(const RenderOptions& options) : options_(options), targets_(options) {}
  [[nodiscard]] Result<void> load(const RenderLibrary& library, const GlTuning& tuning);
  void makeVertexArray(bool vertex_colors);
  void chooseSlices(const GlTuning& tuning);
  /// Lists what the views hold, and starts to copy the lists to the device.
  void upload(std::span<const RenderView> views, ViewSlice& slice);
  /// Writes draw commands for the clusters that are seen.
  void cull(const SliceCounts& counts);
  void draw(const SliceCounts& counts);
  /// Prepares and draws a slice whose layout is known.
  void start(std::span<const RenderView> views, ViewSlice& slice);
  void resolve(const ViewSlice& slice);
  void readBack(const ViewSlice& slice) const;
  /// The exception to throw if the driver has refused a part of drawing a slice.
  [[nodiscard]] ErrorException notDrawn(const ViewSlice& slice, GLenum error) const;

  RenderOptions options_;
  bool indirect_count_ = false;
  bool measures_ = false;
  std::size_t most_views_ = 1;
  Programs programs_;
  std::vector<Texture> textures_;
  std::vector<ModelClusters> models_;
  Buffer vertices_;
  Buffer indices_;
  Buffer bounds_;
  VertexArray vertex_array_;
  Targets targets_;
  Buffer instances_;
  Buffer chunks_;
  Buffer results_;
  Buffer draws_;
  Buffer totals_;
  Buffer images_;
  Buffer device_images_;
  std::size_t largest_block_ = 0;
  RenderStatistics statistics_;
  GlTimings timings_;
};

}  // namespace galactic::render::gl
