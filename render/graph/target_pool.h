#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/framebuffer.h"
#include "render/gpu/texture.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// The memory behind the frame graph's transient textures and buffers, and the framebuffers that
// combine them. Resources of equal format and size are reused, within a frame and across frames;
// those unused for kFramesKept frames are freed (after a resize, for example).

class TargetPool {
  public:
    static constexpr std::uint64_t kFramesKept = 8;
    static constexpr std::uint32_t kNoOwner = ~0u;

    /// Marks everything as free and destroys what has not been used for kFramesKept frames.
    void begin_frame();

    /// A slot whose contents are undefined, owned by resource `owner` until released.
    [[nodiscard]] std::uint32_t acquire_texture(const gpu::TextureDesc& desc, std::uint32_t owner);
    [[nodiscard]] std::uint32_t acquire_buffer(std::size_t bytes, std::uint32_t owner);
    /// Makes the slot available again; its contents stay until it is reused.
    void release_texture(std::uint32_t slot) { textures_[slot].busy = false; }
    void release_buffer(std::uint32_t slot) { buffers_[slot].busy = false; }

    [[nodiscard]] const gpu::Texture& texture(std::uint32_t slot) const {
        return textures_[slot].texture;
    }
    [[nodiscard]] const gpu::Buffer& buffer(std::uint32_t slot) const {
        return buffers_[slot].buffer;
    }
    /// Resource whose contents the slot holds.
    [[nodiscard]] std::uint32_t owner_of_texture(std::uint32_t slot) const {
        return textures_[slot].owner;
    }

    /// Shader writes not yet followed by a barrier; tracked per slot, as owners change.
    [[nodiscard]] bool& texture_unsynced(std::uint32_t slot) { return textures_[slot].unsynced; }
    [[nodiscard]] bool& buffer_unsynced(std::uint32_t slot) { return buffers_[slot].unsynced; }

    /// A cached framebuffer with these attachments.
    [[nodiscard]] const gpu::Framebuffer&
    framebuffer(std::span<const gpu::Attachment> colors, const gpu::Attachment& depth);

    [[nodiscard]] int texture_count() const;
    [[nodiscard]] int framebuffer_count() const { return static_cast<int>(framebuffers_.size()); }
    [[nodiscard]] std::size_t bytes() const;

  private:
    struct TextureSlot {
        gpu::Texture texture;   // empty: the slot is vacant
        gpu::TextureDesc desc;  // as requested: Texture resolves a level count of 0
        std::uint64_t last_used = 0;
        std::uint32_t owner = kNoOwner;
        bool busy = false;
        bool unsynced = false;
    };
    struct BufferSlot {
        gpu::Buffer buffer;
        std::uint64_t last_used = 0;
        std::uint32_t owner = kNoOwner;
        bool busy = false;
        bool unsynced = false;
    };
    struct AttachmentKey {
        std::uint64_t serial = 0;  // of the texture: GL names are recycled, serials are not
        int level = 0;
        int layer = 0;
        bool operator==(const AttachmentKey&) const = default;
    };
    using FramebufferKey = std::array<AttachmentKey, 9>;  // 8 colors and depth
    struct FramebufferEntry {
        FramebufferKey key;
        gpu::Framebuffer framebuffer;
        std::uint64_t last_used = 0;
    };

    std::vector<TextureSlot> textures_;
    std::vector<BufferSlot> buffers_;
    std::vector<FramebufferEntry> framebuffers_;
    std::uint64_t frame_ = 0;
};

}  // namespace limn
