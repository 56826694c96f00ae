#include "render/gpu/framebuffer.h"

#include "ecs/base/check.h"
#include "render/gpu/texture.h"

#include <array>

namespace limn::gpu {
namespace {

GLuint create_framebuffer_name() {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    return id;
}

void attach(GLuint framebuffer, GLenum point, const Attachment& attachment) {
    const GLuint texture = attachment.texture->id();
    const GLenum target = attachment.texture->target();
    const bool flat = target == GL_TEXTURE_2D || target == GL_TEXTURE_2D_MULTISAMPLE;
    if (attachment.layer >= 0 && !flat) {
        glNamedFramebufferTextureLayer(
            framebuffer, point, texture, attachment.level, attachment.layer);
    } else {
        glNamedFramebufferTexture(framebuffer, point, texture, attachment.level);
    }
}

}  // namespace

Framebuffer::Framebuffer(
    std::string_view label, std::span<const Attachment> colors, const Attachment& depth_stencil)
    : object_(create_framebuffer_name(), label) {
    constexpr std::size_t kMaxColors = 8;  // the minimum of GL_MAX_COLOR_ATTACHMENTS
    LIMN_CHECK(colors.size() <= kMaxColors);
    LIMN_CHECK(!colors.empty() || depth_stencil.texture != nullptr);

    std::array<GLenum, kMaxColors> buffers = {};
    for (std::size_t i = 0; i < colors.size(); ++i) {
        buffers[i] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
        attach(id(), buffers[i], colors[i]);
    }
    if (depth_stencil.texture != nullptr) {
        const bool stencil = format_info(depth_stencil.texture->desc().format).stencil;
        attach(id(), stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, depth_stencil);
    }
    if (colors.empty()) {
        glNamedFramebufferDrawBuffer(id(), GL_NONE);
        glNamedFramebufferReadBuffer(id(), GL_NONE);
    } else {
        glNamedFramebufferDrawBuffers(id(), static_cast<GLsizei>(colors.size()), buffers.data());
    }
    const Attachment& first = colors.empty() ? depth_stencil : colors[0];
    width_ = first.texture->width(first.level);
    height_ = first.texture->height(first.level);
    LIMN_CHECK(glCheckNamedFramebufferStatus(id(), GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE);
}

}  // namespace limn::gpu
