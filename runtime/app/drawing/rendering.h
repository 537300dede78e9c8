#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/options.h"
#include "drawing/frame_images.h"
#include "drawing/picture_output.h"
#include "galactic/batch_renderer.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/world.h"

namespace galactic {

/// The noise for those kinds of images that are drawn: a policy may see other kinds than are drawn
/// for people.
[[nodiscard]] ImageNoise noiseFor(const ImageNoise& noise, const RenderOptions& images);

/// A renderer and the memory for its images.
class ImageBatch {
 public:
  /// Fails with the errors of BatchRenderer::create, and with kUnsupported when there is too little
  /// memory for this many images.
  [[nodiscard]] static Result<ImageBatch> create(const RenderLibrary& library,
                                                 const RenderOptions& options, std::size_t images);

  /// `views` has one element per image.
  void begin(std::span<const RenderView> views);
  void end() { renderer_.endRender(); }

  /// An image of the last end().
  [[nodiscard]] DrawnImage image(std::size_t n) const;
  /// All images, one after another.
  [[nodiscard]] std::span<const std::uint8_t> color() const { return color_; }
  [[nodiscard]] std::span<const float> depth() const { return depth_; }
  [[nodiscard]] const BatchRenderer& renderer() const { return renderer_; }

 private:
  ImageBatch(BatchRenderer renderer, std::size_t images);
  [[nodiscard]] std::size_t pixels() const;

  BatchRenderer renderer_;
  std::vector<std::uint8_t> color_;
  std::vector<float> depth_;
  std::vector<std::uint32_t> semantics_;
};

/// Draws the envs of a run: the images of their cameras, and the debug view of those that are
/// shown.
class Rendering {
 public:
  /// `world` must outlive the result. `shown` is the number of envs with a debug view, if the
  /// options ask for one. Fails with kInvalidInput for a world without render meshes and for an
  /// unknown camera, and with the errors of BatchRenderer::create.
  [[nodiscard]] static Result<Rendering> create(const World& world, const BatchSimulator& simulator,
                                                const RunOptions& options, std::size_t shown);
  ~Rendering();
  Rendering(Rendering&&) noexcept;
  Rendering& operator=(Rendering&&) noexcept;

  /// Copies the simulator's state for the next images; the simulator may step while they are drawn.
  void update(const BatchSimulator& simulator);
  void begin();
  void end();

  /// Draws the debug view of the state of the last update(), and returns what is shown of it, which
  /// stays valid until the next begin(). Call it after end().
  [[nodiscard]] std::span<const EnvFrame> frames();

  [[nodiscard]] const BatchRenderer& renderer() const;
  /// Indexed by the ids in the images; 0 is the background.
  [[nodiscard]] const std::vector<std::string>& semanticNames() const;

 private:
  struct Parts;
  explicit Rendering(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace galactic
