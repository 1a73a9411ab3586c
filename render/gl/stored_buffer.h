// A buffer that shaders and the CPU read and write in turn; on software drivers it is plain memory.
#pragma once

#include <algorithm>
#include <span>

#include "render/gl/gl_object.h"

namespace render {

class StoredBuffer {
 public:
  // Makes room for `bytes`; what it held is lost when it grows. Returns whether it did.
  bool reserve(GLsizeiptr bytes) {
    if (buffer_ && bytes <= capacity_) return false;
    buffer_ = makeBuffer();
    capacity_ = std::max<GLsizeiptr>(bytes, 16);
    glNamedBufferStorage(buffer_.id(), capacity_, nullptr, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
    return true;
  }
  // From a byte on, a multiple of 256.
  void bind(int slot, GLintptr from) const {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(slot), buffer_.id(), from, capacity_ - from);
  }

  // Items until the next call of close(). Waits for what the GPU does with them. `access`: GL_MAP_READ_BIT,
  // GL_MAP_WRITE_BIT or both.
  template <class T>
  std::span<T> open(std::size_t count, GLbitfield access) {
    const auto bytes = static_cast<GLsizeiptr>(count * sizeof(T));
    if (count == 0) return {};
    open_ = true;
    return {static_cast<T*>(glMapNamedBufferRange(buffer_.id(), 0, bytes, access)), count};
  }
  void close() {
    if (open_) glUnmapNamedBuffer(buffer_.id());
    open_ = false;
  }

 private:
  Buffer buffer_;
  GLsizeiptr capacity_ = 0;
  bool open_ = false;
};

}  // namespace render
