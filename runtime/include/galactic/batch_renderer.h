#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "galactic/error.h"
#include "galactic/pose.h"
#include "galactic/render_library.h"
#include "galactic/sensor_noise.h"

namespace galactic {

/// Images of a batch in the memory of a CUDA device: addresses there, in the layout of
/// RenderTargets; 0 for images that the options do not ask for. color has 3 or 4 bytes a pixel,
/// depth a float, semantics a 32-bit number.
struct DeviceImages {
  /// The device's number in CUDA, as CUDA_VISIBLE_DEVICES leaves it to this process.
  int device = 0;
  std::uint64_t color = 0;
  std::uint64_t depth = 0;
  std::uint64_t semantics = 0;
};

/// Which implementation draws the images.
enum class RenderBackend : std::uint8_t {
  kAuto,  ///< The first available of `cuda` on data center chips, `gl`, `cuda`, `soft`.
  kSoft,  ///< The rasterizer of this library, on all cores of the processor.
  kGl,    ///< OpenGL 4.5 through EGL, without a display.
  kCuda,  ///< The rasterizer of this library, on a CUDA device.
};

/// "auto", "soft", "gl" or "cuda".
[[nodiscard]] const char* backendName(RenderBackend backend) noexcept;

/// Bytes per pixel of color images.
enum class ColorFormat : std::uint8_t { kNone = 0, kRgb8 = 3, kRgba8 = 4 };

/// Pixels along an edge of an image.
inline constexpr std::uint32_t kLargestImage = 4096;

struct RenderOptions {
  /// Pixels, 1 to kLargestImage each.
  std::uint32_t width = 128;
  std::uint32_t height = 128;
  /// Which images the renderer makes.
  ColorFormat color = ColorFormat::kRgba8;
  bool depth = true;
  bool semantics = false;
  /// Distance of the near clipping plane, meters, > 0.
  float near = 0.05F;
  /// RGBA, sRGB, R lowest, where nothing is drawn.
  std::uint32_t background = 0;
  RenderBackend backend = RenderBackend::kAuto;
  /// For `gl` and `cuda`: index of the device, "cuda:N", a UUID, or empty for the first one. `gl`
  /// also takes "software", for a driver without a graphics processor (an error otherwise).
  std::string device{};
  /// Threads of `soft`; 0: one per core. The images do not depend on it.
  std::uint32_t threads = 0;
  /// Whether to cull what cannot be seen. The images do not depend on it.
  bool culling = true;
  /// What is done to the images after they are drawn.
  ImageNoise noise = {};
};

/// A pinhole camera that looks along +X of its own frame; +Y is up in the image, +Z to the right.
struct RenderCamera {
  RigidTransform world_from_camera;
  /// Radians between the lower and the upper edge of the image, 0 to pi; the horizontal field of
  /// view follows from the image's shape.
  float vertical_fov = 1.57079633F;
};

/// The same camera with the axes of images: X to the right, Y down, Z ahead.
[[nodiscard]] RigidTransform worldFromImageAxes(const RenderCamera& camera) noexcept;

/// The way back: RenderCamera::world_from_camera of a camera with these axes of images.
[[nodiscard]] RigidTransform worldFromCameraAxes(
    const RigidTransform& world_from_image_axes) noexcept;

/// RenderCamera::world_from_camera of a camera at `eye` that looks at `target`, level: what is up
/// in the world is up in its image; +X where it looks straight down, -X straight up. Points in the
/// world, meters. Throws ErrorException with kInvalidInput where the two are the same or not
/// finite.
[[nodiscard]] RigidTransform lookAt(const Vec3& eye, const Vec3& target);

/// Its camera matrix K, row by row, for images of this size: (column, row, 1) of a point is
/// K (x, y, z) / z in the axes of images; the middle of the first pixel is (0.5, 0.5).
[[nodiscard]] std::array<float, 9> cameraMatrix(const RenderCamera& camera, std::uint32_t width,
                                                std::uint32_t height) noexcept;

/// A model, placed.
struct RenderInstance {
  /// Number in the RenderLibrary.
  std::uint32_t model = 0;
  RigidTransform world_from_model;
};

/// A model, placed by a pose.
struct PosedModel {
  /// Number in the RenderLibrary.
  std::uint32_t model = 0;
  Pose world_from_model;
};

/// A model on a body that moves, such as a link of a robot.
struct AttachedModel {
  /// Number in the RenderLibrary.
  std::uint32_t model = 0;
  /// Index into RenderView::bodies.
  std::uint32_t body = 0;
  RigidTransform body_from_model;
};

/// What the random numbers of an image follow from.
struct NoiseSource {
  EnvMoment moment;
  /// Tells the cameras of an env apart.
  std::uint64_t camera = 0;
};

/// What the episode of an image has drawn of noise, which may have ranges: numbers. That of light
/// is the same for all cameras.
[[nodiscard]] ImageNoise episodeImageNoise(const ImageNoise& noise,
                                           const NoiseSource& source) noexcept;

/// One image: a camera and what it sees. A camera whose numbers are not finite, or whose field of
/// view is not within its range, sees nothing. Where a model is in one place twice, the first one
/// shows: instances come before posed models, and those before attached ones. Which of two other
/// surfaces in one place shows is for the backend to say, the same one each time. BatchRenderer
/// refuses numbers of models and of bodies that are not there.
struct RenderView {
  RenderCamera camera;
  std::span<const RenderInstance> instances = {};
  std::span<const PosedModel> posed = {};
  /// A semantic id for each posed model; empty: they have those of their packs.
  std::span<const std::uint32_t> posed_semantics = {};
  /// Views of the same robot share one list, and only their bodies move.
  std::span<const AttachedModel> attached = {};
  /// world_from_body.
  std::span<const RigidTransform> bodies = {};
  /// What RenderOptions::noise follows from.
  NoiseSource noise = {};
};

/// Where the images go: memory of the caller, view after view, rows from top to bottom. Leave a
/// span empty if the options do not ask for its image.
struct RenderTargets {
  /// Shape: views x height x width x 3 or 4. sRGB; alpha is 255 where something is drawn.
  std::span<std::uint8_t> color{};
  /// Shape: views x height x width. Meters along the camera's axis; 0 where nothing is drawn.
  std::span<float> depth{};
  /// Shape: views x height x width. Indices into RenderLibrary::semanticNames(), or ids of
  /// RenderView::posed_semantics.
  std::span<std::uint32_t> semantics{};
};

/// What the last rendering did, summed over its views. What is drawn depends on the backend: each
/// finds other things hidden, and where it draws an image in parts, each part counts.
struct RenderStatistics {
  /// Models that the views have, wherever these look.
  std::uint64_t instances = 0;
  /// Those of these models, before any is found to be out of sight.
  std::uint64_t clusters = 0;
  /// Clusters whose vertices were placed: not found to be outside of the image, or hidden as a
  /// whole.
  std::uint64_t clusters_drawn = 0;
  /// Of these clusters, the triangles that were not left out either.
  std::uint64_t triangles_drawn = 0;
};

/// Draws many images of one library together (paper, appendix D). Every image depends on its view
/// and the options only, with noise and without. Rendering neither allocates, nor throws, nor
/// locks, once it has seen its largest load: until then it throws std::bad_alloc, or ErrorException
/// with kUnsupported, where memory is lacking, and may be called with a smaller load afterwards. A
/// graphics processor that fails is an ErrorException, too, and with kInvalidInput a call that does
/// not keep to the shapes or to the order of beginRender() and endRender(), or whose views have
/// numbers of no model of the library or of no body; then nothing is drawn. Not safe to call from
/// several threads at once.
class BatchRenderer {
 public:
  /// The renderer keeps a copy of `library`. Fails with kInvalidInput on options out of range and
  /// on noise of images that are not drawn, with kUnsupported when the backend or the device is not
  /// available; the message names what is missing.
  [[nodiscard]] static Result<BatchRenderer> create(const RenderLibrary& library,
                                                    const RenderOptions& options);
  ~BatchRenderer();
  BatchRenderer(BatchRenderer&&) noexcept;
  BatchRenderer& operator=(BatchRenderer&&) noexcept;

  /// Draws `views`. The spans of `targets` have the sizes that views and options give.
  void render(std::span<const RenderView> views, const RenderTargets& targets);

  /// The same in two halves, so that the caller can work meanwhile. Everything that `views` and
  /// `targets` point to must stay unchanged until endRender() returns.
  void beginRender(std::span<const RenderView> views, const RenderTargets& targets);
  void endRender();

  /// Draws `views` and leaves the images where CUDA can use them without a copy; they are complete
  /// when this returns. `stream`: the one that uses them, as CUDA's cudaStream_t or CUstream; 0:
  /// CUDA's default stream. Work queued on it earlier finishes before the images change, so they
  /// stay valid until the next rendering on the same stream. The stream must belong to the
  /// renderer's device and live until then. Fails with kUnsupported with the soft backend, without
  /// CUDA, and with RenderOptions::noise, which is added in memory of the processor; with the gl
  /// backend, which needs a CUDA context that is current on this thread, also when its device is
  /// not the renderer's.
  [[nodiscard]] Result<DeviceImages> renderToDevice(std::span<const RenderView> views,
                                                    std::uintptr_t stream = 0);

  [[nodiscard]] const RenderOptions& options() const;
  /// kSoft, kGl or kCuda.
  [[nodiscard]] RenderBackend backend() const;
  /// One line for reports: "soft, AVX2, 2 threads", or the OpenGL driver's renderer string.
  [[nodiscard]] const std::string& description() const;
  [[nodiscard]] RenderStatistics statistics() const;

 private:
  class Impl;
  explicit BatchRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic
