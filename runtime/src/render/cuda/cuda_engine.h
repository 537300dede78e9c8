#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/cuda/device_scene.h"
#include "render/cuda/driver.h"
#include "render/cuda/kernels/view_slice.h"
#include "render/render_engine.h"

namespace galactic::render::cuda {

/// Settings that only tests choose.
struct CudaTuning {
  /// The library of the driver.
  std::string library = "libcuda.so.1";
  /// Views are drawn together while their lists and pixels need no more memory than this; a view
  /// that needs more is drawn by itself.
  std::size_t slice_bytes = std::size_t{1} << 30U;
  /// Wait for each kernel, so that CudaTimings can say how long it took.
  bool measure = false;
};

/// Where time went since the engine was made, seconds; all but `setup` need CudaTuning::measure.
struct CudaTimings {
  /// Time of the processor for lists and poses.
  double setup = 0;
  /// By kernel; clearing pixels counts as part of the first.
  std::array<double, kKernels> kernels{};
  /// Copying images to the processor.
  double readback = 0;
};

/// The compiled kernels on a device, whose context must be current during all calls.
class Kernels {
 public:
  [[nodiscard]] static Result<Kernels> load(const Driver& driver);
  Kernels(Kernels&& other) noexcept;
  Kernels& operator=(Kernels&&) = delete;
  ~Kernels();

  [[nodiscard]] Result<void> launch(Kernel kernel, std::uint32_t blocks,
                                    const PassParameters& parameters, void* stream) const;

 private:
  explicit Kernels(const Driver& driver) : driver_(&driver) {}

  const Driver* driver_;
  void* module_ = nullptr;
  std::array<void*, kKernels> functions_{};
};

/// Draws on a CUDA device. The images are those of the `soft` renderer, bit for bit.
class CudaEngine final : public RenderEngine {
 public:
  /// Like makeCudaEngine(), with the settings that only tests choose.
  [[nodiscard]] static Result<std::unique_ptr<CudaEngine>> make(const RenderLibrary& library,
                                                                const RenderOptions& options,
                                                                const CudaTuning& tuning);
  ~CudaEngine() override;
  CudaEngine(const CudaEngine&) = delete;
  CudaEngine& operator=(const CudaEngine&) = delete;

  /// Both throw ErrorException if the driver fails, since the images would be wrong. The next batch
  /// starts afresh.
  void begin(std::span<const RenderView> views, const RenderTargets& targets) override;
  void end() override;
  [[nodiscard]] Result<DeviceImages> renderToDevice(std::span<const RenderView> views,
                                                    std::uintptr_t stream) override;
  [[nodiscard]] RenderBackend backend() const override { return RenderBackend::kCuda; }
  [[nodiscard]] std::string description() const override;
  [[nodiscard]] RenderStatistics statistics() const override { return statistics_; }
  [[nodiscard]] const Device& device() const { return device_; }
  /// How many slices the last batch was cut into.
  [[nodiscard]] std::size_t sliceCount() const { return slices_.size(); }
  [[nodiscard]] const CudaTimings& timings() const { return timings_; }

 private:
  /// Views [first, end) of the batch, and how many clusters their lists have room for.
  struct ViewRange {
    std::size_t first, end;
    std::size_t clusters;
  };
  /// Where each array lies in `staged_` and in its copy on the device.
  struct Upload {
    std::size_t views, instances, posed, posed_semantics, attached, bodies, panes, first_clusters,
        bytes;
  };
  /// Room for one slice on the device.
  struct SliceMemory {
    explicit SliceMemory(const Driver& driver);
    Memory tasks, seen, order, by_bucket, near_items, far_items, pixels, tile_depth;
  };

  CudaEngine(const RenderOptions& options, std::unique_ptr<Driver> driver, Device device);

  Result<void> draw(std::span<const RenderView> views);
  /// Writes the lists into `staged_`, from where they are copied, and counts clusters.
  Result<void> stage(std::span<const RenderView> views, const Upload& at);
  /// Cuts the batch into slices.
  void cutSlices(const Upload& at);
  [[nodiscard]] std::size_t bytesOf(std::size_t views, std::size_t clusters) const;
  /// Makes room on the device.
  Result<void> reserve(std::size_t views);
  /// The task of the batch's first pane.
  [[nodiscard]] PaneTask firstTask() const;
  /// Launches a kernel, and waits for it if that is measured.
  Result<void> launch(Kernel kernel, std::uint32_t blocks, const PassParameters& parameters);
  Result<void> drawSlice(const ViewRange& range, std::size_t number, const Upload& at);
  [[nodiscard]] ViewSlice sliceOf(const ViewRange& range, std::size_t number,
                                  const Upload& at) const;
  Result<void> readCounts();
  Result<void> readImages();
  /// Waits for the kernels of a batch that failed, because the next batch uses the same memory.
  void abandon();
  [[noreturn]] void giveUp(const Error& error);

  RenderOptions options_;
  CudaTuning tuning_;
  std::unique_ptr<Driver> driver_;
  Device device_;
  std::unique_ptr<Kernels> kernels_;
  std::unique_ptr<DeviceScene> scene_;

  /// The panes of an image.
  std::vector<PaneRectangle> panes_;
  std::uint32_t pixels_of_pane_;
  std::uint32_t tiles_of_pane_;

  Memory staged_, uploaded_, placed_, counts_;
  Memory color_, depth_, semantics_;
  std::unique_ptr<SliceMemory> slice_memory_;
  std::vector<ViewRange> slices_;
  /// Whether a batch may still be running, since end() could not wait for it: the device refused
  /// its context.
  bool is_under_way_ = false;
  std::vector<std::uint32_t> clusters_of_views_;
  std::vector<SliceCounts> read_counts_;
  RenderTargets targets_;
  /// The stream of all launches; null: the default stream.
  void* stream_ = nullptr;
  RenderStatistics statistics_;
  CudaTimings timings_;
};

}  // namespace galactic::render::cuda
