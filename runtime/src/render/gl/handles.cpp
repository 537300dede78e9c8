#include "render/gl/handles.h"

#include <fmt/format.h>

#include <algorithm>

#include "galactic/error.h"

namespace galactic::render::gl {
namespace {

ErrorException lacksMemory(std::size_t bytes) {
  return ErrorException(
      {ErrorCode::kUnsupported, "render device",
       fmt::format("OpenGL has no memory for {} MB more; draw fewer images at once or smaller "
                   "ones, or use the soft backend",
                   (bytes >> 20U) + 1)});
}

}  // namespace

void requireMemory(std::size_t bytes) {
  if (glGetError() == GL_OUT_OF_MEMORY) throw lacksMemory(bytes);
}

void Buffer::reserve(std::size_t bytes) {
  bytes = std::max<std::size_t>(bytes, 1);
  if (bytes <= size_) return;
  constexpr GLbitfield kMapped = GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  GLbitfield flags = 0;
  if (access_ == Access::kWrite) flags = kMapped | GL_MAP_WRITE_BIT;
  if (access_ == Access::kRead) flags = kMapped | GL_MAP_READ_BIT;
  GLuint name = 0;
  glCreateBuffers(1, &name);
  name_ = BufferName(name);
  const auto size = static_cast<GLsizeiptr>(bytes);
  // If anything fails below, the next call starts afresh.
  size_ = 0;
  data_ = nullptr;
  glNamedBufferStorage(name, size, nullptr, flags);
  requireMemory(bytes);
  if (flags != 0) {
    data_ = static_cast<std::byte*>(glMapNamedBufferRange(name, 0, size, flags));
    if (data_ == nullptr) throw lacksMemory(bytes);
  }
  size_ = bytes;
}

void Buffer::fill(const void* data, std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  name_ = BufferName(name);
  // A buffer without bytes cannot be bound.
  constexpr std::size_t kLeast = 16;
  size_ = std::max(bytes, kLeast);
  const bool whole = bytes >= kLeast;
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(size_), whole ? data : nullptr,
                       whole ? 0 : GL_DYNAMIC_STORAGE_BIT);
  if (!whole && bytes > 0) {
    glNamedBufferSubData(name, 0, static_cast<GLsizeiptr>(bytes), data);
  }
}

}  // namespace galactic::render::gl
