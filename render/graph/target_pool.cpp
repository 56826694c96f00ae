#include "render/graph/target_pool.h"

#include "ecs/base/check.h"

#include <algorithm>

namespace limn {

void TargetPool::begin_frame() {
    ++frame_;
    const auto old = [&](std::uint64_t last_used) { return frame_ - last_used > kFramesKept; };
    std::erase_if(
        framebuffers_, [&](const FramebufferEntry& entry) { return old(entry.last_used); });
    // Slot numbers stay valid within a frame, so slots are emptied, not erased.
    for (TextureSlot& slot : textures_) {
        slot.busy = false;
        slot.owner = kNoOwner;
        if (slot.texture && old(slot.last_used)) {
            slot.texture = {};
        }
    }
    for (BufferSlot& slot : buffers_) {
        slot.busy = false;
        slot.owner = kNoOwner;
        if (slot.buffer && old(slot.last_used)) {
            slot.buffer = {};
        }
    }
}

std::uint32_t TargetPool::acquire_texture(const gpu::TextureDesc& desc, std::uint32_t owner) {
    auto slot = std::find_if(textures_.begin(), textures_.end(), [&](const TextureSlot& s) {
        return s.texture && !s.busy && s.desc == desc;
    });
    if (slot == textures_.end()) {
        slot = std::find_if(
            textures_.begin(), textures_.end(), [](const TextureSlot& s) { return !s.texture; });
        if (slot == textures_.end()) {
            slot = textures_.insert(textures_.end(), TextureSlot{});
        }
        const auto number = slot - textures_.begin();
        slot->texture = gpu::Texture("pool texture " + std::to_string(number), desc);
        slot->desc = desc;
        slot->unsynced = false;
    }
    slot->busy = true;
    slot->owner = owner;
    slot->last_used = frame_;
    return static_cast<std::uint32_t>(slot - textures_.begin());
}

std::uint32_t TargetPool::acquire_buffer(std::size_t bytes, std::uint32_t owner) {
    auto slot = std::find_if(buffers_.begin(), buffers_.end(), [&](const BufferSlot& s) {
        return s.buffer && !s.busy && s.buffer.size() == bytes;
    });
    if (slot == buffers_.end()) {
        slot = std::find_if(
            buffers_.begin(), buffers_.end(), [](const BufferSlot& s) { return !s.buffer; });
        if (slot == buffers_.end()) {
            slot = buffers_.insert(buffers_.end(), BufferSlot{});
        }
        const auto number = slot - buffers_.begin();
        slot->buffer =
            gpu::Buffer("pool buffer " + std::to_string(number), bytes, gpu::BufferUse::GpuOnly);
        slot->unsynced = false;
    }
    slot->busy = true;
    slot->owner = owner;
    slot->last_used = frame_;
    return static_cast<std::uint32_t>(slot - buffers_.begin());
}

const gpu::Framebuffer&
TargetPool::framebuffer(std::span<const gpu::Attachment> colors, const gpu::Attachment& depth) {
    FramebufferKey key = {};
    LIMN_CHECK(colors.size() < key.size());
    const auto key_of = [](const gpu::Attachment& a) {
        return AttachmentKey{a.texture->serial(), a.level, a.layer};
    };
    std::transform(colors.begin(), colors.end(), key.begin(), key_of);
    if (depth.texture != nullptr) {
        key.back() = key_of(depth);
    }
    auto found =
        std::find_if(framebuffers_.begin(), framebuffers_.end(), [&](const FramebufferEntry& e) {
            return e.key == key;
        });
    if (found == framebuffers_.end()) {
        framebuffers_.push_back({key, gpu::Framebuffer("pool framebuffer", colors, depth)});
        found = framebuffers_.end() - 1;
    }
    found->last_used = frame_;
    return found->framebuffer;
}

int TargetPool::texture_count() const {
    return static_cast<int>(
        std::count_if(textures_.begin(), textures_.end(), [](const TextureSlot& s) {
            return static_cast<bool>(s.texture);
        }));
}

std::size_t TargetPool::bytes() const {
    std::size_t sum = 0;
    for (const TextureSlot& slot : textures_) {
        sum += slot.texture ? gpu::texture_bytes(slot.texture.desc()) : 0;
    }
    for (const BufferSlot& slot : buffers_) {
        sum += slot.buffer.size();
    }
    return sum;
}

}  // namespace limn
