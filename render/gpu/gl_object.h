#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace limn::gpu {

// Common to all OpenGL objects here: a single owner, a label for debuggers and error messages, and
// a count of live objects. Destroy objects on the thread that created them, before their context.

enum class ObjectKind : std::uint8_t {
    Buffer,
    Texture,
    Framebuffer,
    Sampler,
    VertexArray,
    Query,
    Program,
    Count,
};

/// Move-only owner of one OpenGL name. Empty (0) by default.
template <ObjectKind kind>
class GlObject;

/// Live objects of a kind in this process: 0 after everything was destroyed.
[[nodiscard]] std::int64_t live_objects(ObjectKind kind);

/// Bytes of live buffers and textures in this process, as requested (drivers pad).
[[nodiscard]] std::int64_t gpu_memory_bytes();

/// Incremented by every deletion. OpenGL unbinds deleted names and reuses them, so cached bindings
/// are invalid once this has changed.
[[nodiscard]] std::uint64_t deletion_count();

namespace detail {
void created_object(ObjectKind kind, GLuint id, std::string_view label);
void delete_object(ObjectKind kind, GLuint id);
void add_memory(std::int64_t bytes);
[[nodiscard]] std::uint64_t next_serial();
}  // namespace detail

template <ObjectKind kind>
class GlObject {
  public:
    GlObject() = default;
    /// Takes ownership of `id`, which must not be 0.
    GlObject(GLuint id, std::string_view label) : id_(id), serial_(detail::next_serial()) {
        detail::created_object(kind, id, label);
    }
    GlObject(GlObject&& other) noexcept
        : id_(std::exchange(other.id_, 0)), serial_(std::exchange(other.serial_, 0)),
          bytes_(std::exchange(other.bytes_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        if (this != &other) {
            destroy();
            id_ = std::exchange(other.id_, 0);
            serial_ = std::exchange(other.serial_, 0);
            bytes_ = std::exchange(other.bytes_, 0);
        }
        return *this;
    }
    GlObject(const GlObject&) = delete;
    GlObject& operator=(const GlObject&) = delete;
    ~GlObject() { destroy(); }

    [[nodiscard]] GLuint id() const { return id_; }
    /// Unique within the process, unlike the name, which OpenGL reuses.
    [[nodiscard]] std::uint64_t serial() const { return serial_; }
    explicit operator bool() const { return id_ != 0; }

    /// Counts `bytes` in gpu_memory_bytes() for as long as the object lives.
    void set_bytes(std::size_t bytes) {
        detail::add_memory(static_cast<std::int64_t>(bytes) - bytes_);
        bytes_ = static_cast<std::int64_t>(bytes);
    }

  private:
    void destroy() {
        if (id_ != 0) {
            detail::delete_object(kind, id_);
            detail::add_memory(-bytes_);
        }
    }

    GLuint id_ = 0;
    std::uint64_t serial_ = 0;
    std::int64_t bytes_ = 0;
};

}  // namespace limn::gpu
