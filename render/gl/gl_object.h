// Move-only owners of OpenGL names. Made through direct state access, so nothing needs to be bound to be set up.
#pragma once

#include <GL/glew.h>

#include <utility>

namespace render {

// Owns one name of the kind that Traits makes and deletes; 0 owns nothing. The context must be current when it ends.
template <typename Traits>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint id) : id_(id) {}
  ~GlObject() { reset(); }
  GlObject(GlObject&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, 0);
    }
    return *this;
  }
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  void reset() noexcept {
    if (id_ != 0) Traits::destroy(id_);
    id_ = 0;
  }

 private:
  GLuint id_ = 0;
};

struct BufferTraits {
  static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct TextureTraits {
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct SamplerTraits {
  static void destroy(GLuint id) { glDeleteSamplers(1, &id); }
};
struct VertexArrayTraits {
  static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct FramebufferTraits {
  static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct QueryTraits {
  static void destroy(GLuint id) { glDeleteQueries(1, &id); }
};
struct ShaderTraits {
  static void destroy(GLuint id) { glDeleteShader(id); }
};
struct ProgramTraits {
  static void destroy(GLuint id) { glDeleteProgram(id); }
};

using Buffer = GlObject<BufferTraits>;
using Texture = GlObject<TextureTraits>;
using Sampler = GlObject<SamplerTraits>;
using VertexArray = GlObject<VertexArrayTraits>;
using Framebuffer = GlObject<FramebufferTraits>;
using Query = GlObject<QueryTraits>;
using ShaderStage = GlObject<ShaderTraits>;
using Program = GlObject<ProgramTraits>;

inline Buffer makeBuffer() {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  return Buffer(id);
}
inline Texture makeTexture(GLenum target) {
  GLuint id = 0;
  glCreateTextures(target, 1, &id);
  return Texture(id);
}
inline Sampler makeSampler() {
  GLuint id = 0;
  glCreateSamplers(1, &id);
  return Sampler(id);
}
inline VertexArray makeVertexArray() {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  return VertexArray(id);
}
inline Framebuffer makeFramebuffer() {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  return Framebuffer(id);
}
inline Query makeQuery(GLenum target) {
  GLuint id = 0;
  glCreateQueries(target, 1, &id);
  return Query(id);
}

// A buffer that grows and is refilled; never shrinks, so a steady scene allocates nothing.
class GrowingBuffer {
 public:
  // Copies `bytes` bytes in. Returns true when the storage was made anew (texture buffers then need to be attached
  // again).
  bool upload(const void* data, GLsizeiptr bytes) {
    const bool grown = !buffer_ || bytes > capacity_;
    if (grown) {
      buffer_ = makeBuffer();
      capacity_ = bytes > 0 ? bytes : 16;
      glNamedBufferStorage(buffer_.id(), capacity_, nullptr, GL_DYNAMIC_STORAGE_BIT);
    }
    if (bytes > 0) glNamedBufferSubData(buffer_.id(), 0, bytes, data);
    return grown;
  }
  GLuint id() const { return buffer_.id(); }
  GLsizeiptr capacity() const { return capacity_; }

 private:
  Buffer buffer_;
  GLsizeiptr capacity_ = 0;
};

}  // namespace render
