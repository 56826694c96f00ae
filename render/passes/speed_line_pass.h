#pragma once

#include "render/buffer_texture.h"
#include "render/frame_scene.h"
#include "render/gbuffer.h"
#include "render/speed_line_list.h"

namespace limn {

// Streaks behind what moves fast (post.speed-lines), as quads that face the camera and fade toward
// their tails.
//
// Reads    depth; SpeedLine records
// Writes   radiance
// Order    after what is blended, before the lens
// Shaders  speed_line.vert, speed_line.frag
//
// Its program is made when there are lines for the first time.

struct SpeedLinePass {
    const gpu::Program* program = nullptr;
    bool failed = false;  ///< to compile: logged, no lines
    BufferTexture records = BufferTexture("speed lines", GL_RGBA32F);
    int count = 0;  ///< of the lines in `records`
};

/// Draws over `radiance`; adds no pass without lines.
void draw_speed_lines(
    FrameGraph& graph, gpu::Device& device, SpeedLinePass& pass, const FrameScene& scene,
    TextureId radiance, const Gbuffer& gbuffer);

}  // namespace limn
