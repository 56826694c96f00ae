#pragma once

#include "ecs/components/wrinkle.h"
#include "render/effect.h"
#include "render/geometry/slot_allocator.h"
#include "render/gpu/buffer.h"
#include "render/gpu/buffer_texture.h"

#include <cstdint>
#include <map>

namespace limn {

// Measures the compression of skin at the vertices of every deformed instance that wrinkles, and
// the strength of its wrinkles (wrinkle.compression.*). lib/material.glsl draws them.
//
// Reads    WrinkleState, WrinkleSurface; positions of DeformedVertices
// Writes   DeformedVertices: wrinkle strengths per drawing method; heights of folds that
//          displace skin; the view's WrinkleColumns
// Order    after deform_pass, before everything that draws meshes
// Shaders  wrinkle.comp, lib/wrinkle.glsl; layout in wrinkle_gpu.h; lib/mesh_vertex.glsl displaces
//          the vertices

/// Meshes at rest on the GPU, by WrinkleState::source.
struct WrinkleRestPool {
    struct Range {
        std::uint32_t first_texel = 0;
        std::uint32_t texel_count = 0;
        bool used = false;  ///< in this frame
    };
    std::uint64_t assets = 0;  ///< FrameData::assets_identity to which the sources belong
    std::map<std::uint64_t, Range> ranges;
    SlotAllocator slots;  ///< texels
    gpu::Buffer texels;
};

struct WrinkleEffect {
    const gpu::Program* program = nullptr;
    WrinkleRestPool pool;
    BufferTexture jobs = BufferTexture("wrinkle jobs", GL_RGBA32UI);
    BufferTexture groups = BufferTexture("wrinkle groups", GL_R32UI);
    BufferTexture rest = BufferTexture("wrinkle rest", GL_RG32UI);

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<WrinkleEffect> create(gpu::Device& device, const RenderSettings&);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
};

}  // namespace limn
