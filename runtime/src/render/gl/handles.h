#pragma once
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <cstddef>
#include <utility>

namespace galactic::render::gl {

/// Whether OpenGL can be called on this thread. Where the context is lost, so is what it had.
inline bool hasContext() { return eglGetCurrentContext() != EGL_NO_CONTEXT; }

/// A name that OpenGL gave, given back at the end. Its context must be current then; or none, where
/// it is lost.
template <void (*Delete)(GLuint)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint name) : name_(name) {}
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0U)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  void reset() {
    const GLuint name = std::exchange(name_, 0U);
    if (name != 0 && hasContext()) Delete(name);
  }
  [[nodiscard]] GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};

inline void deleteBuffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void deleteTexture(GLuint name) { glDeleteTextures(1, &name); }
inline void deleteFramebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void deleteVertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void deleteProgram(GLuint name) { glDeleteProgram(name); }
inline void deleteQuery(GLuint name) { glDeleteQueries(1, &name); }

using BufferName = Handle<deleteBuffer>;
using Texture = Handle<deleteTexture>;
using Framebuffer = Handle<deleteFramebuffer>;
using VertexArray = Handle<deleteVertexArray>;
using Program = Handle<deleteProgram>;
using Query = Handle<deleteQuery>;

/// Throws ErrorException where OpenGL could not reserve the bytes that it was asked for last.
void requireMemory(std::size_t bytes);

/// How the processor reaches a buffer.
enum class Access { kNone, kWrite, kRead };

/// A buffer that only grows, and is mapped all the time when the processor reaches it.
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(Access access) : access_(access) {}

  /// Makes room for so many bytes; what was in it is lost when it grows. At least one byte, so that
  /// it can be bound. Throws ErrorException where memory is lacking.
  void reserve(std::size_t bytes);
  /// Fills a buffer of exactly this content, for good.
  void fill(const void* data, std::size_t bytes);

  [[nodiscard]] GLuint get() const { return name_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The mapped memory; null for Access::kNone.
  [[nodiscard]] std::byte* data() const { return data_; }

 private:
  Access access_ = Access::kNone;
  BufferName name_;
  std::size_t size_ = 0;
  std::byte* data_ = nullptr;
};

}  // namespace galactic::render::gl
