#pragma once

#include "render/gpu/gl_object.h"

#include <span>

namespace limn::gpu {

class Texture;

/// One mip level of a texture to draw into; `layer` < 0 means all layers (or the only one).
struct Attachment {
    const Texture* texture = nullptr;
    int level = 0;
    int layer = -1;
};

/// Render targets of a pass. The frame graph creates these; passes never need one. The textures
/// must outlive it and have the same size and sample count.
class Framebuffer {
  public:
    Framebuffer() = default;
    Framebuffer(
        std::string_view label, std::span<const Attachment> colors,
        const Attachment& depth_stencil = {});

    [[nodiscard]] GLuint id() const { return object_.id(); }
    [[nodiscard]] int width() const { return width_; }    ///< [px]
    [[nodiscard]] int height() const { return height_; }  ///< [px]
    explicit operator bool() const { return static_cast<bool>(object_); }

  private:
    GlObject<ObjectKind::Framebuffer> object_;
    int width_ = 0;
    int height_ = 0;
};

}  // namespace limn::gpu
