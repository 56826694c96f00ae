#include "render/passes/motion_blur_pass.h"

#include "render/frame_scene.h"
#include "render/gpu/shader_library.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr int kLeastTile = 16;    // side [px]
constexpr int kTilesOfSmear = 4;  // that the longest smear crosses, at most, to either side

/// Of the longest smear to either side of a pixel: tiles, and how many of them it crosses.
struct Tiling {
    float longest = 0;  ///< [px]
    int side = kLeastTile;
    int radius = 1;
};

Tiling make_tiling(const MotionBlur& settings, int height) {
    Tiling tiling;
    tiling.longest = std::max(0.5f * settings.longest * static_cast<float>(height), 1.0f);
    const int longest = static_cast<int>(std::ceil(tiling.longest));
    tiling.side = std::max(kLeastTile, (longest + kTilesOfSmear - 1) / kTilesOfSmear);
    tiling.radius = (longest + tiling.side - 1) / tiling.side;
    return tiling;
}

TextureId pack_motion(
    FrameGraph& graph, const gpu::Program& program, const MotionBlur& settings, float longest,
    const FrameScene& scene, const Gbuffer& gbuffer) {
    const TextureSpec source = graph.spec(gbuffer.velocity);
    const TextureId motion = graph.create(
        {.name = "motion blur.motion",
         .format = GL_RGBA32F,
         .width = source.width,
         .height = source.height});
    graph.add_pass(
        "motion blur, pack", {gbuffer.velocity, gbuffer.depth}, {discarded(motion)},
        [&program, &scene, gbuffer, longest,
         half_share = half_exposure(settings)](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            bind_view(context.device(), scene);
            program.set("half_exposure", half_share);
            program.set("longest", longest);
            context.bind_texture(0, gbuffer.velocity);
            context.bind_texture(1, gbuffer.depth);
            context.device().draw_fullscreen();
        });
    return motion;
}

/// The longest motion in each tile, first of the rows of each, then of these.
TextureId find_longest(
    FrameGraph& graph, const gpu::Program& program, int side, TextureId source, bool first) {
    const TextureSpec spec = graph.spec(source);
    const auto tiles = [side](int size) { return (size + side - 1) / side; };
    const IVec2 along = first ? IVec2(1, 0) : IVec2(0, 1);
    const TextureId longest = graph.create(
        {.name = first ? "motion blur.rows" : "motion blur.tiles",
         .format = GL_RGBA32F,
         .width = first ? tiles(spec.width) : spec.width,
         .height = first ? spec.height : tiles(spec.height)});
    graph.add_pass(
        first ? "motion blur, rows" : "motion blur, tiles", {source}, {discarded(longest)},
        [&program, source, side, along, first](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            program.set("along", along);
            program.set("side", side);
            program.set("first", first ? 1 : 0);
            context.bind_texture(0, source);
            context.device().draw_fullscreen();
        });
    return longest;
}

TextureId
spread(FrameGraph& graph, const gpu::Program& program, const Tiling& tiling, TextureId tiles) {
    const TextureSpec spec = graph.spec(tiles);
    const TextureId neighbors = graph.create(
        {.name = "motion blur.neighbors",
         .format = GL_RGBA32F,
         .width = spec.width,
         .height = spec.height});
    graph.add_pass(
        "motion blur, neighbors", {tiles}, {discarded(neighbors)},
        [&program, tiling, tiles](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            program.set("side", tiling.side);
            program.set("radius", tiling.radius);
            context.bind_texture(0, tiles);
            context.device().draw_fullscreen();
        });
    return neighbors;
}

}  // namespace

Result<MotionBlurPass> create_motion_blur_pass(gpu::Device& device) {
    MotionBlurPass pass;
    struct Wanted {
        const gpu::Program*& program;
        const char* fragment;
    };
    for (const Wanted& wanted :
         {Wanted{pass.pack, "motion_pack.frag"}, Wanted{pass.tile, "motion_tile.frag"},
          Wanted{pass.neighbor, "motion_neighbor.frag"}, Wanted{pass.blur, "motion_blur.frag"}}) {
        const Result<const gpu::Program*> made =
            device.shaders().load({.vertex = "fullscreen.vert", .fragment = wanted.fragment});
        if (!made) {
            return made.error();
        }
        wanted.program = *made;
    }
    return pass;
}

TextureId blur_motion(
    FrameGraph& graph, const MotionBlurPass& pass, const MotionBlur& settings,
    const FrameScene& scene, const Gbuffer& gbuffer, TextureId radiance) {
    LIMN_CHECK(gbuffer.velocity.valid());
    const TextureSpec spec = graph.spec(radiance);
    const Tiling tiling = make_tiling(settings, spec.height);
    const TextureId motion =
        pack_motion(graph, *pass.pack, settings, tiling.longest, scene, gbuffer);
    const TextureId rows = find_longest(graph, *pass.tile, tiling.side, motion, true);
    const TextureId tiles = find_longest(graph, *pass.tile, tiling.side, rows, false);
    const TextureId neighbors = spread(graph, *pass.neighbor, tiling, tiles);
    const TextureId blurred = graph.create(
        {.name = "motion blur", .format = spec.format, .width = spec.width, .height = spec.height});
    graph.add_pass(
        "motion blur", {radiance, motion, neighbors}, {discarded(blurred)},
        [&program = *pass.blur, samples = std::clamp(settings.samples, 4, 64), tiling, radiance,
         motion, neighbors](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            program.set("side", tiling.side);
            program.set("samples", samples);
            context.bind_texture(0, radiance);
            context.bind_texture(1, motion);
            context.bind_texture(2, neighbors);
            context.device().draw_fullscreen();
        });
    return blurred;
}

}  // namespace limn
