#pragma once
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <cstddef>
#include <utility>

namespace galactic::render::gl {

/// Whether OpenGL can be called on this thread. If the context is lost, so are its objects.
inline bool hasContext() { return eglGetCurrentContext() != EGL_NO_CONTEXT; }

/// Owns an object of OpenGL by its name, and deletes it in the destructor. The object's context
/// must be current then; if it is lost, no context may be.
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

/// Throws ErrorException if OpenGL failed to allocate the `bytes` that it was last asked for.
void requireMemory(std::size_t bytes);

/// How the processor accesses a buffer.
enum class Access { kNone, kWrite, kRead };

/// A buffer that only grows. If the processor accesses it, it stays mapped all the time.
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(Access access) : access_(access) {}

  /// Makes room for `bytes` bytes, and for at least one, so that the buffer can be bound. If it
  /// grows, it loses its content. Throws ErrorException if there is too little memory.
  void reserve(std::size_t bytes);
  /// Creates the buffer with this content, which never changes again.
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
