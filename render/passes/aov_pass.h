#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"

#include <array>
#include <string_view>

namespace limn {

// Attributes of the G-buffer as plain numbers, for files and the buffer viewer; and how well shadow
// maps resolve what a pixel shows (shadow.map-aliasing).
//
// Reads    G-buffer, records of the shadow views
// Writes   RGBA32F, named "aov.<name>"; layers of shadow volumes come from their own pass
// Order    after the G-buffer
// Shaders  aov.frag

inline constexpr int kAovCount = 7;
inline constexpr int kVolumeLayersAov = 6;  ///< draw_volume_layers makes it

struct Aov {
    std::string_view name;
    int channels;
    Vec4 nothing;  ///< value where no surface is
};
/// In the order of aov.frag.
extern const std::array<Aov, kAovCount> kAovs;

struct AovPass {
    std::array<const gpu::Program*, kVolumeLayersAov> programs{};
};

[[nodiscard]] Result<AovPass> create_aov_pass(gpu::Device& device);

/// `aov` is an index into kAovs; velocity needs a G-buffer with velocity.
[[nodiscard]] TextureId draw_aov(
    FrameGraph& graph, const AovPass& pass, const FrameScene& scene, const Gbuffer& gbuffer,
    int aov);

}  // namespace limn
