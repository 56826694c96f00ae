#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <utility>

namespace limn::gpu {

/// A point in the GPU's work: signaled once everything submitted before it is done.
class Fence {
  public:
    Fence() = default;
    /// After everything submitted so far.
    [[nodiscard]] static Fence insert() {
        return Fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    }
    Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    Fence& operator=(Fence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;
    ~Fence() {
        if (sync_ != nullptr) {
            glDeleteSync(sync_);
        }
    }

    /// Never waits. An empty fence is signaled.
    [[nodiscard]] bool signaled() const { return wait(0); }
    /// Waits up to `timeout_ns`; true if signaled. Submits the work it waits for.
    bool wait(std::uint64_t timeout_ns) const {
        if (sync_ == nullptr) {
            return true;
        }
        const GLenum status = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, timeout_ns);
        return status == GL_ALREADY_SIGNALED || status == GL_CONDITION_SATISFIED;
    }
    explicit operator bool() const { return sync_ != nullptr; }

  private:
    explicit Fence(GLsync sync) : sync_(sync) {}
    GLsync sync_ = nullptr;
};

}  // namespace limn::gpu
