#pragma once

#include "render/gpu/gl_object.h"

#include <optional>

namespace limn::gpu {

/// One GPU query object: GL_TIMESTAMP, GL_TIME_ELAPSED, GL_SAMPLES_PASSED,
/// GL_PRIMITIVES_GENERATED ...
class GpuQuery {
  public:
    GpuQuery() = default;
    GpuQuery(std::string_view label, GLenum target);

    void begin();  ///< not for GL_TIMESTAMP; one active query per target
    void end();
    void timestamp();  ///< GL_TIMESTAMP only: the time when all previous commands are done

    /// The result if it is available; never waits. Empty before end() or timestamp().
    [[nodiscard]] std::optional<std::uint64_t> poll() const;
    /// The result, waiting for the GPU.
    [[nodiscard]] std::uint64_t wait() const;

    explicit operator bool() const { return static_cast<bool>(object_); }

  private:
    GlObject<ObjectKind::Query> object_;
    GLenum target_ = GL_NONE;
    bool issued_ = false;
};

}  // namespace limn::gpu
