#include "render/cuda/cuda_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "render/cuda/kernel_image.h"
#include "support/threads/stopwatch.h"
#include "support/threads/thread_clock.h"
#include "support/try.h"

namespace galactic::render::cuda {
namespace {

static_assert(sizeof(DeviceInstance) == sizeof(RenderInstance) &&
                  offsetof(DeviceInstance, world_from_model) ==
                      offsetof(RenderInstance, world_from_model),
              "instances are copied as they are");

/// Blocks per multiprocessor, for kernels whose blocks take work until none is left.
constexpr std::uint32_t kBlocksPerMultiprocessor = 16;
/// The most clusters of a pane, limited by the bits of a pixel for them.
constexpr std::size_t kMostClusters = std::size_t{1} << kRankBits;
/// Alignment of arrays that are copied together.
constexpr std::size_t kAlignment = 256;

constexpr std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

template <class T>
T* at(DeviceAddress address) {
  return std::bit_cast<T*>(address);
}

template <class T>
T* at(const Memory& memory, std::size_t offset = 0) {
  return at<T>(memory.address() + offset);
}

/// Copies past the caches, since only the device reads the copy.
void copyPast(void* to, const void* from, std::size_t bytes) {
#if defined(__SSE2__)
  auto* target = static_cast<std::byte*>(to);
  const auto* source = static_cast<const std::byte*>(from);
  constexpr std::size_t kVector = sizeof(__m128i);
  const std::size_t until_aligned =
      std::min(bytes, (kVector - std::bit_cast<std::uintptr_t>(target) % kVector) % kVector);
  std::memcpy(target, source, until_aligned);
  std::size_t at = until_aligned;
  for (; at + kVector <= bytes; at += kVector) {
    _mm_stream_si128(reinterpret_cast<__m128i*>(target + at),
                     _mm_loadu_si128(reinterpret_cast<const __m128i*>(source + at)));
  }
  std::memcpy(target + at, source + at, bytes - at);
#else
  std::memcpy(to, from, bytes);
#endif
}

/// The elements of lists for the device, written one list after the other.
template <class Element>
class StagedList {
 public:
  explicit StagedList(std::byte* to) : to_(reinterpret_cast<Element*>(to)) {}

  template <class Source>
  ListPart add(std::span<const Source> list) {
    static_assert(sizeof(Source) == sizeof(Element));
    const ListPart part{next_, static_cast<std::uint32_t>(list.size())};
    if (!list.empty()) copyPast(to_ + next_, list.data(), list.size_bytes());
    next_ += part.count;
    return part;
  }

 private:
  Element* to_;
  std::uint32_t next_ = 0;
};

bool isSame(std::span<const AttachedModel> a, std::span<const AttachedModel> b) {
  return a.data() == b.data() && a.size() == b.size();
}

/// How many elements the lists of all views have. If successive views have the same attached list,
/// its elements count once.
struct ListSizes {
  std::size_t instances = 0;
  std::size_t posed = 0;
  std::size_t posed_semantics = 0;
  std::size_t attached = 0;
  std::size_t bodies = 0;
  /// All models that are placed in front of cameras.
  std::size_t models = 0;
};

ListSizes listSizes(std::span<const RenderView> views) {
  ListSizes sizes;
  std::span<const AttachedModel> last;
  for (const RenderView& view : views) {
    sizes.instances += view.instances.size();
    sizes.posed += view.posed.size();
    sizes.posed_semantics += view.posed_semantics.size();
    sizes.bodies += view.bodies.size();
    sizes.models += modelCount(view);
    if (isSame(view.attached, last)) continue;
    last = view.attached;
    sizes.attached += view.attached.size();
  }
  return sizes;
}

/// Adds the processor time of this thread, in seconds.
class ThreadStopwatch {
 public:
  explicit ThreadStopwatch(double& sum) : sum_(sum) {}
  ~ThreadStopwatch() { sum_ += detail::threadSeconds() - start_; }
  ThreadStopwatch(const ThreadStopwatch&) = delete;
  ThreadStopwatch& operator=(const ThreadStopwatch&) = delete;

 private:
  double& sum_;
  double start_ = detail::threadSeconds();
};

/// Sets the stream of all launches for a scope.
class UsedStream {
 public:
  UsedStream(void*& used, void* stream) : used_(used) { used_ = stream; }
  ~UsedStream() { used_ = nullptr; }
  UsedStream(const UsedStream&) = delete;
  UsedStream& operator=(const UsedStream&) = delete;

 private:
  void*& used_;
};

}  // namespace

Result<Kernels> Kernels::load(const Driver& driver) {
  const char* image = kernelImage();
  if (image == nullptr) {
    return fail(ErrorCode::kUnsupported, "render backend cuda",
                "this program was built without the cuda backend's kernels; install clang-14 or "
                "nvcc, which compile them, and build it again, or use another backend");
  }
  constexpr std::size_t kLogBytes = 4096;
  // Options of the driver's compiler, as cuda.h numbers them.
  constexpr int kErrorLog = 5;
  constexpr int kErrorLogBytes = 6;
  std::string log(kLogBytes, '\0');
  std::array<int, 2> options{kErrorLog, kErrorLogBytes};
  std::array<void*, 2> values{log.data(), std::bit_cast<void*>(kLogBytes)};
  Kernels kernels(driver);
  const DriverFunctions& functions = driver.functions();
  const int error =
      functions.load_module(&kernels.module_, image, options.size(), options.data(), values.data());
  if (error != 0) {
    return tl::unexpected<Error>(
        driver.failure(error, fmt::format("compile the kernels: {}", log.c_str())));
  }
  for (std::size_t n = 0; n < kKernels; ++n) {
    RETURN_IF_ERROR(
        driver.check(functions.function(&kernels.functions_[n], kernels.module_, kKernelNames[n]),
                     "find a kernel"));
  }
  return kernels;
}

Kernels::Kernels(Kernels&& other) noexcept
    : driver_(other.driver_),
      module_(std::exchange(other.module_, nullptr)),
      functions_(other.functions_) {}

Kernels::~Kernels() {
  if (module_ != nullptr) driver_->functions().unload_module(module_);
}

Result<void> Kernels::launch(Kernel kernel, std::uint32_t blocks, const PassParameters& parameters,
                             void* stream) const {
  PassParameters copy = parameters;
  std::array<void*, 1> pointers{&copy};
  return driver_->check(
      driver_->functions().launch(functions_[static_cast<std::size_t>(kernel)], blocks, 1, 1,
                                  kBlockThreads, 1, 1, 0, stream, pointers.data(), nullptr),
      "launch a kernel");
}

CudaEngine::SliceMemory::SliceMemory(const Driver& driver)
    : tasks(driver, Memory::Kind::kDevice),
      seen(driver, Memory::Kind::kDevice),
      order(driver, Memory::Kind::kDevice),
      by_bucket(driver, Memory::Kind::kDevice),
      near_items(driver, Memory::Kind::kDevice),
      far_items(driver, Memory::Kind::kDevice),
      pixels(driver, Memory::Kind::kDevice),
      tile_depth(driver, Memory::Kind::kDevice) {}

CudaEngine::CudaEngine(const RenderOptions& options, std::unique_ptr<Driver> driver, Device device)
    : options_(options),
      driver_(std::move(driver)),
      device_(std::move(device)),
      panes_(cutIntoPanes(options.width, options.height)),
      pixels_of_pane_(paneEdge(options.width) * paneEdge(options.height)),
      tiles_of_pane_(pixels_of_pane_ / (kTileEdge * kTileEdge)),
      staged_(*driver_, Memory::Kind::kHost),
      uploaded_(*driver_, Memory::Kind::kDevice),
      placed_(*driver_, Memory::Kind::kDevice),
      counts_(*driver_, Memory::Kind::kDevice),
      color_(*driver_, Memory::Kind::kDevice),
      depth_(*driver_, Memory::Kind::kDevice),
      semantics_(*driver_, Memory::Kind::kDevice),
      slice_memory_(std::make_unique<SliceMemory>(*driver_)) {}

Result<std::unique_ptr<CudaEngine>> CudaEngine::make(const RenderLibrary& library,
                                                     const RenderOptions& options,
                                                     const CudaTuning& tuning) {
  ASSIGN_OR_RETURN(std::unique_ptr<Driver> driver, Driver::open(tuning.library));
  ASSIGN_OR_RETURN(Device device, Device::choose(*driver, options.device));
  RETURN_IF_ERROR(device.open());
  std::unique_ptr<CudaEngine> engine(new CudaEngine(options, std::move(driver), std::move(device)));
  engine->tuning_ = tuning;
  const CurrentDevice current(*engine->driver_, engine->device_);
  if (!current.holds()) return tl::unexpected<Error>(current.failure());
  ASSIGN_OR_RETURN(Kernels kernels, Kernels::load(*engine->driver_));
  engine->kernels_ = std::make_unique<Kernels>(std::move(kernels));
  ASSIGN_OR_RETURN(DeviceScene scene, DeviceScene::upload(library, *engine->driver_));
  engine->scene_ = std::make_unique<DeviceScene>(std::move(scene));
  return engine;
}

CudaEngine::~CudaEngine() {
  const CurrentDevice current(*driver_, device_);
  if (current.holds()) driver_->functions().synchronize(nullptr);
  kernels_.reset();
  scene_.reset();
  slice_memory_.reset();
  for (Memory* memory : {&staged_, &uploaded_, &placed_, &counts_, &color_, &depth_, &semantics_}) {
    memory->free();
  }
}

std::string CudaEngine::description() const {
  return fmt::format("cuda, {}, compute capability {}.{}", device_.name(), device_.major(),
                     device_.minor());
}

std::size_t CudaEngine::bytesOf(std::size_t views, std::size_t clusters) const {
  constexpr std::size_t kOfCluster =
      sizeof(SeenCluster) + 2 * sizeof(std::uint32_t) + kPasses * sizeof(WorkItem);
  const std::size_t of_pane =
      sizeof(PaneTask) + pixels_of_pane_ * sizeof(std::uint64_t) + tiles_of_pane_ * sizeof(float);
  return panes_.size() * (views * of_pane + clusters * kOfCluster);
}

Result<void> CudaEngine::stage(std::span<const RenderView> views, const Upload& at_bytes) {
  std::byte* bytes = staged_.bytes();
  auto* device_views = reinterpret_cast<DeviceView*>(bytes + at_bytes.views);
  StagedList<DeviceInstance> instances(bytes + at_bytes.instances);
  StagedList<DevicePosed> posed(bytes + at_bytes.posed);
  StagedList<std::uint32_t> posed_semantics(bytes + at_bytes.posed_semantics);
  StagedList<DeviceAttached> attached(bytes + at_bytes.attached);
  StagedList<RigidTransform> bodies(bytes + at_bytes.bodies);
  std::memcpy(bytes + at_bytes.panes, panes_.data(), panes_.size() * sizeof(PaneRectangle));
  clusters_of_views_.resize(views.size());
  const std::uint32_t* counts = scene_->clusterCounts().data();
  const auto clusters_in = [&](const auto& models) {
    std::size_t clusters = 0;
    for (const auto& model : models) clusters += counts[model.model];
    return clusters;
  };
  std::uint32_t first_placed = 0;
  float field_of_view = 0;
  float focal = 0;
  std::span<const AttachedModel> last_attached;
  ListPart attached_part{};
  std::size_t attached_clusters = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const RenderView& view = views[v];
    if (!isSame(view.attached, last_attached)) {
      last_attached = view.attached;
      attached_part = attached.add(view.attached);
      attached_clusters = clusters_in(view.attached);
    }
    const std::size_t clusters =
        clusters_in(view.instances) + clusters_in(view.posed) + attached_clusters;
    statistics_.clusters += clusters;
    if (clusters > kMostClusters) {
      return fail(
          ErrorCode::kUnsupported, "render backend cuda",
          fmt::format("found a view of {} clusters, expected at most {}; use the soft backend",
                      clusters, kMostClusters));
    }
    if (!canSee(view.camera)) {
      clusters_of_views_[v] = 0;
      device_views[v] = {};
      continue;
    }
    clusters_of_views_[v] = static_cast<std::uint32_t>(clusters);
    // Most cameras of a batch have the same field of view.
    if (view.camera.vertical_fov != field_of_view) {
      field_of_view = view.camera.vertical_fov;
      focal = focalLength(options_, view.camera);
    }
    const ListPart placed{first_placed, static_cast<std::uint32_t>(modelCount(view))};
    first_placed += placed.count;
    device_views[v] = {inverse(view.camera.world_from_camera),
                       focal,
                       placed,
                       instances.add(view.instances),
                       posed.add(view.posed),
                       attached_part,
                       posed_semantics.add(view.posed_semantics),
                       bodies.add(view.bodies).first};
  }
  return {};
}

void CudaEngine::cutSlices(const Upload& at_bytes) {
  auto* first_clusters =
      reinterpret_cast<std::uint32_t*>(staged_.bytes() + at_bytes.first_clusters);
  slices_.clear();
  ViewRange range{};
  for (std::size_t v = 0; v < clusters_of_views_.size(); ++v) {
    const std::size_t clusters = clusters_of_views_[v];
    const bool fits =
        bytesOf(v + 1 - range.first, range.clusters + clusters) <= tuning_.slice_bytes;
    if (!fits && v > range.first) {
      slices_.push_back(range);
      range = {v, v, 0};
    }
    for (std::size_t pane = 0; pane < panes_.size(); ++pane) {
      *first_clusters++ =
          static_cast<std::uint32_t>(range.clusters * panes_.size() + pane * clusters);
    }
    range.clusters += clusters;
    range.end = v + 1;
  }
  slices_.push_back(range);
}

Result<void> CudaEngine::reserve(std::size_t views) {
  std::size_t most_clusters = 0;
  std::size_t most_views = 0;
  for (const ViewRange& range : slices_) {
    most_clusters = std::max(most_clusters, range.clusters);
    most_views = std::max(most_views, range.end - range.first);
  }
  const std::size_t clusters = most_clusters * panes_.size();
  const std::size_t panes = most_views * panes_.size();
  SliceMemory& slice = *slice_memory_;
  RETURN_IF_ERROR(slice.tasks.reserve(panes * sizeof(PaneTask)));
  RETURN_IF_ERROR(slice.seen.reserve(clusters * sizeof(SeenCluster)));
  RETURN_IF_ERROR(slice.order.reserve(clusters * sizeof(std::uint32_t)));
  RETURN_IF_ERROR(slice.by_bucket.reserve(clusters * sizeof(std::uint32_t)));
  RETURN_IF_ERROR(slice.near_items.reserve(clusters * sizeof(WorkItem)));
  RETURN_IF_ERROR(slice.far_items.reserve(clusters * sizeof(WorkItem)));
  RETURN_IF_ERROR(slice.pixels.reserve(panes * pixels_of_pane_ * sizeof(std::uint64_t)));
  RETURN_IF_ERROR(slice.tile_depth.reserve(panes * tiles_of_pane_ * sizeof(float)));
  RETURN_IF_ERROR(counts_.reserve(slices_.size() * sizeof(SliceCounts)));
  const std::size_t pixels = views * options_.width * options_.height;
  RETURN_IF_ERROR(color_.reserve(pixels * static_cast<std::size_t>(options_.color)));
  if (options_.depth) RETURN_IF_ERROR(depth_.reserve(pixels * sizeof(float)));
  if (options_.semantics) RETURN_IF_ERROR(semantics_.reserve(pixels * sizeof(std::uint32_t)));
  return {};
}

PaneTask CudaEngine::firstTask() const {
  PaneTask task;
  task.models = at<PlacedModel>(placed_);
  task.texel_bases = at<const std::uint32_t* const>(scene_->texelBases());
  task.image_width = options_.width;
  task.image_height = options_.height;
  task.near = options_.near;
  task.background = options_.background;
  task.culling = options_.culling;
  task.channels = static_cast<std::uint32_t>(options_.color);
  if (task.channels != 0) task.color = at<std::uint8_t>(color_);
  if (options_.depth) task.depth = at<float>(depth_);
  if (options_.semantics) task.semantics = at<std::uint32_t>(semantics_);
  return task;
}

Result<void> CudaEngine::draw(std::span<const RenderView> views) {
  const DriverFunctions& functions = driver_->functions();
  statistics_ = {};
  slices_.clear();
  // A batch that is still under way reads what this one is about to overwrite.
  if (std::exchange(is_under_way_, false)) functions.synchronize(nullptr);
  if (views.empty()) return {};
  const ListSizes sizes = listSizes(views);
  statistics_.instances = sizes.models;
  const std::size_t panes = views.size() * panes_.size();
  Upload at_bytes{};
  at_bytes.instances = aligned(views.size() * sizeof(DeviceView));
  at_bytes.posed = aligned(at_bytes.instances + sizes.instances * sizeof(DeviceInstance));
  at_bytes.posed_semantics = aligned(at_bytes.posed + sizes.posed * sizeof(DevicePosed));
  at_bytes.attached =
      aligned(at_bytes.posed_semantics + sizes.posed_semantics * sizeof(std::uint32_t));
  at_bytes.bodies = aligned(at_bytes.attached + sizes.attached * sizeof(DeviceAttached));
  at_bytes.panes = aligned(at_bytes.bodies + sizes.bodies * sizeof(RigidTransform));
  at_bytes.first_clusters = aligned(at_bytes.panes + panes_.size() * sizeof(PaneRectangle));
  at_bytes.bytes = at_bytes.first_clusters + panes * sizeof(std::uint32_t);
  RETURN_IF_ERROR(staged_.reserve(at_bytes.bytes));
  RETURN_IF_ERROR(uploaded_.reserve(at_bytes.bytes));
  RETURN_IF_ERROR(placed_.reserve(sizes.models * sizeof(PlacedModel)));
  {
    const ThreadStopwatch watch(timings_.setup);
    RETURN_IF_ERROR(stage(views, at_bytes));
#if defined(__SSE2__)
    _mm_sfence();
#endif
    cutSlices(at_bytes);
  }
  RETURN_IF_ERROR(reserve(views.size()));
  RETURN_IF_ERROR(driver_->check(
      functions.copy_to_device(uploaded_.address(), staged_.bytes(), at_bytes.bytes, stream_),
      "copy poses"));
  RETURN_IF_ERROR(driver_->check(
      functions.set_words(counts_.address(), 0,
                          slices_.size() * sizeof(SliceCounts) / sizeof(std::uint32_t), stream_),
      "clear counts"));
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    RETURN_IF_ERROR(drawSlice(slices_[n], n, at_bytes));
  }
  return {};
}

ViewSlice CudaEngine::sliceOf(const ViewRange& range, std::size_t number,
                              const Upload& at_bytes) const {
  const SliceMemory& memory = *slice_memory_;
  const std::size_t first_pane = range.first * panes_.size();
  ViewSlice slice{};
  slice.models = at<ModelTables>(scene_->models());
  slice.views = at<DeviceView>(uploaded_, at_bytes.views) + range.first;
  slice.instances = at<DeviceInstance>(uploaded_, at_bytes.instances);
  slice.posed = at<DevicePosed>(uploaded_, at_bytes.posed);
  slice.posed_semantics = at<std::uint32_t>(uploaded_, at_bytes.posed_semantics);
  slice.attached = at<DeviceAttached>(uploaded_, at_bytes.attached);
  slice.bodies = at<RigidTransform>(uploaded_, at_bytes.bodies);
  slice.placed = at<PlacedModel>(placed_);
  slice.tasks = at<PaneTask>(memory.tasks);
  slice.task = firstTask();
  slice.panes = at<PaneRectangle>(uploaded_, at_bytes.panes);
  slice.first_cluster = at<std::uint32_t>(uploaded_, at_bytes.first_clusters) + first_pane;
  slice.seen = at<SeenCluster>(memory.seen);
  slice.order = at<std::uint32_t>(memory.order);
  slice.by_bucket = at<std::uint32_t>(memory.by_bucket);
  slice.items[0] = at<WorkItem>(memory.near_items);
  slice.items[1] = at<WorkItem>(memory.far_items);
  slice.pixels = at<std::uint64_t>(memory.pixels);
  slice.tile_depth = at<float>(memory.tile_depth);
  slice.counts = at<SliceCounts>(counts_) + number;
  slice.first_view = static_cast<std::uint32_t>(range.first);
  slice.view_count = static_cast<std::uint32_t>(range.end - range.first);
  slice.panes_of_view = static_cast<std::uint32_t>(panes_.size());
  slice.pixels_of_pane = pixels_of_pane_;
  slice.tiles_of_pane = tiles_of_pane_;
  return slice;
}

Result<void> CudaEngine::launch(Kernel kernel, std::uint32_t blocks,
                                const PassParameters& parameters) {
  if (!tuning_.measure) return kernels_->launch(kernel, blocks, parameters, stream_);
  const detail::Stopwatch watch(timings_.kernels[static_cast<std::size_t>(kernel)]);
  RETURN_IF_ERROR(kernels_->launch(kernel, blocks, parameters, stream_));
  return driver_->check(driver_->functions().synchronize(stream_), "draw");
}

Result<void> CudaEngine::drawSlice(const ViewRange& range, std::size_t number,
                                   const Upload& at_bytes) {
  PassParameters parameters{sliceOf(range, number, at_bytes), 0};
  const std::uint32_t panes = parameters.slice.view_count * parameters.slice.panes_of_view;
  const std::uint32_t workers =
      static_cast<std::uint32_t>(device_.multiprocessors()) * kBlocksPerMultiprocessor;
  const std::size_t words = std::size_t{panes} * pixels_of_pane_ * 2;
  RETURN_IF_ERROR(driver_->check(
      driver_->functions().set_words(slice_memory_->pixels.address(), 0, words, stream_),
      "clear pixels"));
  RETURN_IF_ERROR(launch(Kernel::kPlace, parameters.slice.view_count, parameters));
  RETURN_IF_ERROR(launch(Kernel::kCull, panes, parameters));
  RETURN_IF_ERROR(launch(Kernel::kDraw, workers, parameters));
  RETURN_IF_ERROR(launch(Kernel::kTiles, panes, parameters));
  parameters.pass = 1;
  RETURN_IF_ERROR(launch(Kernel::kDraw, workers, parameters));
  const auto squares = [](std::uint32_t pixels) {
    return (paneEdge(pixels) + kResolveEdge - 1) / kResolveEdge;
  };
  const std::uint32_t blocks_of_pane = squares(options_.width) * squares(options_.height);
  return launch(Kernel::kResolve, panes * blocks_of_pane, parameters);
}

Result<void> CudaEngine::readCounts() {
  read_counts_.resize(slices_.size());
  const DriverFunctions& functions = driver_->functions();
  if (!slices_.empty()) {
    RETURN_IF_ERROR(
        driver_->check(functions.copy_to_host(read_counts_.data(), counts_.address(),
                                              slices_.size() * sizeof(SliceCounts), stream_),
                       "read counts"));
  }
  RETURN_IF_ERROR(driver_->check(functions.synchronize(stream_), "draw"));
  for (const SliceCounts& counts : read_counts_) {
    statistics_.clusters_drawn += counts.clusters_drawn;
    statistics_.triangles_drawn += counts.triangles_drawn;
  }
  return {};
}

Result<void> CudaEngine::readImages() {
  const detail::Stopwatch watch(timings_.readback);
  const auto read = [this](auto target, const Memory& memory) {
    if (target.empty()) return 0;
    return driver_->functions().copy_to_host(target.data(), memory.address(), target.size_bytes(),
                                             stream_);
  };
  RETURN_IF_ERROR(driver_->check(read(targets_.color, color_), "read colors"));
  RETURN_IF_ERROR(driver_->check(read(targets_.depth, depth_), "read depth"));
  return driver_->check(read(targets_.semantics, semantics_), "read semantic ids");
}

void CudaEngine::abandon() {
  // An error here is the one that has already been reported.
  static_cast<void>(driver_->functions().synchronize(stream_));
  // If the caller ends the batch nevertheless, there is nothing to wait for.
  slices_.clear();
}

void CudaEngine::giveUp(const Error& error) {
  abandon();
  throw ErrorException(error);
}

void CudaEngine::begin(std::span<const RenderView> views, const RenderTargets& targets) {
  targets_ = targets;
  const CurrentDevice current(*driver_, device_);
  if (!current.holds()) {
    slices_.clear();
    throw ErrorException(current.failure());
  }
  if (const Result<void> drawn = draw(views); !drawn) giveUp(drawn.error());
}

void CudaEngine::end() {
  if (slices_.empty()) return;
  const CurrentDevice current(*driver_, device_);
  if (!current.holds()) {
    slices_.clear();
    is_under_way_ = true;
    throw ErrorException(current.failure());
  }
  if (const Result<void> read = readImages(); !read) giveUp(read.error());
  if (const Result<void> read = readCounts(); !read) giveUp(read.error());
}

Result<DeviceImages> CudaEngine::renderToDevice(std::span<const RenderView> views,
                                                std::uintptr_t stream) {
  const CurrentDevice current(*driver_, device_);
  if (!current.holds()) return tl::unexpected<Error>(current.failure());
  const UsedStream used(stream_, std::bit_cast<void*>(stream));
  const Result<void> drawn = draw(views).and_then([this] { return readCounts(); });
  if (!drawn) {
    abandon();
    return tl::unexpected<Error>(drawn.error());
  }
  DeviceImages images{.device = device_.number()};
  if (options_.color != ColorFormat::kNone) images.color = color_.address();
  if (options_.depth) images.depth = depth_.address();
  if (options_.semantics) images.semantics = semantics_.address();
  return images;
}

}  // namespace galactic::render::cuda

namespace galactic::render {

bool isForDataCenters(const RenderOptions& options) {
  const Result<std::unique_ptr<cuda::Driver>> driver = cuda::Driver::open();
  if (!driver) return false;
  const Result<cuda::Device> device = cuda::Device::choose(**driver, options.device);
  return device && device->isForDataCenters();
}

Result<std::unique_ptr<RenderEngine>> makeCudaEngine(const RenderLibrary& library,
                                                     const RenderOptions& options) {
  ASSIGN_OR_RETURN(auto engine, cuda::CudaEngine::make(library, options, {}));
  return std::unique_ptr<RenderEngine>(std::move(engine));
}

}  // namespace galactic::render
