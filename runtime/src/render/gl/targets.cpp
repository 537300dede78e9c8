#include "render/gl/targets.h"

namespace galactic::render::gl {
namespace {

constexpr std::size_t kAlignment = 256;

constexpr std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

GLint drawBuffersOf(const RenderOptions& options, std::array<GLenum, 2>& buffers) {
  GLint count = 0;
  if (options.color != ColorFormat::kNone) {
    buffers[static_cast<std::size_t>(count++)] = GL_COLOR_ATTACHMENT0;
  }
  if (options.semantics) buffers[static_cast<std::size_t>(count++)] = GL_COLOR_ATTACHMENT1;
  return count;
}

}  // namespace

void Targets::reserve(std::size_t layers) {
  if (layers <= layers_) return;
  layers_ = 0;
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  framebuffer_ = Framebuffer(name);
  depth_ = attach(GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT, layers);
  if (options_.color != ColorFormat::kNone) {
    color_ = attach(GL_RGBA8, GL_COLOR_ATTACHMENT0, layers);
  }
  if (options_.semantics) semantics_ = attach(GL_R32UI, GL_COLOR_ATTACHMENT1, layers);
  std::array<GLenum, 2> buffers{};
  const GLint count = drawBuffersOf(options_, buffers);
  glNamedFramebufferDrawBuffers(name, count, buffers.data());
  requireMemory(layers * options_.width * options_.height * kTargetBytesPerPixel);
  layers_ = layers;
}

Texture Targets::attach(GLenum format, GLenum attachment, std::size_t layers) const {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
  glTextureStorage3D(name, 1, format, static_cast<GLsizei>(options_.width),
                     static_cast<GLsizei>(options_.height), static_cast<GLsizei>(layers));
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glNamedFramebufferTexture(framebuffer_.get(), attachment, name, 0);
  return Texture(name);
}

void Targets::beginDrawing() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, static_cast<GLsizei>(options_.width), static_cast<GLsizei>(options_.height));
  const GLfloat nothing = 0;
  glClearBufferfv(GL_DEPTH, 0, &nothing);
  GLint buffer = 0;
  if (options_.color != ColorFormat::kNone) {
    std::array<GLfloat, 4> background{};
    for (std::size_t i = 0; i < background.size(); ++i) {
      background[i] = static_cast<GLfloat>(options_.background >> (8 * i) & 0xFFU) / 255.0F;
    }
    glClearBufferfv(GL_COLOR, buffer++, background.data());
  }
  if (options_.semantics) {
    constexpr std::array<GLuint, 4> kNoId{};
    glClearBufferuiv(GL_COLOR, buffer, kNoId.data());
  }
}

void Targets::bindForReading() const {
  glBindTextureUnit(kFirstUnit, color_.get());
  glBindTextureUnit(kFirstUnit + 1, depth_.get());
  glBindTextureUnit(kFirstUnit + 2, semantics_.get());
}

ImageLayout imageLayout(const RenderOptions& options, std::size_t capacity) {
  const std::size_t pixels = std::size_t{options.width} * options.height;
  ImageLayout layout;
  layout.color_of_view = pixels * static_cast<std::size_t>(options.color);
  layout.depth_of_view = options.depth ? pixels * sizeof(float) : 0;
  layout.semantics_of_view = options.semantics ? pixels * sizeof(std::uint32_t) : 0;
  // Color is written four pixels at a time, and the last ones may be beyond the image.
  layout.depth = aligned(capacity * layout.color_of_view + 4 * sizeof(std::uint32_t));
  layout.semantics = layout.depth + aligned(capacity * layout.depth_of_view + sizeof(float));
  layout.bytes = layout.semantics + aligned(capacity * layout.semantics_of_view + sizeof(float));
  return layout;
}

}  // namespace galactic::render::gl
