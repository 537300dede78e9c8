#include "galactic/batch_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "galactic/drawn_number.h"
#include "render/noise/noise_pass.h"
#include "render/render_engine.h"
#include "render/view_check.h"
#include "support/call_check.h"
#include "support/try.h"

namespace galactic {
namespace {

Result<void> checkOptions(const RenderOptions& options) {
  const auto refuse = [](const std::string& message) {
    return fail(ErrorCode::kInvalidInput, "render options", message);
  };
  if (options.width < 1 || options.width > kLargestImage || options.height < 1 ||
      options.height > kLargestImage) {
    return refuse("found images of " + std::to_string(options.width) + " x " +
                  std::to_string(options.height) + " pixels; expected 1 to " +
                  std::to_string(kLargestImage) + " each");
  }
  if (!(options.near > 0) || !std::isfinite(options.near)) {
    return refuse("found a near plane at " + std::to_string(options.near) +
                  " m; expected a distance above 0");
  }
  if (options.color != ColorFormat::kNone && options.color != ColorFormat::kRgb8 &&
      options.color != ColorFormat::kRgba8) {
    return refuse(fmt::format("found the color format {}; expected one of ColorFormat: 0, 3 or 4",
                              static_cast<unsigned>(options.color)));
  }
  if (options.backend > RenderBackend::kCuda) {
    return refuse(fmt::format("found the backend {}; expected one of RenderBackend: 0 to {}",
                              static_cast<unsigned>(options.backend),
                              static_cast<unsigned>(RenderBackend::kCuda)));
  }
  if (options.color == ColorFormat::kNone && !options.depth && !options.semantics) {
    return refuse("found no image to make; expected color, depth or semantics");
  }
  for (const SensorOption<ImageNoise>& option : kImageNoiseOptions) {
    const DrawnNumber& value = options.noise.*option.value;
    const Span within{0, option.most};
    if (isDrawnWithin(value, within)) continue;
    return refuse(fmt::format("found {} of {}, expected {}", option.name, drawnText(value),
                              wantedDrawn(within)));
  }
  if (options.noise.changesDepth() && !options.depth) {
    return refuse(
        "found noise or dropout of depth, and no depth images; draw depth, or leave it out");
  }
  if (options.noise.changesColor() && options.color == ColorFormat::kNone) {
    return refuse(
        "found noise or jitter of colors, and no color images; draw color, or leave it out");
  }
  return {};
}

using Made = Result<std::unique_ptr<render::RenderEngine>>;

/// If the user has not asked for `cuda`, it first has to prove that it draws what it should.
Made makeProvenCudaEngine(const RenderLibrary& library, const RenderOptions& options) {
  RETURN_IF_ERROR(render::proveCuda(options));
  return render::makeCudaEngine(library, options);
}

/// The engine for RenderBackend::kAuto: the fastest on this machine. `cuda` comes before `gl` on
/// data center chips, which have few units that draw triangles. OpenGL counts only if a graphics
/// processor runs it.
Made makeFastestEngine(const RenderLibrary& library, const RenderOptions& options) {
  if (render::isForDataCenters(options)) {
    Made cuda = makeProvenCudaEngine(library, options);
    if (cuda) return cuda;
  }
  Made gl = render::makeGlEngine(library, options);
  if (gl) return gl;
  Made cuda = makeProvenCudaEngine(library, options);
  if (cuda) return cuda;
  // A user who names a device does not want to draw on the processor.
  if (!options.device.empty()) {
    if (gl.error().code == ErrorCode::kInvalidInput) return gl;
    return fail(gl.error().code, "render device",
                "neither gl nor cuda draws on it. gl: " + gl.error().message +
                    ". cuda: " + cuda.error().message);
  }
  return render::makeSoftEngine(library, options);
}

Made makeEngine(const RenderLibrary& library, const RenderOptions& options) {
  switch (options.backend) {
    case RenderBackend::kSoft:
      return render::makeSoftEngine(library, options);
    case RenderBackend::kGl:
      return render::makeGlEngine(library, options);
    case RenderBackend::kCuda:
      return render::makeCudaEngine(library, options);
    case RenderBackend::kAuto:
      break;
  }
  return makeFastestEngine(library, options);
}

}  // namespace

RigidTransform worldFromImageAxes(const RenderCamera& camera) noexcept {
  const auto& [ahead, up, right, origin] = camera.world_from_camera;
  return {right, up * -1.0F, ahead, origin};
}

RigidTransform worldFromCameraAxes(const RigidTransform& world_from_image_axes) noexcept {
  const auto& [right, down, ahead, origin] = world_from_image_axes;
  return {ahead, down * -1.0F, right, origin};
}

RigidTransform lookAt(const Vec3& eye, const Vec3& target) {
  const Vec3 way = target - eye;
  const float length = std::sqrt(dot(way, way));
  if (!(length > 0 && std::isfinite(length))) {
    detail::refuseCall(
        "lookAt",
        fmt::format("found the eye ({}, {}, {}) and the target ({}, {}, {}); expected two "
                    "points of which one can be seen from the other",
                    eye.x, eye.y, eye.z, target.x, target.y, target.z));
  }
  const Vec3 ahead = way * (1 / length);
  // If the sine of the angle from the vertical is no larger than this, the heading is mere rounding
  // error.
  constexpr float kSteepest = 1e-6F;
  const Vec3 level = cross(ahead, {0, 1, 0});
  const float slant = std::sqrt(dot(level, level));
  const Vec3 right = slant > kSteepest ? level * (1 / slant) : Vec3{0, 0, 1};
  return {ahead, cross(right, ahead), right, eye};
}

std::array<float, 9> cameraMatrix(const RenderCamera& camera, std::uint32_t width,
                                  std::uint32_t height) noexcept {
  const float half_width = static_cast<float>(width) / 2;
  const float half_height = static_cast<float>(height) / 2;
  const auto slope = static_cast<float>(std::tan(0.5 * static_cast<double>(camera.vertical_fov)));
  const float focal = half_height / slope;
  return {focal, 0,     half_width,   //
          0,     focal, half_height,  //
          0,     0,     1};
}

const char* backendName(RenderBackend backend) noexcept {
  return std::ranges::find(kRenderBackends, backend, &NamedBackend::backend)->name;
}

class BatchRenderer::Impl {
 public:
  Impl(std::unique_ptr<const RenderLibrary> library, const RenderOptions& options,
       std::unique_ptr<render::RenderEngine> engine)
      : library_(std::move(library)),
        options_(options),
        engine_(std::move(engine)),
        description_(engine_->description()) {
    if (options.noise.changesDepth() || options.noise.changesColor()) noise_.emplace(options);
  }

  /// `call`: the function of BatchRenderer that was called.
  void begin(const char* call, std::span<const RenderView> views, const RenderTargets& targets) {
    requireIdle(call);
    const std::size_t pixels = views.size() * options_.width * options_.height;
    const auto check = [&](const char* array, std::size_t found, std::size_t expected) {
      detail::checkLength(call, array, found, expected);
    };
    check("color", targets.color.size(), pixels * static_cast<std::size_t>(options_.color));
    check("depth", targets.depth.size(), options_.depth ? pixels : 0);
    check("semantics", targets.semantics.size(), options_.semantics ? pixels : 0);
    render::checkViews(call, views, library_->modelCount());
    views_ = views;
    targets_ = targets;
    engine_->begin(views, targets);
    is_drawing_ = true;
  }
  void end() {
    if (!is_drawing_) {
      detail::refuseCall("BatchRenderer::endRender", "found no rendering that has begun");
    }
    is_drawing_ = false;
    engine_->end();
    if (noise_) noise_->run(views_, targets_);
  }
  Result<DeviceImages> renderToDevice(std::span<const RenderView> views, std::uintptr_t stream) {
    constexpr const char* kCall = "BatchRenderer::renderToDevice";
    requireIdle(kCall);
    render::checkViews(kCall, views, library_->modelCount());
    if (noise_) {
      return fail(ErrorCode::kUnsupported, "device images",
                  "found noise of images, which is added in memory of the processor, and images "
                  "that stay on the device; render into memory, or leave the noise out");
    }
    return engine_->renderToDevice(views, stream);
  }

  const RenderOptions& options() const { return options_; }
  const std::string& description() const { return description_; }
  const render::RenderEngine& engine() const { return *engine_; }

 private:
  void requireIdle(const char* call) const {
    if (!is_drawing_) return;
    detail::refuseCall(call, "found a rendering that has begun; end it first, with endRender()");
  }

  /// The library that the engine refers to.
  std::unique_ptr<const RenderLibrary> library_;
  RenderOptions options_;
  std::unique_ptr<render::RenderEngine> engine_;
  std::string description_;
  std::optional<render::NoisePass> noise_;
  /// The batch that is being drawn.
  std::span<const RenderView> views_;
  RenderTargets targets_;
  bool is_drawing_ = false;
};

Result<BatchRenderer> BatchRenderer::create(const RenderLibrary& library,
                                            const RenderOptions& options) {
  if (const Result<void> checked = checkOptions(options); !checked) {
    return tl::unexpected<Error>(checked.error());
  }
  auto kept = std::make_unique<const RenderLibrary>(library);
  Made engine = makeEngine(*kept, options);
  if (!engine) return tl::unexpected<Error>(engine.error());
  RenderOptions chosen = options;
  chosen.backend = (*engine)->backend();
  return BatchRenderer(std::make_unique<Impl>(std::move(kept), chosen, std::move(*engine)));
}

BatchRenderer::BatchRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BatchRenderer::~BatchRenderer() = default;
BatchRenderer::BatchRenderer(BatchRenderer&&) noexcept = default;
BatchRenderer& BatchRenderer::operator=(BatchRenderer&&) noexcept = default;

void BatchRenderer::render(std::span<const RenderView> views, const RenderTargets& targets) {
  impl_->begin("BatchRenderer::render", views, targets);
  impl_->end();
}
void BatchRenderer::beginRender(std::span<const RenderView> views, const RenderTargets& targets) {
  impl_->begin("BatchRenderer::beginRender", views, targets);
}
void BatchRenderer::endRender() { impl_->end(); }
Result<DeviceImages> BatchRenderer::renderToDevice(std::span<const RenderView> views,
                                                   std::uintptr_t stream) {
  return impl_->renderToDevice(views, stream);
}

const RenderOptions& BatchRenderer::options() const { return impl_->options(); }
RenderBackend BatchRenderer::backend() const { return impl_->options().backend; }
const std::string& BatchRenderer::description() const { return impl_->description(); }
RenderStatistics BatchRenderer::statistics() const { return impl_->engine().statistics(); }

}  // namespace galactic
