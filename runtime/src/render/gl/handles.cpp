#include "render/gl/handles.h"

#include <algorithm>

namespace galactic::render::gl {

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
  glNamedBufferStorage(name, size, nullptr, flags);
  data_ = nullptr;
  if (flags != 0) {
    data_ = static_cast<std::byte*>(glMapNamedBufferRange(name, 0, size, flags));
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
