#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "galactic/batch_renderer.h"
#include "render/gl/handles.h"

namespace galactic::render::gl {

/// Color, depth and semantics together.
inline constexpr std::size_t kTargetBytesPerPixel = 12;

/// The textures that are drawn into, with a layer for each view of a slice.
class Targets {
 public:
  /// Texture units of color, depth and semantics for the resolving shader.
  static constexpr GLuint kFirstUnit = 16;

  explicit Targets(const RenderOptions& options) : options_(options) {}

  /// Makes room for `layers` layers; if their number grows, what was drawn is lost. Throws
  /// ErrorException if there is too little memory.
  void reserve(std::size_t layers);
  /// Binds the textures for drawing and clears them to the background.
  void beginDrawing() const;
  /// Binds the textures to their texture units.
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

/// Where the images of a number of views lie in one buffer, bytes. Each part begins at a multiple
/// of 256, where every driver can bind it.
struct ImageLayout {
  std::size_t color = 0;
  std::size_t depth = 0;
  std::size_t semantics = 0;
  std::size_t bytes = 0;
  /// Size of one view's image; 0 for images that are not wanted.
  std::size_t color_of_view = 0;
  std::size_t depth_of_view = 0;
  std::size_t semantics_of_view = 0;
};
[[nodiscard]] ImageLayout imageLayout(const RenderOptions& options, std::size_t capacity);

}  // namespace galactic::render::gl
