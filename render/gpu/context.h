#pragma once

#include "ecs/base/result.h"

#include <memory>
#include <string>

namespace limn::gpu {

// An OpenGL 4.5 core context without a window, through EGL: first every device that EGL lists
// (hardware before software), then Mesa's surfaceless platform. Windows create their own context
// (content/app); both kinds end in Device::from_current_context().
//
// LIMN_GL_DEVICE chooses: an index into EGL's list, "gpu" (fail rather than draw on the CPU),
// "software", or "surfaceless".

#if defined(LIMN_GL_DEBUG)
inline constexpr bool kDebugContextByDefault = true;
#else
inline constexpr bool kDebugContextByDefault = false;
#endif

class Context;

struct ContextDesc {
    bool debug =
        kDebugContextByDefault;      ///< errors become messages (and tests fail); costs some speed
    const Context* share = nullptr;  ///< share buffers, textures and programs with this context
};

/// Creates the context and makes it current on this thread.
[[nodiscard]] Result<std::unique_ptr<Context>>
create_headless_context(const ContextDesc& desc = {});

/// Owns a headless context. Destroy GPU objects and the Device before it, on its thread.
class Context {
  public:
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes it current on this thread; a context is current on one thread at a time.
    [[nodiscard]] Status make_current();
    /// No context is current on this thread afterwards.
    void release_current();
    /// "EGL device 0 (software)", for messages.
    [[nodiscard]] const std::string& origin() const { return origin_; }

  private:
    friend Result<std::unique_ptr<Context>> create_headless_context(const ContextDesc& desc);
    Context() = default;

    void* display_ = nullptr;  // EGLDisplay
    void* context_ = nullptr;  // EGLContext
    void* config_ = nullptr;   // EGLConfig
    std::string origin_;
};

}  // namespace limn::gpu
