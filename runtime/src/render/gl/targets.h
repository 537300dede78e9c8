#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "galactic/batch_renderer.h"
#include "render/gl/handles.h"

namespace galactic::render::gl {

/// Of color, depth and semantics together.
inline constexpr std::size_t kTargetBytesPerPixel = 12;

/// What is drawn into: a layer for each view of a slice.
class Targets {
 public:
  /// Texture units of color, depth and semantics for the resolving shader.
  static constexpr GLuint kFirstUnit = 16;

  explicit Targets(const RenderOptions& options) : options_(options) {}

  /// Makes room for so many layers; what was drawn is lost when they get more. Throws
  /// ErrorException where memory is lacking.
  void reserve(std::size_t layers);
  /// Binds them for drawing, cleared to the background.
  void beginDrawing() const;
  /// Binds them to their texture units.
  void bindForReading() const;

 private:
  Texture attach(GLenum format, GLenum attachment, std::size_t layers) const;

  RenderOptions options_;
  std::size_t layers_ = 0;
  Framebuffer framebuffer_;
  Texture color_;
  Texture depth_;
  Texture semantics_;
};

/// Where the images of up to `capacity` views lie in one buffer, bytes. Each part begins at a
/// multiple of 256, where every driver can bind it.
struct ImageLayout {
  std::size_t color = 0;
  std::size_t depth = 0;
  std::size_t semantics = 0;
  std::size_t bytes = 0;
  /// Of a view; 0 for images that are not wanted.
  std::size_t color_of_view = 0;
  std::size_t depth_of_view = 0;
  std::size_t semantics_of_view = 0;
};
[[nodiscard]] ImageLayout imageLayout(const RenderOptions& options, std::size_t capacity);

}  // namespace galactic::render::gl
