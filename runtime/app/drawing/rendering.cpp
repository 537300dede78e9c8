#include "drawing/rendering.h"

#include <fmt/format.h>
#include <malloc.h>

#include <utility>

#include "galactic/debug_views.h"
#include "galactic/world_models.h"
#include "galactic/world_views.h"
#include "support/out_of_memory.h"
#include "support/try.h"

namespace galactic {
namespace {

/// Memory of one image on our side; a backend has its own memory in addition.
double bytesPerImage(const RenderOptions& options) {
  const std::size_t per_pixel = static_cast<std::size_t>(options.color) +
                                (options.depth ? sizeof(float) : 0) +
                                (options.semantics ? sizeof(std::uint32_t) : 0);
  return static_cast<double>(per_pixel) * options.width * options.height;
}

/// OpenGL's software driver frees and reallocates its lists on every flush: with glibc's default
/// thresholds, it spends a third of its time on page faults. The program may change the thresholds;
/// the library should not.
void keepFreedMemory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 2'000'000'000);
  mallopt(M_TOP_PAD, 64 << 20);
#endif
}

}  // namespace

ImageNoise noiseFor(const ImageNoise& noise, const RenderOptions& images) {
  ImageNoise result = noise;
  if (!images.depth) result.depth_noise = result.depth_dropout = 0;
  if (images.color == ColorFormat::kNone) result.color_noise = result.light_jitter = 0;
  return result;
}

Result<ImageBatch> ImageBatch::create(const RenderLibrary& library, const RenderOptions& options,
                                      std::size_t images) {
  RETURN_IF_ERROR(
      checkMemory(static_cast<double>(images) * bytesPerImage(options),
                  fmt::format("{} images of {} x {} pixels", images, options.width, options.height),
                  "draw fewer envs at once (--envs), or smaller images (--size)"));
  // The software driver is used only if it is asked for.
  if (options.device == "software") keepFreedMemory();
  ASSIGN_OR_RETURN(BatchRenderer renderer, BatchRenderer::create(library, options));
  return ImageBatch(std::move(renderer), images);
}

ImageBatch::ImageBatch(BatchRenderer renderer, std::size_t images)
    : renderer_(std::move(renderer)) {
  const RenderOptions& options = renderer_.options();
  color_.resize(images * pixels() * static_cast<std::size_t>(options.color));
  if (options.depth) depth_.resize(images * pixels());
  if (options.semantics) semantics_.resize(images * pixels());
}

void ImageBatch::begin(std::span<const RenderView> views) {
  renderer_.beginRender(views, {color_, depth_, semantics_});
}

DrawnImage ImageBatch::image(std::size_t n) const {
  const RenderOptions& options = renderer_.options();
  DrawnImage image{.width = options.width,
                   .height = options.height,
                   .format = options.color,
                   .color = {},
                   .depth = {},
                   .semantics = {}};
  const std::size_t color_bytes = pixels() * static_cast<std::size_t>(options.color);
  image.color = std::span(color_).subspan(n * color_bytes, color_bytes);
  if (options.depth) image.depth = std::span(depth_).subspan(n * pixels(), pixels());
  if (options.semantics) image.semantics = std::span(semantics_).subspan(n * pixels(), pixels());
  return image;
}

std::size_t ImageBatch::pixels() const {
  return std::size_t{renderer_.options().width} * renderer_.options().height;
}

namespace {

RenderOptions rendererOptions(const RunOptions& run, float near) {
  const DrawingOptions& drawing = run.drawing;
  RenderOptions options;
  options.width = drawing.width;
  options.height = drawing.height;
  options.color = drawing.hasColor() ? ColorFormat::kRgba8 : ColorFormat::kNone;
  options.depth = drawing.hasDepth();
  options.semantics = drawing.hasSemantics();
  options.near = near;
  options.backend = drawing.backend;
  options.device = drawing.device;
  options.noise = noiseFor(drawing.noise, options);
  options.threads = run.simulation.threads;
  return options;
}

CameraWish cameraWish(const DrawingOptions& drawing) {
  CameraWish wish{.name = drawing.camera,
                  .fov_degrees = drawing.fov_degrees,
                  .position = drawing.camera_position,
                  .rpy_degrees = drawing.camera_rpy_degrees,
                  .near = drawing.near,
                  .jitter = drawing.jitter,
                  .options = {.places = "--eye"}};
  if (drawing.eye) {
    const auto point = [](const std::array<float, 3>& p) { return Vec3{p[0], p[1], p[2]}; };
    wish.name.clear();
    wish.world_from_camera = {lookAt(point(*drawing.eye), point(*drawing.look_at))};
  }
  return wish;
}

/// The debug view of some envs.
class DebugBatch {
 public:
  static Result<std::unique_ptr<DebugBatch>> create(const World& world,
                                                    const BatchSimulator& simulator,
                                                    const RunOptions& run, std::size_t shown) {
    ASSIGN_OR_RETURN(const ChosenCamera camera,
                     chooseCamera(world.robot(), {.name = run.drawing.debug_camera,
                                                  .options = {.camera = "--debug-camera"}}));
    ASSIGN_OR_RETURN(DebugModels models,
                     DebugModels::from(world, {.radius = run.drawing.debug_radius}));
    auto batch = std::unique_ptr<DebugBatch>(new DebugBatch(std::move(models)));
    RenderOptions options = rendererOptions(run, camera.near);
    options.color = ColorFormat::kRgba8;
    options.depth = false;
    options.semantics = false;
    constexpr std::uint32_t kSky = 0xFFF4ECE4;
    options.background = kSky;
    options.noise = {};
    ASSIGN_OR_RETURN(batch->images_, ImageBatch::create(batch->models_.library(), options, shown));
    batch->views_.emplace(batch->models_, simulator, camera.mount, shown);
    return batch;
  }

  void update(const BatchSimulator& simulator) { views_->update(simulator); }
  void draw() {
    images_->begin(views_->views());
    images_->end();
  }
  [[nodiscard]] DrawnImage image(std::size_t n) const { return images_->image(n); }

 private:
  explicit DebugBatch(DebugModels models) : models_(std::move(models)) {}

  DebugModels models_;
  std::optional<DebugViews> views_;
  std::optional<ImageBatch> images_;
};

}  // namespace

/// Must not move, because its parts refer to each other.
struct Rendering::Parts {
  Parts(const World& of, WorldModels world_models) : world(of), models(std::move(world_models)) {}

  const World& world;
  WorldModels models;
  std::optional<WorldViews> views;
  std::optional<ImageBatch> images;
  std::unique_ptr<DebugBatch> debug;
  std::vector<EnvFrame> frames;
};

Rendering::Rendering(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Rendering::~Rendering() = default;
Rendering::Rendering(Rendering&&) noexcept = default;
Rendering& Rendering::operator=(Rendering&&) noexcept = default;

Result<Rendering> Rendering::create(const World& world, const BatchSimulator& simulator,
                                    const RunOptions& options, std::size_t shown) {
  const DrawingOptions& drawing = options.drawing;
  ASSIGN_OR_RETURN(const ChosenCamera camera, chooseCamera(world.robot(), cameraWish(drawing)));
  ASSIGN_OR_RETURN(WorldModels models, WorldModels::from(world));
  auto parts = std::make_unique<Parts>(world, std::move(models));
  ASSIGN_OR_RETURN(parts->images,
                   ImageBatch::create(parts->models.library(),
                                      rendererOptions(options, camera.near), simulator.envCount()));
  parts->views.emplace(parts->models, simulator, camera.mount);
  if (drawing.debug_view) {
    ASSIGN_OR_RETURN(auto debug, DebugBatch::create(world, simulator, options, shown));
    parts->debug = std::move(debug);
  }
  parts->frames.resize(shown);
  return Rendering(std::move(parts));
}

void Rendering::update(const BatchSimulator& simulator) {
  parts_->views->update(simulator);
  if (parts_->debug) parts_->debug->update(simulator);
  const World& world = parts_->world;
  for (std::size_t env = 0; env < parts_->frames.size(); ++env) {
    const EnvObjects objects = simulator.envObjects(env);
    const std::span<const Placement> placements = objects.present.placements;
    const auto name_of = [&](const Placement& placement) {
      return world.episodes().objectNames()[placement.object];
    };
    EnvFrame& frame = parts_->frames[env];
    frame.is_idle = simulator.idle()[env] != 0;
    frame.episode = objects.episode;
    frame.target = name_of(placements[objects.present.target]);
    frame.held = {};
    if (objects.held >= 0) {
      frame.held = name_of(placements[static_cast<std::size_t>(objects.held)]);
    }
  }
}
void Rendering::begin() { parts_->images->begin(parts_->views->views()); }
void Rendering::end() { parts_->images->end(); }

std::span<const EnvFrame> Rendering::frames() {
  if (parts_->debug) parts_->debug->draw();
  for (std::size_t env = 0; env < parts_->frames.size(); ++env) {
    EnvFrame& frame = parts_->frames[env];
    frame.camera = parts_->images->image(env);
    frame.seen_from = parts_->views->views()[env].camera;
    if (parts_->debug) frame.debug = parts_->debug->image(env);
  }
  return parts_->frames;
}

const BatchRenderer& Rendering::renderer() const { return parts_->images->renderer(); }

const std::vector<std::string>& Rendering::semanticNames() const {
  return parts_->models.library().semanticNames();
}

}  // namespace galactic
