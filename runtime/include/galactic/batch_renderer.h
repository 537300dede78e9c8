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

/// Images of a batch in the memory of a CUDA device: device addresses, in the layout of
/// RenderTargets; 0 for images that the options do not ask for. `color` has 3 or 4 bytes per pixel,
/// `depth` a float, `semantics` a 32-bit number.
struct DeviceImages {
  /// CUDA's number of the device, among those that CUDA_VISIBLE_DEVICES makes visible to this
  /// process.
  int device = 0;
  std::uint64_t color = 0;
  std::uint64_t depth = 0;
  std::uint64_t semantics = 0;
};

/// Which implementation draws the images.
enum class RenderBackend : std::uint8_t {
  kAuto,  ///< The first that is available: `cuda` on data center chips, `gl`, `cuda`, `soft`.
  kSoft,  ///< The rasterizer of this library, on all cores of the processor.
  kGl,    ///< OpenGL 4.5 through EGL, without a display.
  kCuda,  ///< The rasterizer of this library, on a CUDA device.
};

/// A backend, and what users call it.
struct NamedBackend {
  const char* name;
  RenderBackend backend;
};
inline constexpr std::array<NamedBackend, 4> kRenderBackends{{{"auto", RenderBackend::kAuto},
                                                              {"cuda", RenderBackend::kCuda},
                                                              {"gl", RenderBackend::kGl},
                                                              {"soft", RenderBackend::kSoft}}};

/// Its name of these.
[[nodiscard]] const char* backendName(RenderBackend backend) noexcept;

/// Bytes per pixel of color images.
enum class ColorFormat : std::uint8_t { kNone = 0, kRgb8 = 3, kRgba8 = 4 };

/// The largest width and height of an image, pixels.
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
  /// Color where nothing is drawn: RGBA, sRGB, R in the lowest byte.
  std::uint32_t background = 0;
  RenderBackend backend = RenderBackend::kAuto;
  /// For `gl` and `cuda`: the index of the device, "cuda:N", a UUID, or empty for the first one.
  /// `gl` also takes "software", for a driver without a graphics processor, which is otherwise an
  /// error.
  std::string device{};
  /// Threads of `soft`; 0: one per core. The images do not depend on their number.
  std::uint32_t threads = 0;
  /// Whether to cull what cannot be seen. The images are the same either way.
  bool culling = true;
  /// Noise that is added to the images after they are drawn.
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

/// The inverse of worldFromImageAxes(): RenderCamera::world_from_camera of a camera with these
/// image axes.
[[nodiscard]] RigidTransform worldFromCameraAxes(
    const RigidTransform& world_from_image_axes) noexcept;

/// RenderCamera::world_from_camera of a camera at `eye` that looks at `target` without roll: up in
/// the world is up in its image. If it looks straight down, +X is up in its image; straight up, -X.
/// Points are in the world frame, meters. Throws ErrorException with kInvalidInput if the two
/// points are the same or not finite.
[[nodiscard]] RigidTransform lookAt(const Vec3& eye, const Vec3& target);

/// The camera matrix K, row by row, for images of this size: a point (x, y, z) in the axes of
/// images appears at (column, row, 1) = K (x, y, z) / z. The middle of the first pixel is (0.5,
/// 0.5).
[[nodiscard]] std::array<float, 9> cameraMatrix(const RenderCamera& camera, std::uint32_t width,
                                                std::uint32_t height) noexcept;

/// A model, placed by a rigid transform.
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

/// What the random numbers of an image are derived from.
struct NoiseSource {
  EnvMoment moment;
  /// Distinguishes the cameras of an env.
  std::uint64_t camera = 0;
};

/// The noise of an image's episode: numbers, drawn from the ranges that `noise` may have. The
/// number for light is the same for all cameras.
[[nodiscard]] ImageNoise episodeImageNoise(const ImageNoise& noise,
                                           const NoiseSource& source) noexcept;

/// One image: a camera and what it sees. A camera whose numbers are not finite, or whose field of
/// view is out of range, sees nothing. If a model is in the same place twice, the first one is
/// visible: instances come before posed models, and posed models before attached ones. Which of two
/// other coinciding surfaces is visible depends on the backend, but is the same each time.
/// BatchRenderer refuses numbers of models and bodies that do not exist.
struct RenderView {
  RenderCamera camera;
  std::span<const RenderInstance> instances = {};
  std::span<const PosedModel> posed = {};
  /// A semantic id for each posed model; empty: the ids of their packs.
  std::span<const std::uint32_t> posed_semantics = {};
  /// Views of the same robot can share one list, since only their bodies move.
  std::span<const AttachedModel> attached = {};
  /// world_from_body.
  std::span<const RigidTransform> bodies = {};
  /// What the random numbers of RenderOptions::noise are derived from.
  NoiseSource noise = {};
};

/// Where the images are written: memory of the caller, view after view, rows from top to bottom.
/// Leave a span empty if the options do not ask for its image.
struct RenderTargets {
  /// Shape: views x height x width x 3 or 4. sRGB; alpha is 255 where something is drawn.
  std::span<std::uint8_t> color{};
  /// Shape: views x height x width. Meters along the camera's axis; 0 where nothing is drawn.
  std::span<float> depth{};
  /// Shape: views x height x width. Indices into RenderLibrary::semanticNames(), or ids of
  /// RenderView::posed_semantics.
  std::span<std::uint32_t> semantics{};
};

/// What the last rendering did, summed over its views. The numbers of what is drawn depend on the
/// backend: each backend finds different things hidden, and if it draws an image in parts, each
/// part counts.
struct RenderStatistics {
  /// Models in the views, whether or not the cameras see them.
  std::uint64_t instances = 0;
  /// Clusters of these models, before any culling.
  std::uint64_t clusters = 0;
  /// Clusters whose vertices were transformed: those that culling did not find to be entirely
  /// outside the image or hidden.
  std::uint64_t clusters_drawn = 0;
  /// Triangles of these clusters that were not culled either.
  std::uint64_t triangles_drawn = 0;
};

/// Draws many images of one library together (paper, appendix D). Every image depends only on its
/// view and the options, with noise or without. Once it has seen its largest load, rendering
/// neither allocates, nor throws, nor locks. Until then it throws std::bad_alloc, or ErrorException
/// with kUnsupported, if memory runs out; you may call it with a smaller load afterwards. A
/// graphics processor that fails also causes an ErrorException. A call with wrong shapes, in the
/// wrong order of beginRender() and endRender(), or with numbers of models or bodies that do not
/// exist throws ErrorException with kInvalidInput and draws nothing. Not safe to call from several
/// threads at once.
class BatchRenderer {
 public:
  /// The renderer keeps a copy of `library`. Fails with kInvalidInput if an option is out of range
  /// or adds noise to images that are not drawn, and with kUnsupported if the backend or the device
  /// is not available; the message names what is missing.
  [[nodiscard]] static Result<BatchRenderer> create(const RenderLibrary& library,
                                                    const RenderOptions& options);
  ~BatchRenderer();
  BatchRenderer(BatchRenderer&&) noexcept;
  BatchRenderer& operator=(BatchRenderer&&) noexcept;

  /// Draws `views`. The spans of `targets` must have the sizes that follow from views and options.
  void render(std::span<const RenderView> views, const RenderTargets& targets);

  /// render() in two halves, so that the caller can work in the meantime. Everything that `views`
  /// and `targets` point to must stay unchanged until endRender() returns.
  void beginRender(std::span<const RenderView> views, const RenderTargets& targets);
  void endRender();

  /// Draws `views` and leaves the images where CUDA can use them without a copy; they are complete
  /// when this returns. `stream`: the stream that uses the images, as CUDA's cudaStream_t or
  /// CUstream; 0: CUDA's default stream. Work that was queued on it earlier finishes before the
  /// images change, so they stay valid until the next rendering on the same stream. The stream must
  /// belong to the renderer's device and live until then. Fails with kUnsupported with the soft
  /// backend, without CUDA, and with RenderOptions::noise, which is added in the processor's
  /// memory. The gl backend needs a CUDA context that is current on this thread, and also fails if
  /// that context's device is not the renderer's.
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
